"""What the pipeline may rely on, whichever law is in charge."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tcs_hil.control.protocol import Controller, Proposal, SolveStatus
from tcs_hil.signals import NO_LIMIT, ControllerKind
from tests.control.quarter_car import constant_friction, drive
from tests.control.recorder import wheel_at

Make = Callable[[ControllerKind], Controller]

every_law = pytest.mark.parametrize("kind", list(ControllerKind), ids=lambda kind: kind.name)
ROLLING, SPINNING = wheel_at(2.0, 0.01), wheel_at(2.0, 0.4)


@every_law
def test_no_request_gets_no_torque(make: Make, kind: ControllerKind) -> None:
    assert make(kind).step(SPINNING, 0.0) == Proposal(0.0)


@every_law
def test_a_braking_request_is_left_as_it_is(make: Make, kind: ControllerKind) -> None:
    assert make(kind).step(SPINNING, -20.0) == Proposal(-20.0, SolveStatus.BAD_INPUT)


@every_law
@pytest.mark.parametrize("request_nm", [math.nan, math.inf, -math.inf])
def test_a_request_that_is_no_number_is_never_limited(
    make: Make, kind: ControllerKind, request_nm: float
) -> None:
    assert make(kind).step(SPINNING, request_nm) == Proposal(NO_LIMIT, SolveStatus.BAD_INPUT)


@every_law
@pytest.mark.parametrize(
    "field", ["slip_speed_mps", "wheel_speed_radps", "slip_ratio", "vehicle_speed_mps"]
)
@pytest.mark.parametrize("value", [math.nan, math.inf, -1e300])
def test_an_unknown_wheel_leaves_the_request_alone_and_the_law_usable(
    make: Make, kind: ControllerKind, field: str, value: float
) -> None:
    controller, fresh = make(kind), make(kind)
    bad = controller.step(replace(SPINNING, **{field: value}), 100.0)
    assert bad == Proposal(100.0, SolveStatus.BAD_INPUT)
    assert controller.step(SPINNING, 100.0) == fresh.step(SPINNING, 100.0)


@every_law
def test_a_rolling_wheel_gets_the_whole_request(make: Make, kind: ControllerKind) -> None:
    proposal = make(kind).step(ROLLING, 50.0)
    assert proposal.status is SolveStatus.OK
    assert proposal.torque_nm == pytest.approx(50.0, abs=1e-3)


@pytest.mark.parametrize("kind", [ControllerKind.PI, ControllerKind.KMPC, ControllerKind.NMPC])
def test_a_spinning_wheel_gets_less_than_requested(make: Make, kind: ControllerKind) -> None:
    controller = make(kind)
    controller.step(SPINNING, 200.0)  # the PI starts from the request without a bump
    assert controller.step(wheel_at(2.0, 0.6), 200.0).torque_nm < 190.0


@every_law
@given(
    speed_mps=st.floats(0.0, 60.0),
    kappa=st.floats(-0.2, 0.98),
    request_nm=st.floats(0.0, 300.0),
)
@settings(max_examples=60)
def test_a_proposal_lies_between_zero_and_the_request(
    make: Make, kind: ControllerKind, speed_mps: float, kappa: float, request_nm: float
) -> None:
    proposal = make(kind).step(wheel_at(speed_mps, kappa), request_nm)
    assert 0.0 <= proposal.torque_nm <= request_nm


@every_law
def test_after_a_reset_a_run_repeats_itself_bit_for_bit(make: Make, kind: ControllerKind) -> None:
    controller = make(kind)
    first = drive(controller, constant_friction, 0.8).torque_nm
    controller.reset()
    second = drive(controller, constant_friction, 0.8).torque_nm
    assert (first == second).all()
