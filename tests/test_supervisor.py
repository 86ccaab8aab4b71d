"""The state table, rule by rule, and the ways through it."""

import math
from itertools import product
from typing import Any

import msgspec
import pytest
from factories import measurement
from hypothesis import given
from hypothesis import strategies as st
from msgspec.structs import replace

from tcs_hil.control.protocol import Proposal, SolveStatus, Source
from tcs_hil.fault_codes import MEANINGS, FaultCode
from tcs_hil.gate import Permission
from tcs_hil.judgement import Health, Situation, Verdict
from tcs_hil.signals import BusCondition, InputState, Suspect, TcsState
from tcs_hil.supervisor import (
    CALM,
    RULES,
    Supervisor,
    SupervisorSettings,
    first_reason,
)

INIT, STANDBY, ACTIVE = TcsState.INIT, TcsState.STANDBY, TcsState.ACTIVE
DEGRADED, FAULT = TcsState.DEGRADED, TcsState.FAULT
FOLLOW, SLOWLY, HOLD, RELEASE = Permission

GOOD = measurement()
LATE = measurement(rear_speed_age_s=0.007)
LOST = measurement(rear_speed_age_s=0.023)
ONE_REAR = measurement(wheel_speed_valid=(True, True, False, True))
LAW = (Proposal(50.0), Proposal(60.0))
SILENT = (Proposal(50.0), Proposal(60.0, SolveStatus.FAILED))
PLAN = (Proposal(50.0, SolveStatus.FAILED, source=Source.LAST_PLAN), Proposal(60.0))


@pytest.fixture
def supervisor() -> Supervisor:
    return Supervisor(SupervisorSettings())


@pytest.fixture
def running(supervisor: Supervisor) -> Supervisor:
    for _ in range(11):
        supervisor.judge(GOOD)
    return supervisor


def states(supervisor: Supervisor, measured: Any, n: int) -> list[TcsState]:
    return [supervisor.judge(measured).state for _ in range(n)]


def test_it_leaves_init_after_ten_good_ticks_and_releases_until_standby_was_shown(
    supervisor: Supervisor,
) -> None:
    verdicts = [supervisor.judge(GOOD) for _ in range(11)]
    assert [v.state for v in verdicts] == [INIT] * 9 + [STANDBY] * 2
    assert [v.permission for v in verdicts] == [RELEASE] * 10 + [FOLLOW]
    assert {v.fault_code for v in verdicts} == {FaultCode.NONE}


def test_before_its_first_tick_it_holds_nobody_back(supervisor: Supervisor) -> None:
    assert supervisor.limiting() == Verdict(INIT, FaultCode.NONE, RELEASE)


def test_our_own_code_may_break_before_anything_was_judged(supervisor: Supervisor) -> None:
    assert supervisor.internal_error() == Verdict(FAULT, FaultCode.INTERNAL_ERROR, RELEASE)


def test_it_waits_in_init_for_inputs_and_says_so(supervisor: Supervisor) -> None:
    states(supervisor, GOOD, 9)
    verdict = supervisor.judge(measurement(driver_age_s=math.inf))
    assert verdict == Verdict(INIT, FaultCode.AWAITING_INPUT, RELEASE)
    assert states(supervisor, GOOD, 10) == [INIT] * 9 + [STANDBY]


def test_a_late_input_is_a_reason_to_stay_in_init(supervisor: Supervisor) -> None:
    assert supervisor.judge(LATE) == Verdict(INIT, FaultCode.REAR_SPEED_LATE, RELEASE)


def test_what_is_no_input_takes_init_to_fault(supervisor: Supervisor) -> None:
    verdict = supervisor.judge(measurement(bus=BusCondition.INTRUDER))
    assert verdict == Verdict(FAULT, FaultCode.BUS_INTRUDER, RELEASE)


def test_a_car_that_starts_with_one_bad_rear_sensor_is_controlled_slowly(
    supervisor: Supervisor,
) -> None:
    assert states(supervisor, ONE_REAR, 10) == [INIT] * 9 + [STANDBY]
    verdict = supervisor.judge(ONE_REAR)
    assert verdict == Verdict(DEGRADED, FaultCode.ONE_REAR_SPEED_INVALID, SLOWLY)


