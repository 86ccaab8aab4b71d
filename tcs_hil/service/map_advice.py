"""What the service makes of the timing and the gaps of a signal map."""

from __future__ import annotations

import math

from tcs_hil.canbus.database import load_database
from tcs_hil.canbus.mapping.findings import Findings
from tcs_hil.canbus.mapping.plan import (
    ACCEL_INPUT,
    AXLE_INPUT,
    DRIVER_INPUTS,
    MOTOR_INPUTS,
    WHEEL_INPUTS,
    Plan,
)
from tcs_hil.service.settings import ServiceConfig
from tcs_hil.supervisor import DRIVER_CYCLE_S, PERIOD_S

MS_PER_S = 1e3


def advise(plan: Plan, config: ServiceConfig, findings: Findings) -> None:
    """Find what the service would run worse with, or not at all."""
    for names, counted_s in (
        (WHEEL_INPUTS, PERIOD_S),
        ((*DRIVER_INPUTS, AXLE_INPUT), DRIVER_CYCLE_S),
    ):
        for message in plan.sources(names):
            cycle_s = message.cycle_ms / MS_PER_S * plan.pages_of(message.name)
            _check_cycle(message.name, cycle_s, counted_s, config, findings)
    _check_limits(plan, config, findings)
    _check_trigger(plan, config, findings)
    _note_gaps(plan, findings)


def _check_cycle(
    name: str, cycle_s: float, counted_s: float, config: ServiceConfig, findings: Findings
) -> None:
    """Find an input slower than the supervisor's patience, which it counts in ``counted_s``."""
    patience, cycles = config.supervisor, cycle_s / counted_s
    key, said = f"messages.{name}", f"brings its values every {cycle_s * MS_PER_S:g} ms"
    if cycles >= patience.tolerated_cycles + 1:
        findings.error(
            key,
            f"{said}: the supervisor would give them up between two frames and hold no wheel; "
            f"set supervisor.bridged_cycles to {math.ceil(cycles)} or more and "
            "supervisor.tolerated_cycles above that",
        )
    elif cycles >= patience.bridged_cycles + 1:
        findings.warn(
            key,
            f"{said}: the supervisor would let no torque rise between two frames; "
            f"set supervisor.bridged_cycles to {math.ceil(cycles)} or more",
        )
    elif cycles > 1:
        findings.note(
            key, f"{said}: slip is held more loosely than with {counted_s * MS_PER_S:g} ms"
        )


def _check_limits(plan: Plan, config: ServiceConfig, findings: Findings) -> None:
    period_ms = config.control.period_s * MS_PER_S
    for output in plan.outputs:
        cycle_ms = output.message.cycle_ms
        if cycle_ms > period_ms:
            findings.warn(
                f"messages.{output.message.name}",
                f"goes out every {cycle_ms:g} ms while the service decides every {period_ms:g} ms: "
                f"limits reach the motors up to {cycle_ms - period_ms:g} ms late",
            )


def _check_trigger(plan: Plan, config: ServiceConfig, findings: Findings) -> None:
    bench = load_database().messages
    ids = {bench[name].frame_id for name in ("BenchTick", "BenchTickDone")}
    mapped = (*plan.messages.values(), *(output.message for output in plan.outputs))
    taken = [message.name for message in mapped if message.frame_id in ids]
    if config.tick.trigger == "lockstep" and taken:
        findings.error("tick.trigger", f"lockstep needs the identifier that {taken[0]} has")
    slowest_ms = max((m.cycle_ms for m in plan.sources(WHEEL_INPUTS)), default=0.0)
    if config.tick.trigger == "frame" and slowest_ms > config.control.period_s * MS_PER_S:
        findings.warn(
            "tick.trigger", f"frame waits for wheel speeds, which come every {slowest_ms:g} ms only"
        )


def _note_gaps(plan: Plan, findings: Findings) -> None:
    if not any(name in plan.inputs for name in MOTOR_INPUTS):
        findings.warn(
            "inputs",
            "no motor speeds and torques: the PI stands in for the default laws, by the wheels' "
            "own sensors, which say little at walking pace, and control.default.delay is "
            "believed, not measured",
        )
    if ACCEL_INPUT not in plan.inputs:
        findings.note(
            f"inputs.{ACCEL_INPUT}", "no acceleration: the forces of the tyres stand in for it"
        )
