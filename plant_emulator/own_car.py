"""Anybody's own car as the plant: a class in a Python file, or an FMI co-simulation unit."""

from __future__ import annotations

import runpy
from math import isfinite
from pathlib import Path

import numpy as np

from plant_emulator.car import Car
from plant_emulator.inverter import Demand
from plant_emulator.scenario import Scenario
from plant_emulator.truth import TRUTH_COLUMNS, Row
from tcs_hil.errors import ConfigError


def own_car(scenario: Scenario) -> Car:
    """Make the car that ``source`` of ``[vehicle]`` names: ``file.fmu`` or ``file.py:Class``.

    The class is called with the scenario.

    Raises:
        ConfigError: there is no such file or class, or the unit cannot be used.
    """
    source = str(scenario.vehicle.source)
    if source.endswith(".fmu"):
        from plant_emulator.fmu_car import FmuCar  # noqa: PLC0415 - fmpy is an extra

        return _OwnCar(source, FmuCar(Path(source), scenario))
    return _OwnCar(source, _python_car(source, scenario))


def _python_car(source: str, scenario: Scenario) -> Car:
    file, _, name = source.rpartition(":")
    try:
        names = runpy.run_path(file)
    except Exception as error:
        raise ConfigError(f"{file}: cannot be run ({error!r})") from error
    if name not in names:
        raise ConfigError(f"{file}: has no {name}")
    try:
        car: Car = names[name](scenario)
    except Exception as error:
        raise ConfigError(f"{source}: cannot be made of a scenario ({error!r})") from error
    return car


class _OwnCar:
    """Somebody's car, whose mistakes are told as its own."""

    def __init__(self, source: str, car: Car) -> None:
        self._source, self._car = source, car

    def advance(self, demand: Demand, time_s: float, duration_s: float) -> None:
        """Let time pass in it.

        Raises:
            ConfigError: it cannot.
        """
        try:
            self._car.advance(demand, time_s, duration_s)
        except ConfigError:
            raise
        except Exception as error:
            raise self._told("advance", error) from error

    def observe(self, demand: Demand, row: Row) -> None:
        """Let it fill in a row of the truth.

        Raises:
            ConfigError: it cannot.
        """
        try:
            self._car.observe(demand, row)
        except ConfigError:
            raise
        except Exception as error:
            raise self._told("observe", error) from error
        if not np.isfinite(row).all():
            first = next(name for name, at in TRUTH_COLUMNS.items() if not isfinite(row[at]))
            raise ConfigError(f"{self._source}: tells no number as {first}")

    def _told(self, method: str, error: Exception) -> ConfigError:
        return ConfigError(f"{self._source}: fails in `{method}` ({error!r})")
