"""A published law whose whole step is one call into C."""

from __future__ import annotations

import math
from array import array

from tcs_hil.control.plan import Plan
from tcs_hil.control.protocol import Proposal, SolveStatus, WheelState
from tcs_hil.control.settings import ControlSettings
from tcs_hil.native import FloatArray, core

_STATUS = tuple(SolveStatus)


def plan_of(inputs: FloatArray, outcome: int) -> Plan:
    """Inputs (N,) and what came of them, as C packs it into one integer."""
    return Plan(inputs, _STATUS[outcome & 3], outcome >> 2)


class NativeLaw:
    """The C struct of a law, its functions, and the memory its answer is written to.

    Everything is prepared here once: a step passes five floats and reads back
    two, and what came of it, packed into one integer.
    """

    def __init__(self, kind: str, settings: ControlSettings) -> None:
        ffi, lib = core().ffi, core().lib
        self._torques_nm = array("d", (0.0, 0.0))  # for the coming period and the one after
        self.struct = ffi.new(f"{kind} *")
        self.struct.answer = ffi.cast("proposal *", ffi.from_buffer(self._torques_nm))
        self.struct.integral.slip_reference = settings.slip_reference
        self.struct.integral.period_s = settings.period_s
        self._step = getattr(lib, f"{kind}_step")
        self._reset = getattr(lib, f"{kind}_reset")

    def step(self, wheel: WheelState, torque_ref_nm: float) -> Proposal:
        """Propose the motor torque for the coming period."""
        outcome = self._step(
            self.struct,
            wheel.slip_speed_mps,
            wheel.wheel_speed_radps,
            wheel.slip_ratio,
            wheel.vehicle_speed_mps,
            torque_ref_nm,
        )
        torque_nm, next_nm = self._torques_nm
        status, iterations = _STATUS[outcome & 3], outcome >> 2
        if math.isnan(next_nm):
            # The default is the very object by which equal proposals compare as equal.
            return Proposal(torque_nm, status, iterations)
        return Proposal(torque_nm, status, iterations, next_nm)

    def reset(self) -> None:
        """Forget the integral and the last plan, as at start-up."""
        self._reset(self.struct)
