"""Every fault that acts inside the plant: the scenario's, and on top of them the bench's."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from plant_emulator.encoder import Encoder
from plant_emulator.faults import Fault
from plant_emulator.inverter import Demand
from plant_emulator.motor_faults import MotorFaults
from plant_emulator.signal_faults import LimitFaults, SignalFaults
from tcs_hil.canbus.vehicle_node import VehicleSignals
from tcs_hil.signals import TorqueLimits


class _Layer(NamedTuple):
    signals: SignalFaults
    limits: LimitFaults
    motors: MotorFaults


class PlantFaults:
    """Faults between sensors and frames, on limits received, and inside the motors.

    What is injected is a layer of its own, so that the scenario's faults keep
    what they remember.
    """

    def __init__(self, faults: tuple[Fault, ...], rng: np.random.Generator) -> None:
        self._rng = rng
        self._scenario = [self._layer(faults)] if faults else []
        self._layers = self._scenario

    def inject(self, faults: tuple[Fault, ...]) -> None:
        """Let ``faults`` act on what the scenario's leave, instead of those injected before."""
        self._layers = self._scenario + ([self._layer(faults)] if faults else [])

    def break_teeth(self, encoder: Encoder | None, time_s: float) -> None:
        """Let the toothed rings lack the teeth they lack from ``time_s`` on."""
        for layer in self._layers:
            layer.signals.break_teeth(encoder, time_s)

    def signals(self, signals: VehicleSignals, time_s: float) -> VehicleSignals:
        """What is left of what the sensors said."""
        for layer in self._layers:
            signals = layer.signals.apply(signals, time_s)
        return signals

    def limits(self, limits: TorqueLimits, time_s: float) -> TorqueLimits:
        """What is left of torque limits that arrive."""
        for layer in self._layers:
            limits = layer.limits.apply(limits, time_s)
        return limits

    def demand(self, demand: Demand, time_s: float) -> Demand:
        """What the inverters make of ``demand`` from ``time_s`` on."""
        for layer in self._layers:
            demand = layer.motors.apply(demand, time_s)
        return demand

    def dark(self, time_s: float) -> bool:
        """Whether the car's electronics are down."""
        return any(layer.motors.dark(time_s) for layer in self._layers)

    def next_change(self, time_s: float) -> float:
        """When a motor's fault next begins, ends or reads what it is asked for."""
        change_s = math.inf
        for layer in self._layers:
            change_s = min(change_s, layer.motors.next_change(time_s))
        return change_s

    def _layer(self, faults: tuple[Fault, ...]) -> _Layer:
        return _Layer(
            SignalFaults(faults, self._rng),
            LimitFaults(faults, self._rng),
            MotorFaults(faults, self._rng),
        )
