"""A machine made to measure."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from fnmatch import fnmatchcase


@dataclass(frozen=True)
class FakeMachine:
    """Files, limits and programs as a test wants them; what is not given is not there."""

    files: Mapping[str, str] = field(default_factory=dict)
    programs: Mapping[str, str] = field(default_factory=dict)
    limits: float = math.inf
    versions: Mapping[str, str] = field(default_factory=dict)
    can: bool = True
    resolution_s: float = 1e-9
    native_step: bool = True
    compiled_tick: bool = True

    def read(self, path: str) -> str | None:
        return self.files.get(path)

    def glob(self, pattern: str) -> list[str]:
        return sorted(path for path in self.files if fnmatchcase(path, pattern))

    def run(self, *command: str) -> str | None:
        return self.programs.get(command[0])

    def limit(self, which: int) -> float:
        return self.limits

    def version(self, distribution: str) -> str | None:
        return self.versions.get(distribution)

    def has_native_step(self) -> bool:
        return self.native_step

    def has_compiled_tick(self) -> bool:
        return self.compiled_tick

    def speaks_can(self) -> bool:
        return self.can

    def timer_resolution_s(self) -> float:
        return self.resolution_s
