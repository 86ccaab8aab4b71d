"""Faults on signals: between the sensors and the frames, and on torque limits received."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from plant_emulator.encoder import MISSING, Encoder
from plant_emulator.faults import LIMITS, SIGNALS, VALUE_KINDS, WHEELS, Fault
from plant_emulator.value_faults import Alteration, alteration
from tcs_hil.canbus.vehicle_node import VehicleSignals
from tcs_hil.signals import NO_LIMIT, TorqueLimits


@dataclass(frozen=True)
class _Altered:
    signal: str
    alter: Alteration


class SignalFaults:
    """Alters what the sensors said; what is off reads zero and, where it can, invalid."""

    def __init__(self, faults: tuple[Fault, ...], rng: np.random.Generator) -> None:
        self._altered = [
            _Altered(fault.target, alteration(fault, rng))
            for fault in faults
            if fault.target in SIGNALS and fault.kind in VALUE_KINDS
        ]

        self._teeth = [fault for fault in faults if fault.kind == "tooth-missing"]

    def break_teeth(self, encoder: Encoder | None, time_s: float) -> None:
        """Let the toothed rings lack the teeth they lack from ``time_s`` on."""
        if encoder is None:
            return
        for fault in self._teeth:
            tooth = fault.tooth if fault.active(time_s) else -1
            encoder.numbers[WHEELS.index(fault.target), MISSING] = tooth

    def apply(self, signals: VehicleSignals, time_s: float) -> VehicleSignals:
        """What is left of ``signals``; several faults on one signal act in the order listed."""
        if not self._altered:
            return signals
        values = dict(zip(SIGNALS, _flat(signals), strict=True))
        for altered in self._altered:
            value = values[altered.signal]
            if value is not None:
                values[altered.signal] = altered.alter(value, time_s)
        return _signals(list(values.values()), signals.wheel_speed_valid)


class LimitFaults:
    """Alters the torque limits that arrive; nothing left of one, or no number, is no limit."""

    def __init__(self, faults: tuple[Fault, ...], rng: np.random.Generator) -> None:
        self._altered = [
            (LIMITS.index(fault.target), alteration(fault, rng))
            for fault in faults
            if fault.target in LIMITS
        ]

    def apply(self, limits: TorqueLimits, time_s: float) -> TorqueLimits:
        """What is left of ``limits``; several faults on one act in the order listed."""
        values: list[float | None] = list(limits)
        for side, alter in self._altered:
            value = values[side]
            if value is not None:
                values[side] = alter(value, time_s)
        left, right = (NO_LIMIT if v is None or math.isnan(v) else v for v in values)
        return TorqueLimits(left, right)


def _flat(signals: VehicleSignals) -> tuple[float | None, ...]:
    """Values in the order of `SIGNALS`."""
    return (
        *signals.wheel_speed_radps,
        *signals.motor_speed_radps,
        *signals.motor_torque_nm,
        *signals.driver_torque_nm,
        signals.accel_x_mps2,
    )


def _signals(
    values: list[float | None], was_valid: tuple[bool, bool, bool, bool]
) -> VehicleSignals:
    fl, fr, rl, rr, speed_l, speed_r, torque_l, torque_r, request_l, request_r, accel = values
    valid = [value is not None and ok for value, ok in zip(values[:4], was_valid, strict=True)]
    return VehicleSignals(
        wheel_speed_radps=(fl or 0.0, fr or 0.0, rl or 0.0, rr or 0.0),
        wheel_speed_valid=(valid[0], valid[1], valid[2], valid[3]),
        motor_speed_radps=(speed_l or 0.0, speed_r or 0.0),
        motor_torque_nm=(torque_l or 0.0, torque_r or 0.0),
        driver_torque_nm=(request_l or 0.0, request_r or 0.0),
        accel_x_mps2=accel,
    )
