"""How soon each faulty sensor is found, and by which name.

    python -m benchmarks.sensor_faults                        a table
    python -m benchmarks.sensor_faults --write docs/safety.md

Every fault comes at 1 s and goes at 1.5 s, in the loop that the shipped
controller closes in process with the emulator.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import NamedTuple

import click
import msgspec

from benchmarks.options import write_option
from benchmarks.section import markdown, tell
from plant_emulator.faults import Fault
from plant_emulator.scenario import Scenario, load_scenario
from tcs_hil.cli.progress import progress_bar
from tcs_hil.fault_codes import FaultCode
from tcs_hil.hil.simulation import simulate
from tcs_hil.service.settings import ServiceConfig
from tcs_hil.signals import Command

SCENARIOS = {"launch-mu-030": "launch on snow", "mu-drop-060-kmph": "60 km/h"}
SIGNALS = (
    "WheelSpeedFL",
    "WheelSpeedRL",
    "MotorSpeedL",
    "MotorTorqueL",
    "DriverTorqueRequestL",
    "VehicleAccelX",
)
KINDS: dict[str, dict[str, str | float]] = {
    "off": {"kind": "off"},
    "stuck": {"kind": "stuck"},
    "garbage, 0 to 300": {"kind": "garbage"},
    "20 % too high": {"kind": "wrong", "scale": 1.2},
    "half": {"kind": "wrong", "scale": 0.5},
    "5 too high": {"kind": "wrong", "offset": 5.0},
    "lag of 0.1 s": {"kind": "slow", "time_constant_s": 0.1},
    "20 ms late": {"kind": "delayed", "delay_s": 0.02},
}
START_S, END_S, STOP_S = 1.0, 1.5, 1.6
PERIOD_S = 0.002


class Finding(NamedTuple):
    """When a fault was found, ms after it came, and what it was called."""

    after_ms: float
    code: FaultCode


def drive(scenario: Scenario, signal: str, values: dict[str, str | float]) -> Finding | None:
    """One run with one fault; None if it was not found while it was there."""
    described = {"target": signal, "start_s": START_S, "end_s": END_S, **values}
    faults = (msgspec.convert(described, Fault),)
    run = msgspec.structs.replace(scenario, fault=faults, duration_s=STOP_S, end_distance_m=None)
    return first_finding(simulate(run, ServiceConfig()).commands)


def first_finding(commands: Sequence[Command]) -> Finding | None:
    """The first fault code while the fault was there."""
    start, end = round(START_S / PERIOD_S), round(END_S / PERIOD_S)
    for tick, command in enumerate(commands[start:end]):
        if command.fault_code:
            return Finding(tick * PERIOD_S * 1e3, FaultCode(command.fault_code))
    return None


def table() -> Iterator[list[str]]:
    """A row per signal and fault."""
    work = [(signal, kind) for signal in SIGNALS for kind in KINDS]
    scenarios = [load_scenario(name) for name in SCENARIOS]
    with progress_bar("sensor faults") as advance:
        for done, (signal, kind) in enumerate(work, 1):
            findings = [drive(scenario, signal, KINDS[kind]) for scenario in scenarios]
            advance(done / len(work), f"{signal}, {kind}")
            times = ["-" if f is None else f"{f.after_ms:.0f} ms" for f in findings]
            names = dict.fromkeys(f"`{f.code.name}`" for f in findings if f is not None)
            yield [f"`{signal}` {kind}", *times, ", ".join(names) or "-"]


@click.command()
@write_option
def main(write: Path | None) -> None:
    """Let every sensor fail in every way, and tell when it was found."""
    lines = markdown(("fault", *SCENARIOS.values(), "named"), table())
    tell("benchmarks.sensor_faults", lines, write)


if __name__ == "__main__":
    main()
