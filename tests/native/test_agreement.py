"""The native step and the law in Python propose the same torque."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
import pytest
from msgspec.structs import replace
from msgspec.structs import replace as replaced

from tcs_hil.control.driveline import Driveline
from tcs_hil.control.protocol import Controller, SolveStatus, WheelState
from tcs_hil.control.settings import (
    ControlSettings,
    DefaultSettings,
    DrivelineNmpcSettings,
    KmpcSettings,
    NmpcSettings,
)
from tcs_hil.model.lifting import make_dictionary
from tcs_hil.model.predictor import KoopmanPredictor
from tcs_hil.model.radial import centre_count
from tcs_hil.model.vehicle import Vehicle
from tcs_hil.signals import ControllerKind
from tests.control.believed_car import drive
from tests.control.quarter_car import Run, manoeuvre_1, manoeuvre_2
from tests.control.recorder import wheel_at
from tests.native.pairs import DEFAULT, PAPER, PREDICTOR, SideBySide, both, random_questions

AGREEMENT_NM = 1e-6

KMPC, NMPC = ControllerKind.KMPC, ControllerKind.NMPC

every_law = pytest.mark.parametrize("kind", [KMPC, NMPC], ids=["KMPC", "NMPC"])
both_presets = pytest.mark.parametrize("settings", [PAPER, DEFAULT], ids=["paper", "default"])


@every_law
@both_presets
@pytest.mark.parametrize("manoeuvre", [manoeuvre_1, manoeuvre_2])
def test_along_a_manoeuvre(
    kind: ControllerKind, settings: ControlSettings, manoeuvre: Callable[[Controller], Run]
) -> None:
    pair = SideBySide(both(kind, settings))
    manoeuvre(pair)
    assert pair.worst_nm() < AGREEMENT_NM
    for native, python in pair.answers:
        assert native.status is python.status


@every_law
def test_behind_delay_and_driveline(kind: ControllerKind) -> None:
    pair = SideBySide(both(kind, DEFAULT))
    drive(pair, 1.0)
    assert pair.worst_nm() < AGREEMENT_NM


@every_law
@both_presets
def test_from_one_random_state_to_the_next(kind: ControllerKind, settings: ControlSettings) -> None:
    pair = SideBySide(both(kind, settings))
    for wheel, torque_ref_nm in random_questions(0, 600):
        pair.step(wheel, torque_ref_nm)
    assert pair.worst_nm() < AGREEMENT_NM


@every_law
@both_presets
@pytest.mark.parametrize("torque_ref_nm", [0.0, -20.0, math.nan, math.inf, -math.inf])
@pytest.mark.parametrize(
    "wheel", [wheel_at(2.0, 0.4), replace(wheel_at(2.0, 0.4), slip_ratio=math.nan)]
)
def test_where_there_is_nothing_to_decide(
    kind: ControllerKind, settings: ControlSettings, wheel: WheelState, torque_ref_nm: float
) -> None:
    native, python = (law.step(wheel, torque_ref_nm) for law in both(kind, settings))
    assert native == python


@pytest.mark.parametrize(
    ("kind", "horizon"),
    [
        *((KMPC, horizon) for horizon in (1, 2, 12, 40)),
        *((NMPC, horizon) for horizon in (1, 2, 12, 40)),
    ],
)
def test_at_every_horizon(kind: ControllerKind, horizon: int) -> None:
    tuning = {"kmpc": KmpcSettings(horizon=horizon), "nmpc": NmpcSettings(horizon=horizon)}
    pair = SideBySide(both(kind, replaced(PAPER, **tuning)))
    for wheel, torque_ref_nm in random_questions(1, 60):
        pair.step(wheel, torque_ref_nm)
    assert pair.worst_nm() < AGREEMENT_NM


def test_of_another_vehicle_with_another_tuning() -> None:
    car = Vehicle(mass_kg=2200.0, wheel_radius_m=0.35, gear_ratio=2.5, friction_ratio=0.5)
    tuning = NmpcSettings(weight_slip=300.0, weight_integral=2e4, substeps=7)
    settings = ControlSettings(preset="paper", slip_reference=0.07, nmpc=tuning, period_s=0.003)
    pair = SideBySide(both(NMPC, settings, vehicle=car))
    for wheel, torque_ref_nm in random_questions(2, 300):
        pair.step(wheel, torque_ref_nm)
    # At 3 ms a few starts near standstill do not converge, and rounding decides where they end.
    assert pair.worst_nm(beyond=SolveStatus.MAX_ITERATIONS) < AGREEMENT_NM
    assert sum(native.status is SolveStatus.OK for native, _ in pair.answers) > 290


def test_of_another_driveline_with_another_tuning() -> None:
    line = Driveline(shaft_stiffness_nmprad=9000.0, motor_lag_s=0.008, tyre_relaxation_m=0.1)
    tuning = DrivelineNmpcSettings(blocks=(1, 2, 1, 2), weight_integral=2e4, max_iterations=3)
    settings = ControlSettings(default=DefaultSettings(driveline=line, nmpc=tuning))
    pair = SideBySide(both(NMPC, settings))
    for wheel, torque_ref_nm in random_questions(5, 300):
        pair.step(wheel, torque_ref_nm)
    assert pair.worst_nm() < AGREEMENT_NM


@pytest.mark.parametrize("dictionary", ["monomials", "thin-plate", "gaussian"])
@pytest.mark.parametrize("order", [2, 8])
def test_with_every_dictionary(dictionary: str, order: int) -> None:
    pair = SideBySide(both(KMPC, predictor=made_up_predictor(dictionary, order)))
    for wheel, torque_ref_nm in random_questions(3, 300):
        pair.step(wheel, torque_ref_nm)
    assert pair.worst_nm() < AGREEMENT_NM
    assert len({native.torque_nm for native, _ in pair.answers}) >= 10  # not one bound all along


def made_up_predictor(dictionary: str, order: int) -> KoopmanPredictor:
    """Slow random dynamics over a dictionary; the torque drives kappa as it does in the car."""
    rng = np.random.default_rng(order)
    count = 0 if dictionary == "monomials" else centre_count(order)
    centres = tuple(map(tuple, rng.normal(size=(count, 2)).tolist()))
    nz = make_dictionary(dictionary, order, centres).size
    a, b = np.eye(nz), np.zeros((nz, 1))
    a[2] += rng.normal(scale=1e-4, size=nz)
    b[:3, 0] = PREDICTOR.b[:3, 0]
    provenance = replaced(PREDICTOR.provenance, dictionary=dictionary, order=order, centres=centres)
    return KoopmanPredictor.build(a, b, provenance)


@every_law
@both_presets
def test_after_a_reset_too(kind: ControllerKind, settings: ControlSettings) -> None:
    pair = SideBySide(both(kind, settings))
    first = [pair.step(*question) for question in random_questions(4, 40)]
    pair.reset()
    again = [pair.step(*question) for question in random_questions(4, 40)]
    assert again == first
    assert pair.worst_nm() < AGREEMENT_NM
    halves = pair.answers[:40], pair.answers[40:]
    assert [native for native, _ in halves[0]] == [native for native, _ in halves[1]]
