import math

import pytest
from factories import measurement

from tcs_hil.control.protocol import Proposal, SolveStatus, Source, WheelState
from tcs_hil.estimator import Estimator
from tcs_hil.fault_codes import FaultCode
from tcs_hil.gate import Gate
from tcs_hil.model.vehicle import Vehicle
from tcs_hil.pipeline import Law, Pipeline
from tcs_hil.plausibility import Plausibility
from tcs_hil.safety_settings import GateSettings, SupervisorSettings
from tcs_hil.signals import NO_LIMIT, ControllerKind, Suspect, TcsState, TorqueLimits
from tcs_hil.supervisor import Supervisor


class Scripted:
    """A controller that proposes what it is told to."""

    def __init__(self, torque_nm: float = 60.0) -> None:
        self.proposal = Proposal(torque_nm)
        self.resets = 0
        self.steps = 0

    def step(self, wheel: WheelState, torque_ref_nm: float) -> Proposal:
        self.steps += 1
        return self.proposal

    def reset(self) -> None:
        self.resets += 1


@pytest.fixture
def laws() -> tuple[Scripted, Scripted]:
    return Scripted(60.0), Scripted(100.0)


@pytest.fixture
def pipeline(laws: tuple[Scripted, Scripted]) -> Pipeline:
    built = Pipeline(
        Plausibility(Vehicle(), 0.002),
        Estimator(Vehicle()),
        Supervisor(SupervisorSettings()),
        Law(ControllerKind.KMPC, 0.1, laws),
        (Gate(GateSettings(), 0.002), Gate(GateSettings(), 0.002)),
    )
    for _ in range(12):
        built.step(measurement())
    return built


def test_each_motor_gets_its_own_ceiling(pipeline: Pipeline) -> None:
    command = pipeline.step(measurement())
    assert command.limits == TorqueLimits(60.0, NO_LIMIT)
    assert command.active == (True, False)
    assert command.state is TcsState.ACTIVE


def test_no_motor_is_limited_before_the_inputs_are_trusted(
    laws: tuple[Scripted, Scripted],
) -> None:
    pipeline = Pipeline(
        Plausibility(Vehicle(), 0.002),
        Estimator(Vehicle()),
        Supervisor(SupervisorSettings()),
        Law(ControllerKind.KMPC, 0.1, laws),
        (Gate(GateSettings(), 0.002), Gate(GateSettings(), 0.002)),
    )
    command = pipeline.step(measurement(rear_speed_age_s=math.inf))
    assert command.limits == TorqueLimits(NO_LIMIT, NO_LIMIT)
    assert command.state is TcsState.INIT
    assert laws[0].steps == 0


def test_a_failed_solve_holds_the_ceiling_and_says_so(
    pipeline: Pipeline, laws: tuple[Scripted, Scripted]
) -> None:
    laws[0].proposal = Proposal(100.0, SolveStatus.FAILED)
    command = pipeline.step(measurement())
    assert command.limits.left_nm == 60.0
    assert (command.state, command.fault_code) == (
        TcsState.DEGRADED,
        FaultCode.CONTROLLER_SILENT,
    )


def test_a_law_that_fails_for_want_of_inputs_is_not_the_reason(
    pipeline: Pipeline, laws: tuple[Scripted, Scripted]
) -> None:
    laws[0].proposal = Proposal(100.0, SolveStatus.FAILED)
    command = pipeline.step(measurement(rear_speed_age_s=0.007))
    assert command.limits.left_nm == 60.0
    assert (command.state, command.fault_code) == (TcsState.DEGRADED, FaultCode.REAR_SPEED_LATE)


def test_a_fault_ramps_the_ceiling_up_and_forgets_the_integrators(
    pipeline: Pipeline, laws: tuple[Scripted, Scripted]
) -> None:
    lost = measurement(rear_speed_age_s=0.1)
    resets = laws[0].resets
    limits = [pipeline.step(lost).limits.left_nm for _ in range(45)]
    assert limits[:3] == [61.0, 62.0, 63.0]
    assert limits[-1] == NO_LIMIT
    assert laws[0].resets > resets


def test_an_abandoned_tick_hands_the_torque_back(pipeline: Pipeline) -> None:
    command = pipeline.abandon(measurement())
    assert command.limits.left_nm == 61.0
    assert (command.state, command.fault_code) == (TcsState.FAULT, FaultCode.INTERNAL_ERROR)


def test_the_trace_tells_what_was_proposed(pipeline: Pipeline) -> None:
    pipeline.step(measurement())
    assert pipeline.trace is not None
    assert [p.torque_nm for p in pipeline.trace.proposals] == [60.0, 100.0]


def test_what_is_not_believed_is_kept_from_the_estimator_and_told(pipeline: Pipeline) -> None:
    jumped = measurement(wheel_speed_radps=(20.0, 20.0, 60.0, 20.0))
    command = pipeline.step(jumped)
    assert (command.state, command.fault_code) == (
        TcsState.DEGRADED,
        FaultCode.ONE_REAR_SPEED_IMPLAUSIBLE,
    )
    assert pipeline.trace is not None
    assert pipeline.trace.suspects == Suspect.WHEEL_RL
    assert pipeline.trace.estimate.vehicle_speed_mps == pytest.approx(20.0 * 0.318)


def test_a_stand_in_for_a_law_is_followed_slowly(
    pipeline: Pipeline, laws: tuple[Scripted, Scripted]
) -> None:
    stand_in = Proposal(90.0, SolveStatus.FAILED, source=Source.FALLBACK)
    laws[0].proposal = stand_in
    command = pipeline.step(measurement())
    assert command.limits.left_nm == 61.0
    assert (command.state, command.fault_code) == (
        TcsState.DEGRADED,
        FaultCode.CONTROLLER_REPLACED,
    )


def test_a_motor_that_is_asked_to_brake_is_no_reason_to_degrade(pipeline: Pipeline) -> None:
    command = pipeline.step(measurement(driver_torque_nm=(-20.0, 100.0)))
    assert command.fault_code is FaultCode.NONE
    assert command.limits.left_nm == 0.0


def test_overruns_reach_the_supervisor(pipeline: Pipeline) -> None:
    for _ in range(5):
        pipeline.sent(overran=True)
    assert pipeline.step(measurement()).fault_code is FaultCode.OVERRUNS


def test_what_was_allowed_reaches_the_plausibility(
    pipeline: Pipeline, laws: tuple[Scripted, Scripted]
) -> None:
    codes = [pipeline.step(measurement()).fault_code for _ in range(60)]
    assert codes[-1] is FaultCode.MOTOR_STATE_IMPLAUSIBLE  # 60 Nm allowed and none given
