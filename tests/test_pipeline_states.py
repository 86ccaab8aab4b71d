"""Any sequence of measurements through the whole pipeline around laws that do as they like.

What must hold on every tick, whatever comes in: no limit above the request, none
that rises faster than the state allows, FAULT that ends without a limit, and a way
back that shows STANDBY.
"""

import math
from typing import Any

from factories import measurement
from hypothesis import settings
from hypothesis import strategies as st
from hypothesis.stateful import RuleBasedStateMachine, invariant, precondition, rule
from msgspec.structs import replace

from tcs_hil.control.protocol import Proposal, SolveStatus, Source, WheelState
from tcs_hil.estimator import Estimator
from tcs_hil.gate import Gate, Permission
from tcs_hil.model.vehicle import Vehicle
from tcs_hil.pipeline import Law, Pipeline
from tcs_hil.plausibility import Plausibility
from tcs_hil.safety_settings import GateSettings, SupervisorSettings
from tcs_hil.signals import (
    NO_LIMIT,
    BusCondition,
    Command,
    ControllerKind,
    InputState,
    Measurement,
    TcsState,
    TorqueLimits,
)
from tcs_hil.supervisor import Supervisor

PERIOD_S = 0.002
REQUEST_NM = 250.0
GATE = GateSettings()
RISE_NM = GATE.rise_rate_nmps * PERIOD_S
RELEASE_NM = GATE.release_rate_nmps * PERIOD_S
RELEASE_TICKS = round(REQUEST_NM / RELEASE_NM) + 20
GOOD = measurement(driver_torque_nm=(REQUEST_NM, REQUEST_NM))
GOOD_A_BIT_LATER = replace(GOOD, wheel_speed_radps=(20.01,) * 4, motor_speed_radps=(60.05, 60.05))
LEAST_NM = 40.0  # a motor that gives nothing of so little is not conspicuous

ANY = st.floats(allow_nan=True, allow_infinity=True)
SPEEDS = ANY | st.floats(0.0, 200.0)
AGES = st.sampled_from([0.001, 0.0059, 0.007, 0.021, 0.023, 0.2, math.inf])
ANSWERS = st.builds(
    Proposal,
    ANY | st.floats(0.0, REQUEST_NM),
    st.sampled_from(SolveStatus),
    source=st.sampled_from(Source),
)


def changes(**strategies: Any) -> Any:
    return st.fixed_dictionaries({}, optional=strategies)


BAD = changes(
    wheel_speed_radps=st.tuples(*[SPEEDS] * 4),
    wheel_speed_valid=st.tuples(*[st.booleans()] * 4),
    motor_speed_radps=st.tuples(SPEEDS, SPEEDS),
    motor_torque_nm=st.tuples(ANY, ANY),
    accel_x_mps2=ANY,
    front_speed_age_s=AGES,
    rear_speed_age_s=AGES,
    motor_age_s=AGES,
    driver_age_s=AGES,
    front_speed_state=st.sampled_from(InputState),
    rear_speed_state=st.sampled_from(InputState),
    motor_state=st.sampled_from(InputState),
    driver_state=st.sampled_from(InputState),
    bus=st.sampled_from(BusCondition),
)


class Obedient:
    """A law that answers what it was told to, and may break."""

    def __init__(self) -> None:
        self.answer = Proposal(REQUEST_NM)

    def step(self, wheel: WheelState, torque_ref_nm: float) -> Proposal:
        return self.answer

    def reset(self) -> None:
        pass


