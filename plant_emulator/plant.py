"""One plant: a car on a road with a driver, stepped from one instant to the next."""

from __future__ import annotations

from typing import Protocol

import numpy as np

from plant_emulator.driver import Pedal
from plant_emulator.inverter import Demand, LimitKeeper
from plant_emulator.quarter_car import QuarterCarPlant
from plant_emulator.road import road_table
from plant_emulator.scenario import Scenario
from plant_emulator.sensors import IDEAL, SensorSet
from plant_emulator.truth import DISTANCE, LIMIT, REQUEST, ROW_SIZE, TIME, Row, Truth, truth_of
from plant_emulator.whole_car_plant import WholeCarPlant
from tcs_hil.canbus.vehicle_node import VehicleSignals
from tcs_hil.signals import TorqueLimits


class Car(Protocol):
    """What a variant of the car must do."""

    def advance(self, demand: Demand, time_s: float, duration_s: float, /) -> None:
        """Integrate from ``time_s`` over ``duration_s``, in which demands are straight lines."""
        ...

    def observe(self, demand: Demand, row: Row, /) -> None:
        """Fill the car's part into a row of the truth."""
        ...


class Plant:
    """The vehicle, its driver and its road; time starts at zero and passes only in `step`."""

    def __init__(self, scenario: Scenario) -> None:
        self._scenario = scenario
        self._car, self._sensors = _build(scenario)
        self._pedal = Pedal(scenario.driver)
        self._keeper = LimitKeeper()
        self.time_s = 0.0
        self._row: Row | None = None

    def step(self, limits: TorqueLimits | None, dt_s: float) -> None:
        """Let ``dt_s`` pass; ``limits`` are those that arrived at its beginning, if any did."""
        if limits is not None:
            self._keeper.accept(limits, self.time_s)
        self._row = None
        end_s = self.time_s + dt_s
        while self.time_s < end_s:
            piece_end_s = min(end_s, self._next_change())
            self._car.advance(self._demand(), self.time_s, piece_end_s - self.time_s)
            self.time_s = piece_end_s

    def signals(self) -> VehicleSignals:
        """Sample the sensors: once per instant, since a sample counts edges and draws noise."""
        return self._sensors.sample(self.row)

    @property
    def row(self) -> Row:
        """What really is, now, as a flat row of `TRUTH_DTYPE`; the next step makes a new one."""
        if self._row is None:
            self._row = self._observe()
        return self._row

    @property
    def truth(self) -> Truth:
        """What really is, now."""
        return truth_of(self.row)

    @property
    def finished(self) -> bool:
        """Whether the scenario has come to its end, in time or in distance."""
        # Half a step of tolerance: sums of 2 ms do not hit a round duration exactly.
        if self.time_s >= self._scenario.duration_s - 5e-5:
            return True
        end_m = self._scenario.end_distance_m
        return end_m is not None and bool(self.row[DISTANCE] >= end_m)

    def _observe(self) -> Row:
        demand, row = self._demand(), np.zeros(ROW_SIZE)
        self._car.observe(demand, row)
        row[TIME], row[REQUEST] = self.time_s, self._pedal.at(self.time_s).value
        row[LIMIT : LIMIT + 2] = demand.limit_nm
        return row

    def _demand(self) -> Demand:
        return self._keeper.demand(self._pedal.at(self.time_s), self.time_s)

    def _next_change(self) -> float:
        return min(self._pedal.next_change(self.time_s), self._keeper.next_change(self.time_s))


def _build(scenario: Scenario) -> tuple[Car, SensorSet]:
    """Make the car of the scenario and the sensors in it."""
    road, speed_mps = road_table(scenario.road), scenario.start_speed_mps
    rng = np.random.default_rng(scenario.sensors.seed)
    if scenario.vehicle.variant == "quarter-car":
        quarter = QuarterCarPlant(scenario.vehicle.quarter_car, road, speed_mps)
        return quarter, SensorSet(IDEAL, rng)
    whole = WholeCarPlant(scenario.vehicle.whole, road, speed_mps, scenario.sensors)
    return whole, SensorSet(scenario.sensors, rng, whole.encoder, whole.wheels)
