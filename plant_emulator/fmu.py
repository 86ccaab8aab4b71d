"""One FMI 2 or 3 co-simulation unit, by the names of its variables; fmpy speaks to it."""

from __future__ import annotations

import shutil
import weakref
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any

from tcs_hil.errors import ConfigError

try:
    import fmpy
except ImportError as error:
    raise ConfigError("an FMU needs fmpy: pip install 'tcs-hil[bench]'") from error

REAL_TYPES = ("Real", "Float64")


class Unit:
    """An instance of the unit, to be initialised at time zero before its first step.

    Raises:
        ConfigError: the file is no unit for co-simulation on this machine.
    """

    def __init__(self, path: Path) -> None:
        self._path = path
        try:
            description = fmpy.read_model_description(str(path), validate=False)
            folder = fmpy.extract(str(path))
        # fmpy lets everything through that zip, XML and the file system may raise.
        except Exception as error:
            raise ConfigError(f"{path}: cannot be read as an FMU ({error})") from error
        weakref.finalize(self, shutil.rmtree, folder, ignore_errors=True)
        real = [v for v in description.modelVariables if v.type in REAL_TYPES]
        self._references = {variable.name: variable.valueReference for variable in real}
        self.inputs = {variable.name for variable in real if variable.causality == "input"}
        self.parameters = {v.name for v in real if v.causality == "parameter"}
        self.outputs = self._references.keys() - self.inputs - self.parameters
        self._is_fmi3 = description.fmiVersion.startswith("3")
        self._unit = self._instance(folder, description)

    def initialise(self, start: Mapping[str, float]) -> None:
        """Set parameters and bring the unit to time zero.

        Raises:
            ConfigError: the unit has no such parameter, or refuses a value.
        """
        references = self.references(start)
        try:
            if not self._is_fmi3:
                self._unit.setupExperiment(startTime=0.0)
            self.write(references, list(start.values()))
            self._unit.enterInitializationMode()
            self._unit.exitInitializationMode()
        except Exception as error:
            raise ConfigError(f"{self._path}: cannot be initialised ({error})") from error

    def references(self, names: Iterable[str]) -> list[int]:
        """References to real variables.

        Raises:
            ConfigError: the unit has no such variable.
        """
        names = list(names)
        missing = [name for name in names if name not in self._references]
        if missing:
            raise ConfigError(f"{self._path}: has no real variable {', '.join(missing)}")
        return [self._references[name] for name in names]

    def write(self, references: Sequence[int], values: Sequence[float]) -> None:
        """Set variables."""
        setter = self._unit.setFloat64 if self._is_fmi3 else self._unit.setReal
        setter(references, values)

    def read(self, references: Sequence[int]) -> list[float]:
        """Get variables."""
        getter = self._unit.getFloat64 if self._is_fmi3 else self._unit.getReal
        values: list[float] = getter(references)
        return values

    def step(self, time_s: float, duration_s: float) -> None:
        """Let ``duration_s`` pass in the unit.

        Raises:
            ConfigError: the unit gave up.
        """
        try:
            self._unit.doStep(currentCommunicationPoint=time_s, communicationStepSize=duration_s)
        except Exception as error:
            raise ConfigError(f"{self._path}: gave up at {time_s:.3f} s ({error})") from error

    def _instance(self, folder: str, description: Any) -> Any:
        if description.coSimulation is None:
            raise ConfigError(f"{self._path}: is not for co-simulation")
        try:
            return fmpy.instantiate_fmu(folder, description, "CoSimulation")
        except Exception as error:
            raise ConfigError(f"{self._path}: cannot be started ({error})") from error
