"""One plant: a car on a road with a driver, stepped from one instant to the next."""

from __future__ import annotations

from typing import Protocol

from plant_emulator.driver import Pedal
from plant_emulator.inverter import Demand, LimitKeeper
from plant_emulator.quarter_car import QuarterCarPlant
from plant_emulator.road import road_table
from plant_emulator.scenario import Scenario
from plant_emulator.truth import Truth
from tcs_hil.canbus.vehicle_node import VehicleSignals
from tcs_hil.signals import TorqueLimits


class Car(Protocol):
    """What a variant of the car must do."""

    def advance(self, demand: Demand, duration_s: float) -> None:
        """Integrate over ``duration_s``, in which ``demand`` changes as straight lines."""
        ...

    def truth(self, time_s: float, demand: Demand) -> Truth:
        """Every state now."""
        ...


class Plant:
    """The vehicle, its driver and its road; time starts at zero and passes only in `step`."""

    def __init__(self, scenario: Scenario) -> None:
        self._scenario = scenario
        self._car: Car = QuarterCarPlant(
            scenario.vehicle.quarter_car, road_table(scenario.road), scenario.start_speed_mps
        )
        self._pedal = Pedal(scenario.driver)
        self._keeper = LimitKeeper()
        self.time_s = 0.0

    def step(self, limits: TorqueLimits | None, dt_s: float) -> None:
        """Let ``dt_s`` pass; ``limits`` are those that arrived at its beginning, if any did."""
        if limits is not None:
            self._keeper.accept(limits, self.time_s)
        end_s = self.time_s + dt_s
        while self.time_s < end_s:
            piece_end_s = min(end_s, self._next_change())
            self._car.advance(self._demand(), piece_end_s - self.time_s)
            self.time_s = piece_end_s

    def signals(self) -> VehicleSignals:
        """What the sensors say now."""
        truth = self.truth
        return VehicleSignals(
            wheel_speed_radps=truth.wheel_speed_radps,
            wheel_speed_valid=(True, True, True, True),
            motor_speed_radps=truth.motor_speed_radps,
            motor_torque_nm=truth.motor_torque_nm,
            driver_torque_nm=(truth.request_nm, truth.request_nm),
            accel_x_mps2=truth.accel_mps2,
        )

    @property
    def truth(self) -> Truth:
        """What really is, now."""
        return self._car.truth(self.time_s, self._demand())

    @property
    def finished(self) -> bool:
        """Whether the scenario has come to its end, in time or in distance."""
        # Half a step of tolerance: sums of 2 ms do not hit a round duration exactly.
        if self.time_s >= self._scenario.duration_s - 5e-5:
            return True
        end_m = self._scenario.end_distance_m
        return end_m is not None and self.truth.distance_m >= end_m

    def _demand(self) -> Demand:
        return self._keeper.demand(self._pedal.at(self.time_s), self.time_s)

    def _next_change(self) -> float:
        return min(self._pedal.next_change(self.time_s), self._keeper.next_change(self.time_s))
