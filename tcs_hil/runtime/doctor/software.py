"""Python and what the service is made of."""

from __future__ import annotations

import platform

from tcs_hil.runtime.doctor.finding import Finding, fail, ok
from tcs_hil.runtime.doctor.machine import Machine

BUS = ("python-can", "cantools", "autosar-e2e")
SOLVERS = ("numpy", "osqp", "daqp", "casadi")


def bus_software(machine: Machine) -> Finding:
    """What reads and writes the bus."""
    return _versions(machine, "bus software", BUS)


def solvers(machine: Machine) -> Finding:
    """What the control laws are solved with."""
    return _versions(machine, f"Python {platform.python_version()}, solvers", SOLVERS)


def _versions(machine: Machine, what: str, names: tuple[str, ...]) -> Finding:
    versions = {name: machine.version(name) for name in names}
    missing = [name for name, version in versions.items() if version is None]
    if missing:
        return fail(what, f"{', '.join(missing)} missing", f"pip install {' '.join(missing)}")
    return ok(what, ", ".join(f"{name} {version}" for name, version in versions.items()))