class Service(RuleBasedStateMachine):
    def __init__(self) -> None:
        super().__init__()
        self.laws = Obedient(), Obedient()
        self.pipeline = Pipeline(
            Plausibility(Vehicle(), PERIOD_S),
            Estimator(Vehicle()),
            Supervisor(SupervisorSettings()),
            Law(ControllerKind.NMPC, 0.1, self.laws),
            (Gate(GATE, PERIOD_S), Gate(GATE, PERIOD_S)),
        )
        self.state = TcsState.INIT
        self.limits = TorqueLimits()
        self.request_nm = REQUEST_NM

    def tick(self, m: Measurement, *, broken: bool = False) -> Command:
        command = self.pipeline.abandon(m) if broken else self.pipeline.step(m)
        self.judge(command, m)
        self.state, self.limits = command.state, command.limits
        return command

    def judge(self, command: Command, m: Measurement) -> None:
        trace = self.pipeline.trace
        assert trace is not None
        permission = trace.verdict.permission
        rise_nm = {Permission.FOLLOW: RISE_NM, Permission.HOLD: 0.0}.get(permission, RELEASE_NM)
        for limit, before, request in zip(
            command.limits, self.limits, m.driver_torque_nm, strict=True
        ):
            assert limit >= 0.0
            if limit < NO_LIMIT:
                assert limit <= max(request, 0.0)
                if before < NO_LIMIT:
                    assert limit <= before + rise_nm
            elif before < NO_LIMIT:
                assert permission is not Permission.HOLD
        if self.state in (TcsState.FAULT, TcsState.DEGRADED, TcsState.INIT):
            assert command.state is not TcsState.ACTIVE
        if command.state is TcsState.FAULT:
            assert permission is Permission.RELEASE
        if command.state in (TcsState.FAULT, TcsState.DEGRADED):
            assert command.fault_code
        self.pipeline.sent(overran=False)

    @rule(left=ANSWERS, right=ANSWERS)
    def the_laws_change_their_minds(self, left: Proposal, right: Proposal) -> None:
        self.laws[0].answer, self.laws[1].answer = left, right

    @rule(left=st.floats(0.0, REQUEST_NM), right=st.floats(0.0, REQUEST_NM))
    def the_laws_agree_to_limit(self, left: float, right: float) -> None:
        self.laws[0].answer, self.laws[1].answer = Proposal(left), Proposal(right)

    @rule(ticks=st.integers(1, 30))
    def all_is_well(self, ticks: int) -> None:
        for _ in range(ticks):
            self.tick(GOOD)

    @rule(bad=BAD, ticks=st.integers(1, 15))
    def inputs_are_bad(self, bad: dict[str, Any], ticks: int) -> None:
        for _ in range(ticks):
            self.tick(measurement(driver_torque_nm=(REQUEST_NM, REQUEST_NM), **bad))

    @rule(request_nm=st.floats(0.0, 300.0), ticks=st.integers(1, 5))
    def the_driver_moves(self, request_nm: float, ticks: int) -> None:
        for _ in range(ticks):
            self.tick(measurement(driver_torque_nm=(request_nm, REQUEST_NM)))

    @rule()
    def our_code_breaks(self) -> None:
        assert self.tick(GOOD, broken=True).state is TcsState.FAULT

    @rule(ticks=st.integers(1, 7))
    def ticks_overrun(self, ticks: int) -> None:
        for _ in range(ticks):
            self.pipeline.sent(overran=True)

    @precondition(lambda self: self.state is TcsState.FAULT)
    @rule()
    def the_fault_stays(self) -> None:
        for _ in range(RELEASE_TICKS):
            self.tick(GOOD, broken=True)
        assert self.limits == (NO_LIMIT, NO_LIMIT)

    @precondition(lambda self: self.state in (TcsState.FAULT, TcsState.DEGRADED))
    @rule()
    def the_way_back(self) -> None:
        for law in self.laws:
            law.answer = Proposal(LEAST_NM)
        before = self.state
        for number in range(1000):
            # Sensors that are well are never quite still: what stands still may be stuck.
            before, now = self.state, self.tick((GOOD, GOOD_A_BIT_LATER)[number % 2]).state
            if now is TcsState.ACTIVE:
                break
        assert (before, self.state) == (TcsState.STANDBY, TcsState.ACTIVE)

    @invariant()
    def a_state_is_one_of_the_table(self) -> None:
        assert self.state is not TcsState.OFF


Service.TestCase.settings = settings(max_examples=40, stateful_step_count=20, deadline=None)
TestService = Service.TestCase
