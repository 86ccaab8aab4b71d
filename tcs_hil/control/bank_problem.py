"""The quadratic program of one speed band: the bank's predictor condensed once."""

from __future__ import annotations

import functools
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from tcs_hil.control.condense import LinearSystem, condense
from tcs_hil.control.settings import BankKmpcSettings, ControlSettings
from tcs_hil.model.bank import KoopmanBank
from tcs_hil.model.observables import NZ, Observable

FloatArray = NDArray[np.float64]

INTEGRAL, DISTURBANCE, NX = NZ, NZ + 1, NZ + 2
"""State x = [z, e_int, d]: e_int in seconds, d the wheel speed per period no model explains."""

CALM_MPS = 0.8
"""Below it the weights of slip and integral shrink by one more power of the speed."""

UNIT_NM = 100.0
"""The solvers' unit of torque: their tolerances are absolute and meant for numbers near 1."""


def extend_band(bank: KoopmanBank, band: int, slip_reference: float) -> LinearSystem:
    """One predictor over x, with outputs y = [kappa - kappa_ref, e_int] and the torque in Nm.

    e_int⁺ = e_int + T_s (kappa_ref - kappa).  d is constant and adds to omega,
    to s = omega R - v, and to kappa by its slope over omega at the band's centre
    and the slip reference.
    """
    vehicle = bank.provenance.settings.vehicle
    a, b = np.eye(NX), np.zeros((NX, 1))
    a[:NZ, :NZ], b[:NZ, 0] = bank.a[band], bank.b[band]
    a[INTEGRAL, [Observable.SLIP_RATIO, Observable.ONE]] = (
        -bank.period_s,
        bank.period_s * slip_reference,
    )
    radius_m = vehicle.wheel_radius_m
    slope = (1.0 - slip_reference) ** 2 * radius_m / bank.centre_mps[band]
    a[[Observable.WHEEL_SPEED, Observable.SLIP_SPEED, Observable.SLIP_RATIO], DISTURBANCE] = (
        1.0,
        radius_m,
        slope,
    )
    c = np.zeros((2, NX))
    c[0, [Observable.SLIP_RATIO, Observable.ONE]] = 1.0, -slip_reference
    c[1, INTEGRAL] = 1.0
    return LinearSystem(a, b, c)


class BandCost(NamedTuple):
    """The quadratic program of one band over the torques U within [0, T_ref], in `UNIT_NM`.

    Minimised is the sum of w_p (kappa - kappa_ref)² + w_i e_int² + w_u (T_ref - u)²
    + w_du (u_k - u_{k-1})².  Its gradient at U = 0 is ``gradient_map`` x less
    ``reduction_pull`` T_ref, and less ``change_pull`` times the last torque in the
    first element, both torques in Nm.
    """

    hessian: FloatArray  # (N, N)
    gradient_map: FloatArray  # (N, NX)
    reduction_pull: float
    change_pull: float


def band_cost(system: LinearSystem, tuning: BankKmpcSettings, centre_mps: float) -> BandCost:
    """Cost over one band's predictor, with the output weights at its centre."""
    n = tuning.horizon
    dense = condense(system, n)
    weights = np.tile(output_weights(tuning, centre_mps), n)
    pull = 2.0 * dense.theta.T * weights  # (N, 2 N)
    change = np.eye(n) - np.eye(n, k=-1)
    on_torques = tuning.weight_reduction * np.eye(n) + tuning.weight_change * change.T @ change
    hessian = pull @ dense.theta + 2.0 * on_torques
    return BandCost(
        hessian * UNIT_NM**2,
        np.ascontiguousarray(pull @ dense.gamma * UNIT_NM),
        2.0 * tuning.weight_reduction * UNIT_NM,
        2.0 * tuning.weight_change * UNIT_NM,
    )


class Band(NamedTuple):
    """One band's predictor and the problem over it."""

    system: LinearSystem
    cost: BandCost


@functools.lru_cache(maxsize=1)  # the right wheel's problem is the left one's
def bands_of(bank: KoopmanBank, settings: ControlSettings) -> list[Band]:
    """Every band of the bank."""
    tuning, bands = settings.default.kmpc, []
    for index, centre_mps in enumerate(bank.centre_mps):
        system = extend_band(bank, index, settings.slip_reference)
        bands.append(Band(system, band_cost(system, tuning, centre_mps)))
    return bands


def output_weights(tuning: BankKmpcSettings, speed_mps: float) -> tuple[float, float]:
    """Weights (w_p, w_i) on the slip error and its integral at a vehicle speed.

    Both go with the square of the speed, which weighs slip as slip speed: a motor
    moves that as fast at any speed, so the loop is as quick at 3 m/s as at 30.
    Near standstill they fall faster: the law would else feed the ring of a tyre
    stiffer than the predictor's.
    """
    share = (speed_mps / tuning.weights_speed_mps) ** 2 * min(speed_mps / CALM_MPS, 1.0)
    return share * tuning.weight_slip, share * tuning.weight_integral
