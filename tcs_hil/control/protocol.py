"""What every control law looks like to the pipeline: one instance per driven wheel."""

from __future__ import annotations

import math
from enum import IntEnum
from typing import Protocol

import msgspec


class WheelState(msgspec.Struct, frozen=True):
    """One driven wheel as the estimator sees it at this tick.

    ``slip_speed_mps`` is s = omega R - v, ``slip_ratio`` the modified kappa of
    Eq. (slip_mod).  Motor quantities are on the motor side of the gear.

    ``vehicle_accel_mps2`` is the body's, over ground; ``sent_nm`` what the gate let
    the motor have in the last tick.

    NaN is what nobody knows: ``motor_torque_nm`` without a motor on the bus;
    ``shaft_twist_rad``, ``tyre_force_n`` (driving positive) and
    ``vehicle_accel_mps2`` without an observer; ``sent_nm`` in the first tick.
    ``loop_delay_s`` is from the instant all this describes to the first effect
    of the command that answers it.
    """

    slip_speed_mps: float
    wheel_speed_radps: float
    slip_ratio: float
    vehicle_speed_mps: float
    motor_speed_radps: float
    motor_torque_nm: float
    shaft_twist_rad: float = math.nan
    tyre_force_n: float = math.nan
    vehicle_accel_mps2: float = math.nan
    loop_delay_s: float = 0.0
    sent_nm: float = math.nan

    @classmethod
    def at_rest(cls) -> WheelState:
        """A standing wheel, before anything is known."""
        return cls(0.0, 0.0, 0.0, 0.0, 0.0, 0.0)


class SolveStatus(IntEnum):
    """How a proposal came about; recorded with every tick."""

    OK = 0
    MAX_ITERATIONS = 1
    FAILED = 2
    BAD_INPUT = 3


class Source(IntEnum):
    """Who made a proposal: the law, or what stands in for one that cannot decide."""

    LAW = 0
    LAST_PLAN = 1
    FALLBACK = 2


class Proposal(msgspec.Struct, frozen=True):
    """A controller's wish for the coming period, within [0, torque_ref_nm].

    After ``FAILED`` or ``BAD_INPUT`` the torque is the driver's request: a law
    that cannot decide does not modify it.  ``next_nm`` is what a law that plans
    means to propose in the period after, NaN from others.  ``source`` is not
    ``LAW`` where the torque is a stand-in's; the status is then still the law's.
    A PI that is part of a law (`guarded.py`) is that law.
    """

    torque_nm: float
    status: SolveStatus = SolveStatus.OK
    iterations: int = 0
    next_nm: float = math.nan
    source: Source = Source.LAW


class Controller(Protocol):
    """One wheel's slip controller.  A failed solve is a status, never an exception."""

    def step(self, wheel: WheelState, torque_ref_nm: float) -> Proposal:
        """Propose the motor torque for the coming period."""
        ...

    def reset(self) -> None:
        """Forget integrators and warm starts, as at start-up."""
        ...
