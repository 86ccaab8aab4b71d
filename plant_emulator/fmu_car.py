"""A car from an FMI co-simulation unit: what it must have, what it may have, and stand-ins."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

import numpy as np

from plant_emulator import truth
from plant_emulator.fmu import Unit
from plant_emulator.inverter import Demand, demanded
from plant_emulator.road import road_table, site_at
from plant_emulator.scenario import Scenario
from plant_emulator.truth import ROW_SIZE, TRUTH_COLUMNS, Row
from plant_emulator.tyre import modified_slip
from tcs_hil.names import column_names
from tcs_hil.signals import Pair

TORQUES = column_names("torque_demand_nm", (2,))
"""Inputs every unit must have: what each motor is asked for, request and limit considered."""

ROAD = (*column_names("mu", (4,)), "grade_ratio")
"""Inputs a unit may have: the road under it."""

REQUIRED = ("speed_mps", *column_names("wheel_speed_radps", (4,)))
"""Outputs every unit must have; any other column of the truth is taken where it has it."""

START_SPEED = "start_speed_mps"
"""A parameter a unit may have; without it every run begins as the unit does."""


class FmuCar:
    """A unit on a road, stepped on a grid of its own: few units take steps of any length.

    What it does not tell is put in its place: distance and acceleration follow
    from its speed, motor speeds from wheels and gear, torque is what was asked.
    """

    def __init__(self, path: Path, scenario: Scenario) -> None:
        self._vehicle, self._road = scenario.vehicle, road_table(scenario.road)
        self._step_s, self._steps = scenario.vehicle.fmu.step_s, 0
        self._unit = unit = Unit(path)
        start = dict(scenario.vehicle.fmu.start)
        if self._theirs(START_SPEED) in unit.parameters:
            start[self._theirs(START_SPEED)] = scenario.start_speed_mps
        road = [name for name in ROAD if self._theirs(name) in unit.inputs]
        told = [c for c in TRUTH_COLUMNS if c in REQUIRED or self._theirs(c) in unit.outputs]
        self._inputs = self._references((*TORQUES, *road))
        self._outputs = self._references(told)
        self._road_columns = [TRUTH_COLUMNS[name] for name in road]
        self._told_columns = [TRUTH_COLUMNS[name] for name in told]
        self._told = frozenset(self._told_columns)
        unit.initialise(start)
        self._row = np.zeros(ROW_SIZE)
        self._look((0.0, 0.0))

    def advance(self, demand: Demand, time_s: float, duration_s: float) -> None:
        """Take every step of the unit's grid that ends within ``duration_s``.

        Raises:
            ConfigError: the unit gave up.
        """
        last = round((time_s + duration_s) / self._step_s, 6)
        while self._steps + 1 <= last:
            begin_s = self._steps * self._step_s
            torque_nm = demanded(demand, max(begin_s - time_s, 0.0))
            road = [float(self._row[column]) for column in self._road_columns]
            self._unit.write(self._inputs, [*torque_nm, *road])
            self._unit.step(begin_s, self._step_s)
            self._steps += 1
            self._look(torque_nm)

    def observe(self, _demand: Demand, row: Row) -> None:
        """Fill in what the unit told and what follows from it."""
        row[:] = self._row

    def _look(self, torque_nm: Pair) -> None:
        """Read the unit, and stand in for what it does not tell."""
        row, before_mps = self._row, float(self._row[truth.BODY_SPEED])
        row[self._told_columns] = self._unit.read(self._outputs)
        speed_mps = float(row[truth.BODY_SPEED])
        accel_mps2 = (speed_mps - before_mps) / self._step_s if self._steps else 0.0
        self._stand_in(truth.ACCEL, (accel_mps2,))
        self._stand_in(truth.SPECIFIC_FORCE, (row[truth.ACCEL],))
        travelled_m = 0.5 * (speed_mps + before_mps) * self._step_s if self._steps else 0.0
        self._stand_in(truth.DISTANCE, (row[truth.DISTANCE] + travelled_m,))
        gear = self._vehicle.driveline.gear_ratio
        wheels = row[truth.WHEEL_SPEED : truth.WHEEL_SPEED + 4]
        self._stand_in(truth.MOTOR_SPEED, wheels[:2] * gear)
        self._stand_in(truth.MOTOR_TORQUE, torque_nm)
        rims_mps = wheels * self._vehicle.body.wheel_radius_m
        self._stand_in(truth.SLIP_SPEED, rims_mps - speed_mps)
        self._stand_in(truth.SLIP_RATIO, [modified_slip(rim, speed_mps) for rim in rims_mps])
        self._drive_on()

    def _stand_in(self, first: int, values: Iterable[float]) -> None:
        for column, value in enumerate(values, first):
            if column not in self._told:
                self._row[column] = value

    def _drive_on(self) -> None:
        """See the road where the car now is."""
        place_m = float(self._row[truth.DISTANCE])
        site = site_at(self._road, place_m, self._vehicle.body.wheelbase_m, self._row)
        self._row[truth.GRADE] = site.grade_sin / site.grade_cos

    def _references(self, names: Iterable[str]) -> list[int]:
        return self._unit.references(self._theirs(name) for name in names)

    def _theirs(self, name: str) -> str:
        return self._vehicle.fmu.names.get(name, name)
