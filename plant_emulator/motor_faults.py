"""Faults between what a motor is asked for and what its inverter heads for."""

from __future__ import annotations

import math

import numpy as np

from plant_emulator.faults import MOTORS, VALUE_KINDS, Fault, next_boundary
from plant_emulator.inverter import Demand, demanded
from plant_emulator.value_faults import Alteration, alteration
from tcs_hil.signals import NO_LIMIT


class MotorFaults:
    """Alters demands; also blacks out both motors while the car's electronics are down."""

    def __init__(self, faults: tuple[Fault, ...], rng: np.random.Generator) -> None:
        self._faults = [f for f in faults if f.target in MOTORS or f.kind == "brown-out"]
        self._brown_outs = [fault for fault in faults if fault.kind == "brown-out"]
        self._runaways = [fault for fault in faults if fault.kind == "ignores-limit"]
        self._altered: list[tuple[int, Alteration]] = [
            (MOTORS.index(fault.target), alteration(fault, rng))
            for fault in faults
            if fault.target in MOTORS and fault.kind in VALUE_KINDS
        ]

    def dark(self, time_s: float) -> bool:
        """Whether the electronics are down: no torque, no frames."""
        return any(fault.active(time_s) for fault in self._brown_outs)

    def next_change(self, time_s: float) -> float:
        """When a fault next begins or ends."""
        return next_boundary(self._faults, time_s) if self._faults else math.inf

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
        aims = list(demanded(demand, 0.0))
        for side, alter in self._altered:
            aims[side] = alter(aims[side], time_s) or 0.0
        return _constant(aims[0], aims[1])


def _constant(left_nm: float, right_nm: float) -> Demand:
    still = (0.0, 0.0)
    return Demand((left_nm, right_nm), still, (math.inf, math.inf), still)
