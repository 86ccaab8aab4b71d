"""Faults between what a motor is asked for and what its inverter heads for."""

from __future__ import annotations

import math

import numpy as np

from plant_emulator.faults import MOTORS, VALUE_KINDS, Fault, next_boundary
from plant_emulator.inverter import Demand, demanded
from plant_emulator.value_faults import Alteration, alteration
from tcs_hil.signals import NO_LIMIT

SAMPLE_S = 0.002


class MotorFaults:
    """Alters demands; also blacks out both motors while the car's electronics are down.

    A motor with a fault on its value reads what it is asked for every 2 ms and when
    such a fault comes or goes, and holds it in between: how time is cut elsewhere
    must not change what it does.
    """

    def __init__(self, faults: tuple[Fault, ...], rng: np.random.Generator) -> None:
        self._faults = [f for f in faults if f.target in MOTORS or f.kind == "brown-out"]
        self._brown_outs = [fault for fault in faults if fault.kind == "brown-out"]
        self._runaways = [fault for fault in faults if fault.kind == "ignores-limit"]
        self._altered: list[tuple[Fault, int, Alteration]] = [
            (fault, MOTORS.index(fault.target), alteration(fault, rng))
            for fault in faults
            if fault.target in MOTORS and fault.kind in VALUE_KINDS
        ]
        self._sampled: tuple[int, tuple[bool, ...]] | None = None
        self._aims = [0.0, 0.0]

    def dark(self, time_s: float) -> bool:
        """Whether the electronics are down: no torque, no frames."""
        return any(fault.active(time_s) for fault in self._brown_outs)

    def next_change(self, time_s: float) -> float:
        """When a fault next begins or ends, or a faulty motor reads what it is asked for."""
        if not self._faults:
            return math.inf
        boundary_s = next_boundary(self._faults, time_s)
        if not self._altered:
            return boundary_s
        return min(boundary_s, (_sample_at(time_s) + 1) * SAMPLE_S)

    def apply(self, demand: Demand, time_s: float) -> Demand:
        """What the inverters make of ``demand`` from ``time_s`` on."""
        if not self._faults:
            return demand
        if self.dark(time_s):
            return _constant(0.0, 0.0)
        limits = list(demand.limit_nm)
        for fault in self._runaways:
            if fault.active(time_s):
                limits[MOTORS.index(fault.target)] = NO_LIMIT
        demand = demand._replace(limit_nm=(limits[0], limits[1]))
        return self._alter(demand, time_s) if self._altered else demand

    def _alter(self, demand: Demand, time_s: float) -> Demand:
        active = tuple(fault.active(time_s) for fault, _, _ in self._altered)
        if self._sampled != (_sample_at(time_s), active):
            self._sampled = (_sample_at(time_s), active)
            self._aims = list(demanded(demand, 0.0))
            for _, side, alter in self._altered:
                self._aims[side] = alter(self._aims[side], time_s) or 0.0
        for (_, side, _), there in zip(self._altered, active, strict=True):
            if there:
                demand = _held(demand, side, self._aims[side])
        return demand


def _sample_at(time_s: float) -> int:
    """Number of the newest sample at ``time_s``; a rounded instant just before one is on it."""
    return math.floor(time_s / SAMPLE_S + 1e-6)


def _held(demand: Demand, side: int, aim_nm: float) -> Demand:
    """``demand`` with a constant in the place of one side's lines."""
    flat = _constant(aim_nm, aim_nm)
    left, right = (flat, demand) if side == 0 else (demand, flat)
    return Demand(*((one[0], other[1]) for one, other in zip(left, right, strict=True)))


def _constant(left_nm: float, right_nm: float) -> Demand:
    still = (0.0, 0.0)
    return Demand((left_nm, right_nm), still, (math.inf, math.inf), still)
