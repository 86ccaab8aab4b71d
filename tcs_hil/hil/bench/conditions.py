"""What the figures were made on and with."""

from __future__ import annotations

from tcs_hil.hil.machine import describe_machine
from tcs_hil.runtime.doctor.machine import ThisMachine

GOVERNOR = "/sys/devices/system/cpu/cpu0/cpufreq/scaling_governor"
LIBRARIES = ("numpy", "casadi", "osqp", "daqp", "do-mpc", "python-can")


def conditions() -> str:
    """Processor, kernel, governor, versions, and what was compiled."""
    machine = ThisMachine()
    versions = [f"{name} {machine.version(name) or 'not installed'}" for name in LIBRARIES]
    step = "with" if machine.has_native_step() else "without"
    tick = "compiled" if machine.has_compiled_tick() else "interpreted"
    governor = machine.read(GOVERNOR) or "unknown"
    built = f"{step} native step, tick {tick}"
    return f"{describe_machine()}, governor {governor}; {', '.join(versions)}; {built}"
