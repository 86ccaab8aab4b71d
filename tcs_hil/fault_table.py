"""The fault codes as a Markdown table, from the supervisor's rules alone."""

from __future__ import annotations

from tcs_hil.fault_codes import MEANINGS, FaultCode
from tcs_hil.gate import Permission
from tcs_hil.supervisor import RULES, Rule

HEADER = (
    "| code | name | meaning | state | the limits | time to react |",
    "|--:|---|---|---|---|---|",
)
REACTIONS = {
    Permission.FOLLOW_SLOWLY: "follow the law, rise at the release rate",
    Permission.HOLD: "may fall, do not rise",
    Permission.RELEASE: "ramp to the driver's request, then none",
}
ONE_TICK = "1 tick"
TIMES = {
    FaultCode.AWAITING_INPUT: "in INIT: stays there",
    FaultCode.FRONT_SPEED_LATE: "3rd missing cycle, 6 ms",
    FaultCode.REAR_SPEED_LATE: "3rd missing cycle, 6 ms",
    FaultCode.MOTOR_STATE_LATE: "3rd missing cycle, 6 ms",
    FaultCode.DRIVER_REQUEST_LATE: "3rd missing cycle, 30 ms",
    FaultCode.FRONT_SPEED_LOST: "11th missing cycle, 22 ms",
    FaultCode.REAR_SPEED_LOST: "11th missing cycle, 22 ms",
    FaultCode.DRIVER_REQUEST_LOST: "11th missing cycle, 110 ms",
    FaultCode.FRONT_SPEED_CORRUPT: "the E2E window",
    FaultCode.REAR_SPEED_CORRUPT: "the E2E window",
    FaultCode.MOTOR_STATE_CORRUPT: "the E2E window",
    FaultCode.DRIVER_REQUEST_CORRUPT: "the E2E window",
    FaultCode.FRONT_SPEED_IMPLAUSIBLE: "2 to 50 ms after it shows",
    FaultCode.ONE_REAR_SPEED_IMPLAUSIBLE: "2 to 100 ms after it shows",
    FaultCode.REAR_SPEEDS_IMPLAUSIBLE: "2 to 100 ms after it shows",
    FaultCode.MOTOR_STATE_IMPLAUSIBLE: "20 to 100 ms after it shows",
    FaultCode.ACCELERATION_IMPLAUSIBLE: "2 to 50 ms after it shows",
    FaultCode.DRIVER_REQUEST_IMPLAUSIBLE: "2 to 100 ms after it shows",
    FaultCode.CONTROLLER_LOST: "11th tick, 22 ms",
    FaultCode.OVERRUNS: "5th tick, 10 ms",
}
"""By the shipped settings, from the event to the limits that answer it."""


def markdown_table() -> str:
    """One row per code, in the order of their numbers."""
    rows = [_row(rule) for rule in sorted(RULES, key=lambda rule: rule.code)]
    return "\n".join((*HEADER, *rows))


def _row(rule: Rule) -> str:
    code = rule.code
    about = (
        f"{code}",
        f"`{code.name}`",
        MEANINGS[code],
        rule.state.name,
        REACTIONS[rule.permission],
        TIMES.get(code, ONE_TICK),
    )
    return f"| {' | '.join(about)} |"
