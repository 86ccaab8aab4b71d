"""The tyre against the Magic Formula, written out anew."""

import numpy as np
import pytest

from plant_emulator.compiled import records
from plant_emulator.road import Patch, Site
from plant_emulator.truth import MU, ROW_SIZE
from plant_emulator.tyre import Tyre, modified_slip, relaxation_length, slip_stiffness, tyre_force
from plant_emulator.whole_car import (
    HELD_AT,
    SIZE,
    SPEED,
    TRANSIENT_SLIP,
    WHEEL,
    WholeCar,
    derivative,
)

# Longitudinal set with every term, in the range of a 205/60R15.
FULL = Tyre(
    fnomin=4000.0,
    pcx1=1.579,
    pdx1=1.0422,
    pdx2=-0.08285,
    pex1=0.11113,
    pex2=0.3143,
    pex3=0.02,
    pex4=0.001719,
    pkx1=21.687,
    pkx2=13.728,
    pkx3=-0.4098,
    phx1=2.1615e-4,
    phx2=0.0011598,
    pvx1=2.0283e-5,
    pvx2=1.0568e-4,
)
KAPPA = np.linspace(-1.0, 1.0, 4001)
LOADS = (1500.0, 3433.5, 4000.0, 6000.0)


def magic_formula(t, kappa, fz):
    """MF 5.2, pure longitudinal slip, zero camber: Pacejka, 3rd ed., Eqs. (4.E9) to (4.E18)."""
    dfz = (fz - t.fnomin) / t.fnomin
    kx = kappa + t.phx1 + t.phx2 * dfz
    d = (t.pdx1 + t.pdx2 * dfz) * fz
    e = np.minimum((t.pex1 + t.pex2 * dfz + t.pex3 * dfz**2) * (1 - t.pex4 * np.sign(kx)), 1.0)
    k = fz * (t.pkx1 + t.pkx2 * dfz) * np.exp(t.pkx3 * dfz)
    bx = k / (t.pcx1 * d) * kx
    shift = fz * (t.pvx1 + t.pvx2 * dfz)
    return d * np.sin(t.pcx1 * np.arctan(bx - e * (bx - np.arctan(bx)))) + shift


def curve(tyre, load_n, mu=1.0, peak_only=False, kappa=KAPPA):
    tyre = records(tyre)[0]
    return np.array([tyre_force(tyre, k, load_n, mu, peak_only) for k in kappa])


@pytest.mark.parametrize("load_n", LOADS)
@pytest.mark.parametrize("tyre", [FULL, Tyre()])
def test_the_curve_is_the_magic_formulas(tyre, load_n):
    assert curve(tyre, load_n) == pytest.approx(magic_formula(tyre, KAPPA, load_n), abs=1e-8)


@pytest.mark.parametrize("load_n", LOADS)
def test_the_slope_at_the_origin_is_the_slip_stiffness(load_n):
    step = 1e-6
    low, high = curve(Tyre(), load_n, kappa=[-step, step])
    assert (high - low) / (2 * step) == pytest.approx(
        slip_stiffness(records(Tyre())[0], load_n), rel=1e-6
    )


def test_by_default_it_is_the_papers_tyre_at_its_quarter_load():
    paper = 0.3 * 3433.5 * 1.2005 * np.sin(1.4010 * np.arctan(17.1571 * KAPPA))
    assert curve(Tyre(), 3433.5, mu=0.3) == pytest.approx(paper, abs=1e-8)


def test_the_peak_falls_with_load_as_published():
    light, heavy = (curve(Tyre(), load).max() / load for load in (3433.5, 2 * 3433.5))
    assert heavy - light == pytest.approx(-0.083, rel=1e-4)


def best_slip(mu, peak_only):
    return KAPPA[curve(Tyre(), 3433.5, mu, peak_only).argmax()]


def test_scaling_the_whole_shape_keeps_the_best_slip():
    assert (
        best_slip(0.3, peak_only=False) == best_slip(1.0, peak_only=False) == pytest.approx(0.121)
    )


def test_scaling_the_peak_only_keeps_the_stiffness_and_shrinks_the_best_slip():
    assert best_slip(0.3, peak_only=True) == pytest.approx(0.3 * 0.121, abs=5e-4)
    step = 1e-7
    forces = [curve(Tyre(), 3433.5, mu, True, [step])[0] for mu in (0.3, 1.0)]
    assert forces[0] == pytest.approx(forces[1], rel=1e-6)
    peaks = [curve(Tyre(), 3433.5, mu, True).max() for mu in (0.3, 1.0)]
    assert peaks[0] == pytest.approx(0.3 * peaks[1], rel=1e-5)


def test_a_lifted_wheel_has_no_force():
    assert tyre_force(records(Tyre())[0], 0.1, 0.0, 1.0, False) == 0.0


def test_the_relaxation_length_shrinks_as_the_curve_bends():
    stiffness = slip_stiffness(records(Tyre())[0], 3433.5)
    lengths = [
        relaxation_length(records(Tyre())[0], k, curve(Tyre(), 3433.5, kappa=[k])[0], stiffness)
        for k in (1e-4, 0.05, 0.1, 0.9)
    ]
    assert lengths == sorted(lengths, reverse=True)
    assert lengths[0] == pytest.approx(0.15, rel=1e-3)
    assert lengths[-1] == 0.01


def slip_rate(tyre, kappa, slip_mps, speed_mps):
    """Rate of the transient slip of a wheel in the whole car's equations."""
    state, row, rate = np.zeros(SIZE), np.zeros(ROW_SIZE), np.zeros(SIZE)
    state[HELD_AT : HELD_AT + 4] = np.nan
    state[SPEED] = speed_mps
    state[WHEEL : WHEEL + 4] = (speed_mps + slip_mps) / 0.318
    state[TRANSIENT_SLIP : TRANSIENT_SLIP + 4] = kappa
    row[MU : MU + 4] = 1.0
    derivative(
        state, (0.0, 0.0), Site(False, False, 0.0, 1.0), records(WholeCar(tyre=tyre))[0], row, rate
    )
    return rate[TRANSIENT_SLIP]


def test_slip_builds_up_over_the_relaxation_length_and_settles_at_the_slip_ratio():
    assert slip_rate(Tyre(), 0.0, 0.02, 10.0) == pytest.approx(0.02 / 0.15)
    settled = 0.02 / 10.02
    assert slip_rate(Tyre(), settled, 0.02, 10.0) == pytest.approx(0.0, abs=1e-12)
    braked = -0.02 / 10.0
    assert slip_rate(Tyre(), braked, -0.02, 10.0) == pytest.approx(0.0, abs=1e-12)


@pytest.mark.parametrize(
    ("rim_mps", "speed_mps", "kappa"),
    [(2.0, 1.0, 2.0 / 4.1), (1.0, 2.0, -1.0 / 1.1), (-0.5, 1.0, -0.75 / 0.35), (0.0, 1.0, 0.0)],
)
def test_the_papers_slip_has_the_sign_of_the_sliding(rim_mps, speed_mps, kappa):
    assert modified_slip(rim_mps, speed_mps) == pytest.approx(kappa)


def test_a_patch_needs_its_friction_once_per_side():
    assert Patch(mu=0.3).row[1:3] == (0.3, 0.3)
    assert Patch(mu_left=0.1, mu_right=0.6).row[1:3] == (0.1, 0.6)
