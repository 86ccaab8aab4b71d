"""Decides the state of the service and what the gate may do in it.

    INIT -> STANDBY <-> ACTIVE <-> DEGRADED -> FAULT, and from the last two back to STANDBY

``RULES`` is the table: what is watched and what follows from it; the first rule
that holds is the reason.  STANDBY is ACTIVE while a motor is held below what the
driver asks.  The way back takes ``good_ticks_to_recover``: out of INIT and FAULT
of ticks that controllers may follow, out of DEGRADED of ticks without any reason.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Final, NamedTuple

from msgspec.structs import replace

from tcs_hil.control.protocol import Proposal, Source
from tcs_hil.control.screening import decided
from tcs_hil.fault_codes import FaultCode
from tcs_hil.gate import FOLLOW, HOLD, RELEASE, Permission
from tcs_hil.gate import FOLLOW_SLOWLY as SLOWLY
from tcs_hil.judgement import Health, Situation, Verdict
from tcs_hil.safety_settings import SupervisorSettings
from tcs_hil.signals import BusCondition, InputState, Measurement, Suspect, TcsState

PERIOD_S: Final = 0.002
DRIVER_CYCLE_S: Final = 0.010

WHEEL_BITS: Final = (Suspect.WHEEL_FL, Suspect.WHEEL_FR, Suspect.WHEEL_RL, Suspect.WHEEL_RR)
FRONTS: Final = Suspect.WHEEL_FL | Suspect.WHEEL_FR
REARS: Final = Suspect.WHEEL_RL | Suspect.WHEEL_RR
MOTORS: Final = Suspect.MOTOR_LEFT | Suspect.MOTOR_RIGHT

AWAITING: Final = FaultCode.AWAITING_INPUT
VALID: Final = InputState.VALID
NOT_ON_BUS: Final = InputState.ABSENT
NOT_YET: Final = (InputState.NO_DATA, InputState.INIT)


class Rule(NamedTuple):
    """While ``holds``, the service is in ``state`` for the reason ``code``."""

    code: FaultCode
    state: TcsState
    permission: Permission
    holds: Callable[[Situation], bool]


GOOD: Final = Health.GOOD
LATE: Final = Health.LATE
LOST: Final = Health.LOST
CORRUPT: Final = Health.CORRUPT
AWAITED: Final = Health.AWAITED
ABSENT: Final = Health.ABSENT
MISSING: Final = frozenset((AWAITED, ABSENT))

INIT: Final = TcsState.INIT
STANDBY: Final = TcsState.STANDBY
ACTIVE: Final = TcsState.ACTIVE
DEGRADED: Final = TcsState.DEGRADED
FAULT: Final = TcsState.FAULT
NO_FAULT: Final = FaultCode.NONE
LAW: Final = Source.LAW

# fmt: off
RULES: Final[tuple[Rule, ...]] = (
    Rule(FaultCode.INTERNAL_ERROR, FAULT, RELEASE, lambda s: s.broken),
    Rule(FaultCode.BUS_INTRUDER, FAULT, RELEASE, lambda s: s.bus is BusCondition.INTRUDER),
    Rule(FaultCode.BUS_OFF, FAULT, RELEASE, lambda s: s.bus is BusCondition.BUS_OFF),
    Rule(FaultCode.BUS_DOWN, FAULT, RELEASE, lambda s: s.bus is BusCondition.DOWN),
    Rule(FaultCode.AWAITING_INPUT, FAULT, RELEASE,
         lambda s: not MISSING.isdisjoint((s.rear, s.front, s.driver))),
    Rule(FaultCode.REAR_SPEED_CORRUPT, FAULT, RELEASE, lambda s: s.rear is CORRUPT),
    Rule(FaultCode.FRONT_SPEED_CORRUPT, FAULT, RELEASE, lambda s: s.front is CORRUPT),
    Rule(FaultCode.DRIVER_REQUEST_CORRUPT, FAULT, RELEASE, lambda s: s.driver is CORRUPT),
    Rule(FaultCode.REAR_SPEED_LOST, FAULT, RELEASE, lambda s: s.rear is LOST),
    Rule(FaultCode.FRONT_SPEED_LOST, FAULT, RELEASE, lambda s: s.front is LOST),
    Rule(FaultCode.DRIVER_REQUEST_LOST, FAULT, RELEASE, lambda s: s.driver is LOST),
    Rule(FaultCode.REAR_SPEEDS_IMPLAUSIBLE, FAULT, RELEASE, lambda s: s.suspects & REARS == REARS),
    Rule(FaultCode.REAR_SPEEDS_INVALID, FAULT, RELEASE, lambda s: s.unusable & REARS == REARS),
    Rule(FaultCode.FRONT_WHEEL_UNKNOWN, FAULT, RELEASE,
         lambda s: bool(s.unusable & FRONTS)
         and (s.motor is not GOOD or bool(s.suspects & MOTORS))),
    Rule(FaultCode.DRIVER_REQUEST_IMPLAUSIBLE, FAULT, RELEASE,
         lambda s: bool(s.suspects & Suspect.DRIVER)),
    Rule(FaultCode.CONTROLLER_LOST, FAULT, RELEASE, lambda s: s.mute),

    Rule(FaultCode.REAR_SPEED_LATE, DEGRADED, HOLD, lambda s: s.rear is LATE),
    Rule(FaultCode.FRONT_SPEED_LATE, DEGRADED, HOLD, lambda s: s.front is LATE),
    Rule(FaultCode.DRIVER_REQUEST_LATE, DEGRADED, HOLD, lambda s: s.driver is LATE),
    Rule(FaultCode.CONTROLLER_SILENT, DEGRADED, HOLD, lambda s: s.silent),

    Rule(FaultCode.ONE_REAR_SPEED_IMPLAUSIBLE, DEGRADED, SLOWLY,
         lambda s: bool(s.suspects & REARS)),
    Rule(FaultCode.ONE_REAR_SPEED_INVALID, DEGRADED, SLOWLY, lambda s: bool(s.unusable & REARS)),
    Rule(FaultCode.FRONT_SPEED_IMPLAUSIBLE, DEGRADED, SLOWLY, lambda s: bool(s.suspects & FRONTS)),
    Rule(FaultCode.FRONT_SPEED_INVALID, DEGRADED, SLOWLY, lambda s: bool(s.unusable & FRONTS)),
    Rule(FaultCode.MOTOR_STATE_IMPLAUSIBLE, DEGRADED, SLOWLY, lambda s: bool(s.suspects & MOTORS)),
    Rule(FaultCode.MOTOR_STATE_CORRUPT, DEGRADED, SLOWLY, lambda s: s.motor is CORRUPT),
    Rule(FaultCode.MOTOR_STATE_LATE, DEGRADED, SLOWLY,
         lambda s: s.motor not in (GOOD, ABSENT)),
    Rule(FaultCode.ACCELERATION_IMPLAUSIBLE, DEGRADED, SLOWLY,
         lambda s: bool(s.suspects & Suspect.ACCELEROMETER)),
    Rule(FaultCode.CONTROLLER_REPLACED, DEGRADED, SLOWLY, lambda s: s.replaced),
    Rule(FaultCode.OVERRUNS, DEGRADED, SLOWLY, lambda s: s.overrunning),
    Rule(FaultCode.BUS_ERROR_PASSIVE, DEGRADED, SLOWLY,
         lambda s: s.bus is BusCondition.ERROR_PASSIVE),
    Rule(FaultCode.SEND_FAILED, DEGRADED, SLOWLY, lambda s: s.bus is BusCondition.SEND_FAILED),
    Rule(FaultCode.BUS_OVERFLOW, DEGRADED, SLOWLY, lambda s: s.bus is BusCondition.OVERFLOW),
)
# fmt: on
"""The state table, worst first.  Whoever raises the torque must be trusted; lowering it is free."""

CALM: Final = Situation(GOOD, GOOD, GOOD, GOOD, 0, 0, BusCondition.OK)
"""Of almost every tick; no rule holds, so none is tried."""


def first_reason(situation: Situation) -> Rule | None:
    """The worst rule that holds, None where all is well."""
    if situation == CALM:
        return None
    return next((rule for rule in RULES if rule.holds(situation)), None)


class Supervisor:
    """State machine of the service; ``judge`` once a tick, before the controllers are asked."""

    def __init__(self, settings: SupervisorSettings) -> None:
        self._settings = settings
        self._before: TcsState = INIT  # state of the tick before
        self._verdict = Verdict(INIT, NO_FAULT, RELEASE)
        self._situation = CALM
        self._trusted_ticks = 0  # without a reason, or followed slowly for one
        self._calm_ticks = 0  # without a reason
        self._silent_ticks = 0
        self._overruns = 0

    def judge(self, measurement: Measurement, suspects: int = 0) -> Verdict:
        """Judge the inputs; ``suspects`` are the bits of those found implausible."""
        self._before = self._verdict.state
        self._situation = self._look(measurement, suspects)
        self._trusted_ticks += 1
        self._calm_ticks += 1
        return self._settle(first_reason(self._situation))

    def heard(self, proposals: tuple[Proposal, Proposal]) -> Verdict:
        """Judge how the controllers fared; only to be called when they were asked."""
        if decided(proposals[0]) and decided(proposals[1]):
            self._silent_ticks = 0
            return self._verdict
        silent = any(not decided(p) and p.source is LAW for p in proposals)
        self._silent_ticks = self._silent_ticks + 1 if silent else 0
        mute = self._silent_ticks > self._settings.tolerated_cycles
        situation = replace(self._situation, replaced=True, silent=silent, mute=mute)
        return self._settle(first_reason(situation))

    def internal_error(self) -> Verdict:
        """Our own code broke: hand the torque back and begin again."""
        return self._settle(first_reason(replace(self._situation, broken=True)))

    def limiting(self) -> Verdict:
        """The gate holds a motor below the request: STANDBY, once it was shown, is ACTIVE."""
        shown = self._before is STANDBY or self._before is ACTIVE
        if shown and self._verdict.state is STANDBY:
            self._verdict = replace(self._verdict, state=ACTIVE)
        return self._verdict

    def sent(self, overran: bool) -> None:
        """Hear, after the tick, whether its limits went out after the deadline."""
        self._overruns = self._overruns + 1 if overran else 0

    def _look(self, m: Measurement, suspects: int) -> Situation:
        return Situation(
            self._health(m.front_speed_state, m.front_speed_age_s / PERIOD_S),
            self._health(m.rear_speed_state, m.rear_speed_age_s / PERIOD_S),
            self._motor_health(m),
            self._health(m.driver_state, m.driver_age_s / DRIVER_CYCLE_S),
            suspects,
            suspects if all(m.wheel_speed_valid) else suspects | _failing(m),
            m.bus,
            self._overruns >= self._settings.overruns_to_degrade,
        )

    def _motor_health(self, m: Measurement) -> Health:
        """The one input that a car may do without."""
        if m.motor_state is NOT_ON_BUS:
            return ABSENT
        return self._health(m.motor_state, m.motor_age_s / PERIOD_S)

    def _health(self, state: InputState, cycles: float) -> Health:
        # The newest frame may be almost a cycle old without any being lost.
        if state is VALID and cycles < self._settings.bridged_cycles + 1:
            return GOOD
        if state in NOT_YET or cycles == math.inf:
            return AWAITED
        if cycles >= self._settings.tolerated_cycles + 1:
            return LOST
        return LATE if state is VALID else CORRUPT

    def _settle(self, reason: Rule | None) -> Verdict:
        if reason is not None:
            self._calm_ticks = 0
            if reason.permission is not SLOWLY:
                self._trusted_ticks = 0
        state, permission = self._next(reason)
        self._verdict = Verdict(state, self._code(state, reason), permission)
        return self._verdict

    def _next(self, reason: Rule | None) -> tuple[TcsState, Permission]:
        enough = self._settings.good_ticks_to_recover
        awaiting = self._before is INIT and reason is not None and reason.code is AWAITING
        if reason is not None and reason.state is FAULT and not awaiting:
            return FAULT, RELEASE
        if self._before is INIT or self._before is FAULT:
            # STANDBY is shown for a tick before anybody is followed.
            recovered = self._trusted_ticks >= enough
            return (STANDBY if recovered else self._before), RELEASE
        if reason is not None:
            return DEGRADED, reason.permission
        if self._before is DEGRADED and self._calm_ticks < enough:
            return DEGRADED, SLOWLY
        return STANDBY, FOLLOW

    def _code(self, state: TcsState, reason: Rule | None) -> FaultCode:
        """The reason of a state as long as it lasts, even while the way back is under way."""
        if state is STANDBY:
            return NO_FAULT
        news = reason is not None and (reason.state is state or state is INIT)
        return reason.code if reason is not None and news else self._verdict.fault_code


def _failing(m: Measurement) -> int:
    """Bits of the wheels whose sensors say that they fail."""
    return sum(bit for bit, ok in zip(WHEEL_BITS, m.wheel_speed_valid, strict=True) if not ok)