def test_standby_names_no_fault(supervisor: Supervisor) -> None:
    assert [supervisor.judge(ONE_REAR).fault_code for _ in range(10)][-1] is FaultCode.NONE


def test_holding_a_motor_turns_standby_into_active_and_letting_go_back(running: Supervisor) -> None:
    assert running.judge(GOOD).state is STANDBY
    assert running.limiting() == Verdict(ACTIVE, FaultCode.NONE, FOLLOW)
    assert running.judge(GOOD).state is STANDBY
    assert running.limiting().state is ACTIVE


def test_standby_is_shown_before_active(supervisor: Supervisor) -> None:
    states(supervisor, GOOD, 10)
    assert supervisor.limiting().state is STANDBY
    supervisor.judge(GOOD)
    assert supervisor.limiting().state is ACTIVE


@pytest.mark.parametrize("lost_frames", [0, 1, 2])
def test_up_to_two_lost_frames_are_bridged(running: Supervisor, lost_frames: int) -> None:
    age_s = 0.0019 + 0.002 * lost_frames
    assert running.judge(measurement(rear_speed_age_s=age_s)).permission is FOLLOW


@pytest.mark.parametrize("lost_frames", [3, 10])
def test_three_to_ten_lost_frames_degrade_and_hold(running: Supervisor, lost_frames: int) -> None:
    verdict = running.judge(measurement(rear_speed_age_s=0.002 * lost_frames))
    assert verdict == Verdict(DEGRADED, FaultCode.REAR_SPEED_LATE, HOLD)


def test_more_than_ten_lost_frames_hand_the_torque_back(running: Supervisor) -> None:
    verdict = running.judge(measurement(rear_speed_age_s=0.022))
    assert verdict == Verdict(FAULT, FaultCode.REAR_SPEED_LOST, RELEASE)


def test_degraded_ends_after_ten_ticks_without_a_reason_and_follows_slowly_until_then(
    running: Supervisor,
) -> None:
    running.judge(LATE)
    verdicts = [running.judge(GOOD) for _ in range(10)]
    assert verdicts[:9] == [Verdict(DEGRADED, FaultCode.REAR_SPEED_LATE, SLOWLY)] * 9
    assert verdicts[9] == Verdict(STANDBY, FaultCode.NONE, FOLLOW)
    assert running.limiting().state is STANDBY


def test_degraded_lasts_as_long_as_its_reason(running: Supervisor) -> None:
    assert states(running, ONE_REAR, 99) == [DEGRADED] * 99


def test_a_reason_in_between_begins_the_way_back_anew(running: Supervisor) -> None:
    running.judge(LATE)
    states(running, GOOD, 9)
    running.judge(ONE_REAR)
    assert states(running, GOOD, 10) == [DEGRADED] * 9 + [STANDBY]


def test_a_fault_is_left_after_ten_good_ticks_and_keeps_its_reason_until_then(
    running: Supervisor,
) -> None:
    running.judge(LOST)
    verdicts = [running.judge(GOOD) for _ in range(11)]
    assert verdicts[:9] == [Verdict(FAULT, FaultCode.REAR_SPEED_LOST, RELEASE)] * 9
    assert verdicts[9] == Verdict(STANDBY, FaultCode.NONE, RELEASE)
    assert verdicts[10] == Verdict(STANDBY, FaultCode.NONE, FOLLOW)


def test_a_fault_is_left_although_a_rear_sensor_stays_bad_and_keeps_its_own_reason(
    running: Supervisor,
) -> None:
    running.judge(LOST)
    verdicts = [running.judge(ONE_REAR) for _ in range(11)]
    assert verdicts[8] == Verdict(FAULT, FaultCode.REAR_SPEED_LOST, RELEASE)
    assert [v.state for v in verdicts[8:]] == [FAULT, STANDBY, DEGRADED]


def test_a_fault_is_not_left_while_inputs_are_late(running: Supervisor) -> None:
    running.judge(LOST)
    states(running, GOOD, 9)
    assert running.judge(LATE).state is FAULT
    assert states(running, GOOD, 10) == [FAULT] * 9 + [STANDBY]


