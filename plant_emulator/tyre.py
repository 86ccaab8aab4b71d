"""Tyres: Magic Formula 5.2 in pure longitudinal slip, with a lag over a relaxation length.

Source: H. B. Pacejka, Tire and Vehicle Dynamics, 3rd ed., 2012: Sec. 4.3.2
(force), Ch. 8 (transient slip, low-speed damping), and the MF-Tyre 5.2
conventions for the property file.  Camber, pressure and combined slip are not
modelled: the car drives straight.
"""

from __future__ import annotations

import math
from typing import Annotated

from msgspec import Meta

from plant_emulator.bounds import Finite, NonNegative, Positive, Table
from plant_emulator.compiled import compiled

LOW_SPEED_MPS = 0.5
ROLLING_SPEED_MPS = 0.1
SHORTEST_M = 0.01

Relaxation = Annotated[float, Meta(ge=0.0, le=1.0)]


class Tyre(Table, frozen=True):
    """Coefficients under their names of the property file, scale factors multiplied in.

    By default the paper's D, C and B at its quarter load.  The peak falls with
    load as published for a 205/60R15 (pDx2 = -0.083: Pacejka, 3rd ed., App. 3),
    the stiffness grows in proportion to it.

    Slip is the slip speed over the greater of rim and ground speed, as in the
    paper: ground speed in braking, rim speed in driving.  Property files put
    driving slip over ground speed, too (kappa there, kappa / (1 + kappa) here): a
    tyre from a file keeps its stiffness and its peak force but peaks at the
    file's number of our slip.

    ``relaxation_m`` is the length the contact patch needs to follow the slip, at
    small slip; it shrinks as the curve bends, because a sliding patch needs no
    deflection.  0 switches the lag off, and with it the ability to stand still
    under load.
    ``low_speed_damping_nspm`` (per tyre) damps the patch below 0.5 m/s, where a
    tyre is a spring.
    """

    fnomin: Positive = 3433.5  # N, the load at which dfz = 0
    pcx1: Positive = 1.4010
    pdx1: Positive = 1.2005
    pdx2: Finite = -0.083
    pex1: Finite = 0.0
    pex2: Finite = 0.0
    pex3: Finite = 0.0
    pex4: Finite = 0.0
    pkx1: Positive = 17.1571 * 1.4010 * 1.2005  # stiffness per load: B C D
    pkx2: Finite = 0.0
    pkx3: Finite = 0.0
    phx1: Finite = 0.0
    phx2: Finite = 0.0
    pvx1: Finite = 0.0
    pvx2: Finite = 0.0
    qsy1: NonNegative = 0.01
    relaxation_m: Relaxation = 0.15
    low_speed_damping_nspm: NonNegative = 5000.0


@compiled
def slip_stiffness(tyre: Tyre, load_n: float) -> float:
    """K_x = dF_x / dkappa at the origin, N per unit slip, on mu = 1."""
    dfz = load_n / tyre.fnomin - 1.0
    stiffness_n = load_n * (tyre.pkx1 + tyre.pkx2 * dfz)
    return stiffness_n * math.exp(tyre.pkx3 * dfz) if tyre.pkx3 != 0.0 else stiffness_n


@compiled
def tyre_force(tyre: Tyre, kappa: float, load_n: float, mu: float, peak_only: bool) -> float:
    """Longitudinal force in N.

    ``peak_only``: mu scales the peak factor D and leaves the stiffness, so B
    grows and the best slip shrinks; else mu scales the whole curve.
    """
    if load_n <= 0.0:
        return 0.0
    dfz = load_n / tyre.fnomin - 1.0
    of_peak, of_curve = (mu, 1.0) if peak_only else (1.0, mu)
    d = load_n * (tyre.pdx1 + tyre.pdx2 * dfz) * of_peak
    b = slip_stiffness(tyre, load_n) / (tyre.pcx1 * d)
    shifted = kappa + tyre.phx1 + tyre.phx2 * dfz
    x = b * shifted
    e = tyre.pex1 + tyre.pex2 * dfz + tyre.pex3 * dfz * dfz
    if e != 0.0:
        e = min(e * (1.0 - tyre.pex4 * math.copysign(1.0, shifted)), 1.0)
        x -= e * (x - math.atan(x))
    offset = load_n * (tyre.pvx1 + tyre.pvx2 * dfz) * of_peak
    return of_curve * (d * math.sin(tyre.pcx1 * math.atan(x)) + offset)


@compiled
def relaxation_length(tyre: Tyre, kappa: float, force_n: float, stiffness_n: float) -> float:
    """Relaxation length at a slip ratio, m: in proportion to the curve's secant.

    ``force_n`` and ``stiffness_n`` are on the same road.  (Pacejka, Ch. 7, the
    nonlinear single-point model.)  Never below 1 cm, which a step of 0.1 ms can
    follow at any speed.
    """
    straight_n = stiffness_n * kappa
    secant = force_n / straight_n if abs(straight_n) > 1.0 else 1.0
    return max(tyre.relaxation_m * min(secant, 1.0), SHORTEST_M)


@compiled
def rolling_speed(rim_mps: float, speed_mps: float) -> float:
    """Speed by which slip is defined, m/s: the rim's in driving, the car's in braking."""
    return max(abs(rim_mps), abs(speed_mps))


@compiled
def low_speed_slip(tyre: Tyre, slip_mps: float, rolling_mps: float, stiffness_n: float) -> float:
    """Slip ratio whose force damps the contact patch near standstill; zero above 0.5 m/s."""
    if rolling_mps >= LOW_SPEED_MPS:
        return 0.0
    fade = 0.5 * (1.0 + math.cos(math.pi * rolling_mps / LOW_SPEED_MPS))
    return fade * tyre.low_speed_damping_nspm * slip_mps / stiffness_n


@compiled
def rolling_resistance(tyre: Tyre, rim_mps: float, load_n: float, radius_m: float) -> float:
    """Moment against rolling, Nm; it fades within 0.1 m/s around standstill."""
    smooth_mps = math.sqrt(rim_mps * rim_mps + ROLLING_SPEED_MPS * ROLLING_SPEED_MPS)
    return tyre.qsy1 * load_n * radius_m * rim_mps / smooth_mps


@compiled
def modified_slip(rim_mps: float, speed_mps: float) -> float:
    """Slip ratio of the paper, Eq. (slip_mod) with epsilon = 0.1 (m/s)^2.

    Taken by magnitude, so that a wheel that turns backwards under a car that
    rolls forwards brakes.
    """
    return (rim_mps - speed_mps) * abs(rim_mps) / (rim_mps * rim_mps + 0.1)
