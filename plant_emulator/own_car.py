"""Anybody's own car as the plant: a class in a Python file, or an FMI co-simulation unit."""

from __future__ import annotations

import runpy
from pathlib import Path

from plant_emulator.car import Car
from plant_emulator.scenario import Scenario
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

        return FmuCar(Path(source), scenario)
    return _python_car(source, scenario)


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