def test_a_new_fault_while_in_fault_is_named(running: Supervisor) -> None:
    running.judge(LOST)
    verdict = running.judge(measurement(bus=BusCondition.BUS_OFF))
    assert verdict == Verdict(FAULT, FaultCode.BUS_OFF, RELEASE)


def test_an_input_that_starts_anew_is_a_fault_once_the_service_has_run(running: Supervisor) -> None:
    verdict = running.judge(measurement(front_speed_state=InputState.NO_DATA))
    assert verdict == Verdict(FAULT, FaultCode.AWAITING_INPUT, RELEASE)


INPUTS = ["front_speed", "rear_speed", "motor", "driver"]
ONE, THREE, TEN, ELEVEN = 0.002, 0.006, 0.0219, 0.022


@pytest.mark.parametrize(
    ("changes", "state", "code", "permission"),
    [
        ({"front_speed_age_s": THREE}, DEGRADED, FaultCode.FRONT_SPEED_LATE, HOLD),
        ({"front_speed_age_s": ELEVEN}, FAULT, FaultCode.FRONT_SPEED_LOST, RELEASE),
        ({"rear_speed_age_s": THREE}, DEGRADED, FaultCode.REAR_SPEED_LATE, HOLD),
        ({"rear_speed_age_s": TEN}, DEGRADED, FaultCode.REAR_SPEED_LATE, HOLD),
        ({"rear_speed_age_s": ELEVEN}, FAULT, FaultCode.REAR_SPEED_LOST, RELEASE),
        ({"motor_age_s": THREE}, DEGRADED, FaultCode.MOTOR_STATE_LATE, SLOWLY),
        ({"motor_age_s": ELEVEN}, DEGRADED, FaultCode.MOTOR_STATE_LATE, SLOWLY),
        ({"motor_age_s": math.inf}, DEGRADED, FaultCode.MOTOR_STATE_LATE, SLOWLY),
        ({"driver_age_s": 0.029}, STANDBY, FaultCode.NONE, FOLLOW),
        ({"driver_age_s": 0.030}, DEGRADED, FaultCode.DRIVER_REQUEST_LATE, HOLD),
        ({"driver_age_s": 0.109}, DEGRADED, FaultCode.DRIVER_REQUEST_LATE, HOLD),
        ({"driver_age_s": 0.110}, FAULT, FaultCode.DRIVER_REQUEST_LOST, RELEASE),
        (
            {"front_speed_state": InputState.INVALID},
            FAULT,
            FaultCode.FRONT_SPEED_CORRUPT,
            RELEASE,
        ),
        ({"rear_speed_state": InputState.INVALID}, FAULT, FaultCode.REAR_SPEED_CORRUPT, RELEASE),
        ({"motor_state": InputState.INVALID}, DEGRADED, FaultCode.MOTOR_STATE_CORRUPT, SLOWLY),
        ({"driver_state": InputState.INVALID}, FAULT, FaultCode.DRIVER_REQUEST_CORRUPT, RELEASE),
        ({"rear_speed_state": InputState.INIT}, FAULT, FaultCode.AWAITING_INPUT, RELEASE),
        ({"driver_state": InputState.NO_DATA}, FAULT, FaultCode.AWAITING_INPUT, RELEASE),
        ({"motor_state": InputState.INIT}, DEGRADED, FaultCode.MOTOR_STATE_LATE, SLOWLY),
        (
            {"rear_speed_state": InputState.INVALID, "rear_speed_age_s": ELEVEN},
            FAULT,
            FaultCode.REAR_SPEED_LOST,
            RELEASE,
        ),
        ({"bus": BusCondition.OVERFLOW}, DEGRADED, FaultCode.BUS_OVERFLOW, SLOWLY),
        ({"bus": BusCondition.SEND_FAILED}, DEGRADED, FaultCode.SEND_FAILED, SLOWLY),
        ({"bus": BusCondition.ERROR_PASSIVE}, DEGRADED, FaultCode.BUS_ERROR_PASSIVE, SLOWLY),
        ({"bus": BusCondition.DOWN}, FAULT, FaultCode.BUS_DOWN, RELEASE),
        ({"bus": BusCondition.BUS_OFF}, FAULT, FaultCode.BUS_OFF, RELEASE),
        ({"bus": BusCondition.INTRUDER}, FAULT, FaultCode.BUS_INTRUDER, RELEASE),
    ],
)
def test_every_message_and_the_bus_have_their_reaction(
    running: Supervisor,
    changes: dict[str, Any],
    state: TcsState,
    code: FaultCode,
    permission: Permission,
) -> None:
    assert running.judge(measurement(**changes)) == Verdict(state, code, permission)


