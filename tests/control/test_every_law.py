"""What the pipeline may rely on, whichever law is in charge, in both presets."""

from __future__ import annotations

import math
from collections.abc import Callable

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from msgspec.structs import replace

from tcs_hil.control.factory import make_controller
from tcs_hil.control.protocol import Controller, Proposal, SolveStatus
from tcs_hil.control.settings import ControlSettings
from tcs_hil.model.bank import KoopmanBank, default_bank_path
from tcs_hil.model.predictor import KoopmanPredictor
from tcs_hil.model.vehicle import Vehicle
from tcs_hil.signals import NO_LIMIT, ControllerKind
from tests.control.quarter_car import constant_friction, drive
from tests.control.recorder import wheel_at

Make = Callable[[ControllerKind], Controller]

BANK = KoopmanBank.load(default_bank_path(), ControlSettings().period_s)


@pytest.fixture(scope="module", params=["paper", "default"])
def make(request: pytest.FixtureRequest, predictor: KoopmanPredictor) -> Make:
    """A new controller of a kind, with the settings of a preset."""
    settings = ControlSettings(preset=request.param)
    model = predictor if request.param == "paper" else BANK
    return lambda kind: make_controller(kind, settings, Vehicle(), model)


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
    controller = make(kind)
    bad = controller.step(replace(SPINNING, **{field: value}), 100.0)
    assert bad == Proposal(100.0, SolveStatus.BAD_INPUT)
    after = controller.step(SPINNING, 100.0)
    assert after.status in (SolveStatus.OK, SolveStatus.MAX_ITERATIONS)
    assert 0.0 <= after.torque_nm <= 100.0


@every_law
def test_a_rolling_wheel_soon_gets_the_whole_request(make: Make, kind: ControllerKind) -> None:
    controller = make(kind)
    proposals = [controller.step(ROLLING, 50.0) for _ in range(30)]
    assert not {proposal.status for proposal in proposals} & {
        SolveStatus.FAILED,
        SolveStatus.BAD_INPUT,
    }
    # A penalty on changes of torque approaches the request without ever being done.
    assert proposals[-1].torque_nm == pytest.approx(50.0, abs=0.25)


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
