"""Python and what the service is made of."""

from __future__ import annotations

import platform

from tcs_hil.runtime.doctor.finding import Finding, fail, ok, warn
from tcs_hil.runtime.doctor.machine import Machine

BUS = ("python-can", "cantools", "autosar-e2e")
SOLVERS = ("numpy", "osqp", "daqp", "casadi")


def bus_software(machine: Machine) -> Finding:
    """What reads and writes the bus."""
    return _versions(machine, "bus software", BUS)


def solvers(machine: Machine) -> Finding:
    """What the control laws are solved with."""
    return _versions(machine, f"Python {platform.python_version()}, solvers", SOLVERS)


def native_step(machine: Machine) -> Finding:
    """Whether the laws' steps were compiled when this package was installed."""
    what = "native step"
    if machine.has_native_step():
        return ok(what, "built")
    return warn(
        what, "not built: the laws run in Python", "apt-get install gcc python3-dev, install anew"
    )


def compiled_tick(machine: Machine) -> Finding:
    """Whether everything else in a tick was compiled, too; an editable installation never is."""
    what = "tick"
    if machine.has_compiled_tick():
        return ok(what, "compiled")
    return warn(
        what, "interpreted: takes twice the time", "pip install . instead of pip install -e ."
    )


def _versions(machine: Machine, what: str, names: tuple[str, ...]) -> Finding:
    versions = {name: machine.version(name) for name in names}
    missing = [name for name, version in versions.items() if version is None]
    if missing:
        return fail(what, f"{', '.join(missing)} missing", f"pip install {' '.join(missing)}")
    return ok(what, ", ".join(f"{name} {version}" for name, version in versions.items()))