@pytest.mark.parametrize("wheel", range(4))
def test_every_wheel_has_its_reaction_whether_invalid_or_implausible(
    running: Supervisor, wheel: int
) -> None:
    valid = tuple(i != wheel for i in range(4))
    suspect = (Suspect.WHEEL_FL, Suspect.WHEEL_FR, Suspect.WHEEL_RL, Suspect.WHEEL_RR)[wheel]
    name = "FRONT_SPEED" if wheel < 2 else "ONE_REAR_SPEED"
    invalid = running.judge(measurement(wheel_speed_valid=valid))
    assert invalid == Verdict(DEGRADED, FaultCode[f"{name}_INVALID"], SLOWLY)
    implausible = running.judge(GOOD, suspect)
    assert implausible == Verdict(DEGRADED, FaultCode[f"{name}_IMPLAUSIBLE"], SLOWLY)


@pytest.mark.parametrize(
    ("suspects", "valid", "state", "code"),
    [
        ([Suspect.WHEEL_RL, Suspect.WHEEL_RR], (1, 1, 1, 1), FAULT, "REAR_SPEEDS_IMPLAUSIBLE"),
        ([Suspect.WHEEL_RL], (1, 1, 1, 0), FAULT, "REAR_SPEEDS_INVALID"),
        ([], (1, 1, 0, 0), FAULT, "REAR_SPEEDS_INVALID"),
        ([], (0, 0, 1, 1), DEGRADED, "FRONT_SPEED_INVALID"),
        ([Suspect.WHEEL_FL, Suspect.MOTOR_RIGHT], (1, 1, 1, 1), FAULT, "FRONT_WHEEL_UNKNOWN"),
        ([Suspect.MOTOR_LEFT], (1, 0, 1, 1), FAULT, "FRONT_WHEEL_UNKNOWN"),
        ([Suspect.MOTOR_LEFT], (1, 1, 0, 1), DEGRADED, "ONE_REAR_SPEED_INVALID"),
        ([Suspect.MOTOR_LEFT], (1, 1, 1, 1), DEGRADED, "MOTOR_STATE_IMPLAUSIBLE"),
        ([Suspect.MOTOR_RIGHT], (1, 1, 1, 1), DEGRADED, "MOTOR_STATE_IMPLAUSIBLE"),
        ([Suspect.ACCELEROMETER], (1, 1, 1, 1), DEGRADED, "ACCELERATION_IMPLAUSIBLE"),
        ([Suspect.DRIVER], (1, 1, 1, 1), FAULT, "DRIVER_REQUEST_IMPLAUSIBLE"),
    ],
)
def test_what_is_left_of_the_sensors_decides(
    running: Supervisor, suspects: list[Suspect], valid: tuple[int, ...], state: TcsState, code: str
) -> None:
    flags = tuple(bool(flag) for flag in valid)
    verdict = running.judge(measurement(wheel_speed_valid=flags), sum(suspects))
    permission = RELEASE if state is FAULT else SLOWLY
    assert verdict == Verdict(state, FaultCode[code], permission)


@pytest.mark.parametrize(
    "motor",
    [
        {"motor_age_s": THREE},
        {"motor_age_s": math.inf},
        {"motor_state": InputState.INVALID},
        {"motor_state": InputState.ABSENT},
    ],
)
def test_a_front_wheel_without_sensor_and_motor_is_unknown(
    running: Supervisor, motor: dict[str, Any]
) -> None:
    blind = measurement(wheel_speed_valid=(True, False, True, True), **motor)
    assert running.judge(blind) == Verdict(FAULT, FaultCode.FRONT_WHEEL_UNKNOWN, RELEASE)


