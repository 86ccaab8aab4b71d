"""What a signal map must say, and what it says twice."""

from __future__ import annotations

import msgspec

from tcs_hil.canbus.mapping.findings import Findings
from tcs_hil.canbus.mapping.plan import (
    AXLE_INPUT,
    DRIVER_INPUTS,
    MOTOR_INPUTS,
    WHEEL_INPUTS,
    Plan,
)
from tcs_hil.canbus.mapping.settings import SignalMap


def check_complete(settings: SignalMap, findings: Findings) -> None:
    """Find what the service cannot do without."""
    for name in WHEEL_INPUTS:
        if getattr(settings.inputs, name) is None:
            findings.error(f"inputs.{name}", "is missing; slip needs the speed of every wheel")
    _check_motors(settings, findings)
    _check_pair(settings.inputs, "inputs", DRIVER_INPUTS, AXLE_INPUT, findings)
    _check_pair(settings.limits, "limits", ("left", "right"), "axle", findings)


def check_directions(plan: Plan, findings: Findings) -> None:
    """Find messages that are both read and written, or share an identifier."""
    received = {message.frame_id: message for message in plan.messages.values()}
    for output in plan.outputs:
        name, frame_id = output.message.name, output.message.frame_id
        other = received.get(frame_id)
        if other is not None:
            findings.error(
                f"messages.{name}",
                f"would be sent with the identifier {frame_id:#05x}, which is also read (as "
                f"{other.name}); an identifier has one sender",
            )


def check_used(settings: SignalMap, findings: Findings) -> None:
    """Find messages that the map describes for nothing."""
    tables = (msgspec.structs.asdict(table) for table in (settings.inputs, settings.limits))
    used = {
        mapped.signal.partition(".")[0]
        for table in tables
        for mapped in table.values()
        if mapped is not None
    }
    for name in settings.messages.keys() - used:
        findings.warn(f"messages.{name}", "no signal of this message is mapped")


def _check_motors(settings: SignalMap, findings: Findings) -> None:
    missing = [name for name in MOTOR_INPUTS if getattr(settings.inputs, name) is None]
    if missing and len(missing) < len(MOTOR_INPUTS):
        findings.error(
            f"inputs.{missing[0]}",
            "is missing; map speed and torque of both motors, or none of them",
        )


def _check_pair(
    table: object, place: str, pair: tuple[str, str], axle: str, findings: Findings
) -> None:
    left, right = (getattr(table, name) is not None for name in pair)
    has_axle = getattr(table, axle) is not None
    if has_axle and (left or right):
        findings.error(f"{place}.{axle}", "stands beside a left or a right one; map only one kind")
    elif not (has_axle or (left and right)):
        missing = pair[1] if left else pair[0]
        findings.error(f"{place}.{missing}", f"is missing; map {' and '.join(pair)}, or {axle}")
