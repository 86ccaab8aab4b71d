"""Decides the state of the service and what the gate may do in it.

    INIT -> STANDBY <-> ACTIVE <-> DEGRADED -> FAULT -> STANDBY

Every input is judged by the cycles it has missed: up to ``bridged_cycles`` the
last value serves, beyond that nothing may be raised (DEGRADED), beyond
``tolerated_cycles`` the torque is handed back to the driver (FAULT).
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from enum import IntEnum
from typing import Annotated

import msgspec

from tcs_hil.gate import Permission
from tcs_hil.signals import Measurement, TcsState

PERIOD_S = 0.002
DRIVER_CYCLE_S = 0.010


class FaultCode(IntEnum):
    """Why the service is neither in STANDBY nor ACTIVE; the value travels in ``TcsFaultCode``."""

    NONE = 0
    FRONT_SPEED_LATE = 1
    REAR_SPEED_LATE = 2
    DRIVER_REQUEST_LATE = 3
    ONE_REAR_SPEED_INVALID = 4
    REAR_SPEEDS_INVALID = 5
    FRONT_SPEED_INVALID = 6
    CONTROLLER_FAILED = 7
    INTERNAL_ERROR = 8


@dataclass(frozen=True, slots=True)
class Verdict:
    """State, reason and permission for one tick."""

    state: TcsState
    fault_code: FaultCode
    permission: Permission


class SupervisorSettings(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Patience of the supervisor, in cycles of the input concerned."""

    bridged_cycles: Annotated[int, msgspec.Meta(ge=0)] = 2
    tolerated_cycles: Annotated[int, msgspec.Meta(ge=1)] = 10
    good_ticks_to_recover: Annotated[int, msgspec.Meta(ge=1)] = 10


class Supervisor:
    """State machine of the service; one call a tick."""

    def __init__(self, settings: SupervisorSettings) -> None:
        self._settings = settings
        self._verdict = Verdict(TcsState.INIT, FaultCode.NONE, Permission.RELEASE)
        self._good_ticks = 0

    def judge(self, measurement: Measurement) -> Verdict:
        """Judge the inputs before control: may the controllers be heard at all?"""
        degraded, fault = self._input_faults(measurement)
        self._good_ticks = 0 if fault or degraded else self._good_ticks + 1
        state = self._verdict.state
        recovering = state in (TcsState.INIT, TcsState.FAULT)
        if recovering and self._good_ticks < self._settings.good_ticks_to_recover:
            reason = fault or degraded or self._verdict.fault_code
            return self._settle(state, reason, Permission.RELEASE)
        if fault:
            return self._settle(TcsState.FAULT, fault, Permission.RELEASE)
        if degraded:
            return self._settle(TcsState.DEGRADED, degraded, Permission.HOLD)
        return self._settle(TcsState.STANDBY, FaultCode.NONE, Permission.FOLLOW)

    def controller_failed(self) -> Verdict:
        """A law could not decide: nothing may be raised this tick."""
        return self._settle(TcsState.DEGRADED, FaultCode.CONTROLLER_FAILED, Permission.HOLD)

    def internal_error(self) -> Verdict:
        """Our own code broke: hand the torque back and begin again."""
        self._good_ticks = 0
        return self._settle(TcsState.FAULT, FaultCode.INTERNAL_ERROR, Permission.RELEASE)

    def limiting(self) -> Verdict:
        """The gate holds a motor below the request: STANDBY has become ACTIVE."""
        if self._verdict.state is TcsState.STANDBY:
            self._verdict = replace(self._verdict, state=TcsState.ACTIVE)
        return self._verdict

    def _settle(self, state: TcsState, code: FaultCode, permission: Permission) -> Verdict:
        self._verdict = Verdict(state, code, permission)
        return self._verdict

    def _input_faults(self, m: Measurement) -> tuple[FaultCode, FaultCode]:
        """First reason to degrade and first reason to fail; NONE where there is none."""
        late = (
            (m.rear_speed_age_s / PERIOD_S, FaultCode.REAR_SPEED_LATE),
            (m.front_speed_age_s / PERIOD_S, FaultCode.FRONT_SPEED_LATE),
            (m.driver_age_s / DRIVER_CYCLE_S, FaultCode.DRIVER_REQUEST_LATE),
        )
        degraded = self._first_later_than(self._settings.bridged_cycles, late)
        fault = self._first_later_than(self._settings.tolerated_cycles, late)
        *front, rl, rr = m.wheel_speed_valid
        if not (rl or rr):
            fault = fault or FaultCode.REAR_SPEEDS_INVALID
        elif not (rl and rr):
            degraded = degraded or FaultCode.ONE_REAR_SPEED_INVALID
        if not all(front):
            degraded = degraded or FaultCode.FRONT_SPEED_INVALID
        return degraded, fault

    @staticmethod
    def _first_later_than(cycles: int, late: tuple[tuple[float, FaultCode], ...]) -> FaultCode:
        # The newest frame may be almost a cycle old without any being lost.
        return next((code for missed, code in late if missed >= cycles + 1), FaultCode.NONE)