def test_controllers_that_decide_change_nothing(running: Supervisor) -> None:
    verdict = running.judge(GOOD)
    assert running.heard(LAW) == verdict
    assert running.heard((Proposal(1.0, SolveStatus.MAX_ITERATIONS), LAW[1])) == verdict


def test_a_stand_in_for_a_law_is_followed_slowly(running: Supervisor) -> None:
    running.judge(GOOD)
    assert running.heard(PLAN) == Verdict(DEGRADED, FaultCode.CONTROLLER_REPLACED, SLOWLY)
    assert running.limiting().state is DEGRADED


@pytest.mark.parametrize(
    "proposal",
    [
        Proposal(60.0, SolveStatus.FAILED),
        Proposal(60.0, SolveStatus.BAD_INPUT),
        Proposal(math.nan),
        Proposal(math.inf),
    ],
)
@pytest.mark.parametrize("side", [0, 1])
def test_a_silent_controller_holds(running: Supervisor, proposal: Proposal, side: int) -> None:
    running.judge(GOOD)
    proposals = (proposal, LAW[0]) if side == 0 else (LAW[0], proposal)
    assert running.heard(proposals) == Verdict(DEGRADED, FaultCode.CONTROLLER_SILENT, HOLD)


def test_controllers_that_are_silent_for_more_than_ten_ticks_are_lost(running: Supervisor) -> None:
    verdicts = []
    for _ in range(11):
        running.judge(GOOD)
        verdicts.append(running.heard(SILENT))
    assert verdicts[:10] == [Verdict(DEGRADED, FaultCode.CONTROLLER_SILENT, HOLD)] * 10
    assert verdicts[10] == Verdict(FAULT, FaultCode.CONTROLLER_LOST, RELEASE)


def test_a_word_in_between_ends_the_silence(running: Supervisor) -> None:
    for answers in [SILENT] * 10 + [LAW] + [SILENT] * 10:
        running.judge(GOOD)
        verdict = running.heard(answers)
    assert verdict.state is DEGRADED


def test_a_law_without_inputs_is_no_news(running: Supervisor) -> None:
    running.judge(LATE)
    assert running.heard(SILENT) == Verdict(DEGRADED, FaultCode.REAR_SPEED_LATE, HOLD)


def test_a_silent_law_is_worse_than_a_bad_sensor(running: Supervisor) -> None:
    running.judge(ONE_REAR)
    assert running.heard(SILENT) == Verdict(DEGRADED, FaultCode.CONTROLLER_SILENT, HOLD)


def test_the_way_back_begins_when_the_law_decides_again(running: Supervisor) -> None:
    for answers in [LAW, PLAN]:
        running.judge(GOOD)
        running.heard(answers)
    assert states(running, GOOD, 10) == [DEGRADED] * 9 + [STANDBY]


def test_an_internal_error_is_a_fault_that_must_be_earned_back(running: Supervisor) -> None:
    running.judge(GOOD)
    assert running.internal_error() == Verdict(FAULT, FaultCode.INTERNAL_ERROR, RELEASE)
    assert states(running, GOOD, 10) == [FAULT] * 9 + [STANDBY]


def test_an_internal_error_outranks_what_was_wrong_before(running: Supervisor) -> None:
    running.judge(measurement(bus=BusCondition.INTRUDER))
    assert running.internal_error().fault_code is FaultCode.INTERNAL_ERROR


@pytest.mark.parametrize(("overruns", "state"), [(4, STANDBY), (5, DEGRADED), (9, DEGRADED)])
def test_five_overruns_in_a_row_degrade(
    running: Supervisor, overruns: int, state: TcsState
) -> None:
    for _ in range(overruns):
        running.sent(overran=True)
    assert running.judge(GOOD).state is state


@pytest.mark.parametrize(("overruns", "state"), [(4, STANDBY), (5, DEGRADED)])
def test_a_tick_in_time_begins_the_count_of_overruns_anew(
    running: Supervisor, overruns: int, state: TcsState
) -> None:
    for overran in (*[True] * 4, False, *[True] * overruns):
        running.sent(overran)
    assert running.judge(GOOD).state is state


