"""One plant: a car on a road with a driver, stepped from one instant to the next."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from plant_emulator.car import Car
from plant_emulator.driver import Driver
from plant_emulator.encoder import Encoder
from plant_emulator.faults import Fault
from plant_emulator.inverter import Demand
from plant_emulator.limit_keeper import LimitKeeper
from plant_emulator.own_car import own_car
from plant_emulator.pedal import Pedal
from plant_emulator.plant_faults import PlantFaults
from plant_emulator.quarter_car import QuarterCarPlant
from plant_emulator.road import MU_LEFT, MU_RIGHT, road_table
from plant_emulator.scenario import Scenario
from plant_emulator.sensor_set import SensorSet
from plant_emulator.sensors import IDEAL
from plant_emulator.truth import DISTANCE, LIMIT, REQUEST, ROW_SIZE, TIME, Row, Truth, truth_of
from plant_emulator.whole_car_plant import WholeCarPlant
from tcs_hil.canbus.vehicle_node import VehicleSignals
from tcs_hil.signals import TorqueLimits

THROTTLE_MAX_NM = 500.0
MU_MIN, MU_MAX = 0.01, 1.5


class Plant:
    """The vehicle, its driver and its road; time starts at zero and passes only in `step`."""

    def __init__(self, scenario: Scenario) -> None:
        self._scenario = scenario
        self._road = road_table(scenario.road)
        self._car, self._sensors, self._encoder = _build(scenario, self._road)
        self._pedal = Pedal(scenario.driver)
        self._keeper = LimitKeeper()
        rng = np.random.default_rng([scenario.sensors.seed, 1])
        self._faults = PlantFaults(scenario.fault, rng)
        self.time_s = 0.0
        self._demand = self._demand_now()
        self._row: Row | None = None

    def step(self, limits: TorqueLimits | None, dt_s: float) -> None:
        """Let ``dt_s`` pass; ``limits`` are those that arrived at its beginning, if any did.

        No time at all just hands over the limits.

        Raises:
            ValueError: ``dt_s`` is negative or not finite.
        """
        if not 0.0 <= dt_s < math.inf:
            raise ValueError(f"dt_s must be finite and not negative, not {dt_s}")
        if limits is not None:
            self._keeper.accept(self._faults.limits(limits, self.time_s), self.time_s)
            self._demand = self._demand_now()
        self._row = None
        end_s = self.time_s + dt_s
        while self.time_s < end_s:
            piece_end_s = min(end_s, self._next_change())
            self._faults.break_teeth(self._encoder, self.time_s)
            self._car.advance(self._demand, self.time_s, piece_end_s - self.time_s)
            self.time_s = piece_end_s
            self._demand = self._demand_now()

    def override(self, throttle_nm: float | None, mu_ratio: float | None) -> None:
        """Ask ``throttle_nm`` of each motor and put ``mu_ratio`` under every wheel from now on.

        None leaves driver or road to the scenario.  Values out of the plant's
        bounds are taken as the nearest within.  A car of somebody's own has its
        road to itself.
        """
        driver = self._scenario.driver
        if throttle_nm is not None:
            driver = Driver(request=((0.0, min(throttle_nm, THROTTLE_MAX_NM)),))
        self._pedal = Pedal(driver)
        self._road[:] = road_table(self._scenario.road)
        if mu_ratio is not None:
            self._road[:, [MU_LEFT, MU_RIGHT]] = min(max(mu_ratio, MU_MIN), MU_MAX)
        self._demand, self._row = self._demand_now(), None

    def inject(self, faults: tuple[Fault, ...]) -> None:
        """Let ``faults`` act from now on, on top of the scenario's; none ends those before."""
        self._faults.inject(faults)
        self._demand, self._row = self._demand_now(), None

    def signals(self) -> VehicleSignals:
        """Sample the sensors, faults included.

        Once per instant: a sample counts edges, draws noise and ages faults.
        """
        return self._faults.signals(self._sensors.sample(self.row), self.time_s)

    @property
    def scenario(self) -> Scenario:
        """What this plant was made from."""
        return self._scenario

    @property
    def dark(self) -> bool:
        """Whether the car's electronics are down."""
        return self._faults.dark(self.time_s)

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
        row = np.zeros(ROW_SIZE)
        self._car.observe(self._demand, row)
        row[TIME], row[REQUEST] = self.time_s, self._pedal.at(self.time_s).value
        row[LIMIT : LIMIT + 2] = self._keeper.limits_nm(self.time_s)
        return row

    def _demand_now(self) -> Demand:
        demand = self._keeper.demand(self._pedal.at(self.time_s), self.time_s)
        return self._faults.demand(demand, self.time_s)

    def _next_change(self) -> float:
        asked_s = min(self._pedal.next_change(self.time_s), self._keeper.next_change(self.time_s))
        return min(asked_s, self._faults.next_change(self.time_s))


def _build(scenario: Scenario, road: NDArray[np.float64]) -> tuple[Car, SensorSet, Encoder | None]:
    """Make the car of the scenario, the sensors in it and, if it has any, its toothed rings."""
    speed_mps = scenario.start_speed_mps
    rng = np.random.default_rng(scenario.sensors.seed)
    if scenario.vehicle.variant == "quarter-car":
        quarter = QuarterCarPlant(scenario.vehicle.quarter_car, road, speed_mps)
        return quarter, SensorSet(IDEAL, rng), None
    if scenario.vehicle.variant == "own":
        return own_car(scenario), SensorSet(scenario.sensors, rng), None
    whole = WholeCarPlant(scenario.vehicle.whole, road, speed_mps, scenario.sensors)
    sensors = SensorSet(scenario.sensors, rng, whole.encoder, whole.wheels)
    return whole, sensors, whole.encoder
