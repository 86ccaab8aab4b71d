import pytest
from factories import measurement

from tcs_hil.gate import Permission
from tcs_hil.signals import TcsState
from tcs_hil.supervisor import FaultCode, Supervisor, SupervisorSettings

GOOD = measurement()
LATE = measurement(rear_speed_age_s=0.007)
LOST = measurement(rear_speed_age_s=0.023)


@pytest.fixture
def supervisor() -> Supervisor:
    return Supervisor(SupervisorSettings())


@pytest.fixture
def running(supervisor: Supervisor) -> Supervisor:
    for _ in range(10):
        supervisor.judge(GOOD)
    return supervisor


def test_it_waits_in_init_until_ten_good_ticks(supervisor: Supervisor) -> None:
    states = [supervisor.judge(GOOD).state for _ in range(11)]
    assert states == [TcsState.INIT] * 9 + [TcsState.STANDBY] * 2


def test_nothing_is_controlled_in_init(supervisor: Supervisor) -> None:
    assert supervisor.judge(GOOD).permission is Permission.RELEASE


def test_holding_a_motor_turns_standby_into_active_for_that_tick(running: Supervisor) -> None:
    assert running.judge(GOOD).state is TcsState.STANDBY
    assert running.limiting().state is TcsState.ACTIVE
    assert running.judge(GOOD).state is TcsState.STANDBY


@pytest.mark.parametrize("lost_frames", [0, 1, 2])
def test_up_to_two_lost_frames_are_bridged(running: Supervisor, lost_frames: int) -> None:
    age_s = 0.0019 + 0.002 * lost_frames
    assert running.judge(measurement(rear_speed_age_s=age_s)).permission is Permission.FOLLOW


@pytest.mark.parametrize("lost_frames", [3, 10])
def test_three_to_ten_lost_frames_degrade_and_hold(running: Supervisor, lost_frames: int) -> None:
    verdict = running.judge(measurement(rear_speed_age_s=0.0005 + 0.002 * lost_frames))
    assert (verdict.state, verdict.permission) == (TcsState.DEGRADED, Permission.HOLD)
    assert verdict.fault_code is FaultCode.REAR_SPEED_LATE


def test_more_than_ten_lost_frames_hand_the_torque_back(running: Supervisor) -> None:
    verdict = running.judge(LOST)
    assert (verdict.state, verdict.permission) == (TcsState.FAULT, Permission.RELEASE)


def test_degraded_ends_with_the_first_good_tick(running: Supervisor) -> None:
    running.judge(LATE)
    assert running.judge(GOOD).state is TcsState.STANDBY


def test_fault_is_left_after_ten_good_ticks_and_keeps_its_reason_until_then(
    running: Supervisor,
) -> None:
    running.judge(LOST)
    verdicts = [running.judge(GOOD) for _ in range(10)]
    assert [v.state for v in verdicts] == [TcsState.FAULT] * 9 + [TcsState.STANDBY]
    assert verdicts[8].fault_code is FaultCode.REAR_SPEED_LATE
    assert verdicts[9].fault_code is FaultCode.NONE


@pytest.mark.parametrize(
    ("changes", "state", "code"),
    [
        ({"driver_age_s": 0.031}, TcsState.DEGRADED, FaultCode.DRIVER_REQUEST_LATE),
        ({"driver_age_s": 0.111}, TcsState.FAULT, FaultCode.DRIVER_REQUEST_LATE),
        ({"front_speed_age_s": 0.023}, TcsState.FAULT, FaultCode.FRONT_SPEED_LATE),
        (
            {"wheel_speed_valid": (True, True, False, True)},
            TcsState.DEGRADED,
            FaultCode.ONE_REAR_SPEED_INVALID,
        ),
        (
            {"wheel_speed_valid": (True, True, False, False)},
            TcsState.FAULT,
            FaultCode.REAR_SPEEDS_INVALID,
        ),
        (
            {"wheel_speed_valid": (True, False, True, True)},
            TcsState.DEGRADED,
            FaultCode.FRONT_SPEED_INVALID,
        ),
    ],
)
def test_each_input_fault_has_its_state_and_code(
    running: Supervisor, changes: dict[str, object], state: TcsState, code: FaultCode
) -> None:
    verdict = running.judge(measurement(**changes))
    assert (verdict.state, verdict.fault_code) == (state, code)


def test_a_failed_controller_holds(running: Supervisor) -> None:
    running.judge(GOOD)
    verdict = running.controller_failed()
    assert (verdict.state, verdict.permission) == (TcsState.DEGRADED, Permission.HOLD)
    assert running.limiting().state is TcsState.DEGRADED


def test_an_internal_error_is_a_fault_that_must_be_earned_back(running: Supervisor) -> None:
    running.judge(GOOD)
    assert running.internal_error().permission is Permission.RELEASE
    assert running.judge(GOOD).state is TcsState.FAULT