def test_the_reason_of_overruns_is_named_until_a_tick_is_in_time(running: Supervisor) -> None:
    for _ in range(5):
        running.sent(overran=True)
    assert running.judge(GOOD) == Verdict(DEGRADED, FaultCode.OVERRUNS, SLOWLY)
    running.sent(overran=False)
    assert states(running, GOOD, 10) == [DEGRADED] * 9 + [STANDBY]


def test_the_settings_are_the_patience(running: Supervisor) -> None:
    settings = SupervisorSettings(
        bridged_cycles=0, tolerated_cycles=1, good_ticks_to_recover=2, overruns_to_degrade=1
    )
    quick = Supervisor(settings)
    assert states(quick, GOOD, 3) == [INIT, STANDBY, STANDBY]
    assert quick.judge(measurement(rear_speed_age_s=ONE)).state is DEGRADED
    assert quick.judge(measurement(rear_speed_age_s=2 * ONE)).state is FAULT
    quick = Supervisor(settings)
    states(quick, GOOD, 3)
    quick.sent(overran=True)
    assert quick.judge(GOOD).state is DEGRADED


def test_the_shipped_patience_is_that_of_the_documentation() -> None:
    assert msgspec.to_builtins(SupervisorSettings()) == {
        "bridged_cycles": 2,
        "tolerated_cycles": 10,
        "good_ticks_to_recover": 10,
        "overruns_to_degrade": 5,
    }


@pytest.mark.parametrize(
    "table",
    [
        {"bridged_cycles": -1},
        {"bridged_cycles": 101},
        {"tolerated_cycles": 101},
        {"good_ticks_to_recover": 0},
        {"good_ticks_to_recover": 1001},
        {"overruns_to_degrade": 0},
        {"unheard_of": 1},
    ],
)
def test_a_setting_out_of_bounds_is_refused(table: dict[str, int]) -> None:
    with pytest.raises(msgspec.ValidationError):
        msgspec.convert(table, SupervisorSettings)


SITUATIONS = st.builds(
    Situation,
    *[st.sampled_from(Health)] * 4,
    suspects=st.integers(0, 255),
    unusable=st.integers(0, 255),
    bus=st.sampled_from(BusCondition),
    overrunning=st.booleans(),
    replaced=st.booleans(),
    silent=st.booleans(),
    mute=st.booleans(),
    broken=st.booleans(),
)


def test_no_rule_holds_in_the_calm() -> None:
    assert not [rule.code for rule in RULES if rule.holds(CALM)]
    assert first_reason(CALM) is None


def test_worse_rules_come_first_and_each_state_has_its_permissions() -> None:
    assert [rule.permission for rule in RULES] == sorted(
        (rule.permission for rule in RULES), reverse=True
    )
    for rule in RULES:
        assert (rule.state is FAULT) == (rule.permission is RELEASE)
        assert rule.state in (FAULT, DEGRADED)


@given(SITUATIONS)
def test_the_reason_is_the_worst_of_the_rules_that_hold(situation: Situation) -> None:
    holding = [rule for rule in RULES if rule.holds(situation)]
    reason = first_reason(situation)
    assert reason is (holding[0] if holding else None)


def test_every_code_but_none_has_exactly_one_rule_and_every_code_a_meaning() -> None:
    assert sorted(rule.code for rule in RULES) == sorted(set(FaultCode) - {FaultCode.NONE})
    assert set(MEANINGS) == set(FaultCode)
    assert max(FaultCode) < 256


def test_input_and_bus_states_that_differ_in_one_thing_only_have_a_reason() -> None:
    for name, health in product(("front", "rear", "motor", "driver"), Health):
        reason = first_reason(replace(CALM, **{name: health}))
        spared = name == "motor" and health is Health.ABSENT
        assert (reason is None) == (health is Health.GOOD or spared)
    for bus in BusCondition:
        assert (first_reason(replace(CALM, bus=bus)) is None) == (bus is BusCondition.OK)
