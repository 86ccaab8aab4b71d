"""The panels of the live view, each a text made from what is known.  Pure."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from rich.table import Table
from rich.text import Text

from tcs_hil.canbus.bench_control import BenchControl, BenchFault
from tcs_hil.hil.monitor.history import Point
from tcs_hil.hil.monitor.plot import Curve, plot
from tcs_hil.hil.monitor.snapshot import Side, Snapshot

LEFT, RIGHT, DIM, STRONG = "#5fd7ff", "#ffaf5f", "grey58", "bold"
STATE_STYLES = {
    "ACTIVE": "bold black on #5faf5f",
    "STANDBY": "bold black on #87afd7",
    "DEGRADED": "bold black on #ffd75f",
    "FAULT": "bold white on #d70000",
}
SHORT = {
    "TorqueLimit": "limit",
    "MotorState": "motor",
    "WheelSpeedsFront": "front",
    "WheelSpeedsRear": "rear",
    "DriverRequest": "driver",
    "TcsStatus": "status",
    "TcsEstimates": "road",
    "wake_jitter": "jitter",
    "e2e_errors": "E2E errors",
    "e2e_repeated": "repeated",
    "e2e_wrong_sequence": "out of sequence",
    "lost_frames": "lost",
}
SILENT_S = 0.5
SLIP_TOPS = (0.2, 0.3, 0.5, 1.0)
TORQUE_STEP_NM = 50.0


def head(snapshot: Snapshot) -> Text:
    """State, controller, the fault and what it means."""
    state = STATE_STYLES.get(snapshot.state, "bold black on grey70")
    line = Text.assemble((f" {snapshot.state} ", state), " ", (snapshot.controller, STRONG), "  ")
    if snapshot.silent_s is None or snapshot.silent_s > SILENT_S:
        since = "" if snapshot.silent_s is None else f" for {snapshot.silent_s:.0f} s"
        return line.append(f"nothing is heard{since}", "bold #ffd75f")
    if snapshot.fault_code:
        return line.append(f"{snapshot.fault_code} {snapshot.fault}", "#ffd75f")
    return line.append("no fault", DIM)


def slip_plot(points: Sequence[Point], width: int, height: int) -> Text:
    """Slip of both wheels against the reference; the scale grows with what it shows."""
    peak = max((max(point.slip) for point in points), default=0.0)
    curves = [
        Curve([point.reference for point in points], "grey70", dashed=True),
        Curve([point.slip[1] for point in points], RIGHT),
        Curve([point.slip[0] for point in points], LEFT),
    ]
    return plot(
        curves, width, height, next((top for top in SLIP_TOPS if peak <= top), SLIP_TOPS[-1])
    )


def torque_plot(points: Sequence[Point], width: int, height: int) -> Text:
    """What each motor may give, under what the driver asks."""
    peak_nm = max((point.request_nm for point in points), default=0.0)
    top_nm = max(-(-peak_nm // TORQUE_STEP_NM), 1) * TORQUE_STEP_NM
    curves = [
        Curve([point.request_nm for point in points], "grey70", dashed=True),
        Curve([point.allowed_nm[1] for point in points], RIGHT),
        Curve([point.allowed_nm[0] for point in points], LEFT),
    ]
    return plot(curves, width, height, top_nm)


def slip_numbers(snapshot: Snapshot) -> Table:
    """Slip, wheel speeds and what is believed of the road or the car, side by side."""
    table = _sides()
    _row(table, snapshot, "slip", lambda side: f"{side.slip_ratio:.3f}")
    _row(table, snapshot, "front rad/s", lambda side: f"{side.wheel_speed_radps:.1f}")
    _row(table, snapshot, "rear", lambda side: f"{side.rear_speed_radps:.1f}")
    if snapshot.vehicle_speed_mps is None:
        _row(table, snapshot, "mu, certain", _road)
    else:
        table.add_row("car km/h", f"{3.6 * snapshot.vehicle_speed_mps:.1f}", "")
    return table


def torque_numbers(snapshot: Snapshot) -> Table:
    """Request, limit and what the motors give."""
    table = _sides()
    _row(table, snapshot, "driver Nm", lambda side: f"{side.request_nm:.1f}")
    _row(table, snapshot, "limit", lambda side: _or_dash(side.limit_nm, ".1f", "none"))
    _row(table, snapshot, "motor", lambda side: f"{side.motor_nm:.1f}")
    _row(table, snapshot, "held back", lambda side: f"{side.request_nm - side.allowed_nm:.1f}")
    return table


def timing(snapshot: Snapshot) -> Text:
    """Times of the last seconds, frames a second, and everything that went wrong."""
    lines = []
    if snapshot.times:
        lines.append(_pairs({name: _spread(snapshot, name) for name in snapshot.times}))
    if snapshot.rates_hz:
        lines.append(_pairs({name: f"{rate:.0f}" for name, rate in _by_name(snapshot.rates_hz)}))
    counts = {name: str(count) for name, count in snapshot.counts.items()}
    lines.append(_pairs(counts, "bold #ffd75f"))
    return Text("\n").join(lines)


def hand(control: BenchControl) -> Text:
    """What the keys have asked for, in the place of the scenario."""
    held = {
        "throttle": _or_dash(control.throttle_nm, ".0f", "scenario"),
        "mu": _or_dash(control.mu_ratio, ".2f", "scenario"),
        "fault": "none" if control.fault is BenchFault.NONE else _words(control.fault),
    }
    return _pairs(held)


def keys(*, in_control: bool) -> Text:
    """The help line at the bottom."""
    known = {"q": "quit"}
    if in_control:
        known = {"↑↓": "throttle", "←→": "mu", "1-8": "fault", "space": "as in scenario"} | known
    return Text("   ").join(Text.assemble((key, "bold"), f" {what}") for key, what in known.items())


def _words(fault: BenchFault) -> str:
    return f"{int(fault)} {fault.name.replace('_', ' ').lower()}"


def _sides() -> Table:
    table = Table(box=None, padding=(0, 1, 0, 0), expand=True, header_style="dim")
    table.add_column("", style=DIM)
    table.add_column("left", justify="right", style=LEFT)
    table.add_column("right", justify="right", style=RIGHT)
    return table


def _row(table: Table, snapshot: Snapshot, name: str, read: Callable[[Side], str]) -> None:
    table.add_row(name, read(snapshot.left), read(snapshot.right))


def _road(side: Side) -> str:
    return f"{_or_dash(side.mu_ratio, '.2f')} {_or_dash(side.mu_confidence, '3.0%')}"


def _by_name(rates_hz: dict[str, float]) -> list[tuple[str, float]]:
    """Rates in an order that does not depend on who spoke first."""
    order = list(SHORT)
    return sorted(
        rates_hz.items(), key=lambda item: order.index(item[0]) if item[0] in SHORT else len(order)
    )


def _or_dash(value: float | None, form: str, absent: str = "-") -> str:
    return absent if value is None else format(value, form)


def _spread(snapshot: Snapshot, name: str) -> str:
    times = snapshot.times[name]
    return f"{times.p50_us:.0f}/{times.p99_us:.0f}/{times.max_us:.0f}"


def _pairs(values: dict[str, str], alarm: str = "") -> Text:
    """Names in grey, values in white; with ``alarm``, those that are not zero in that style."""
    parts = [
        Text.assemble(
            (f"{SHORT.get(name, name)} ", DIM), (value, alarm if alarm and value != "0" else "")
        )
        for name, value in values.items()
    ]
    return Text("  ").join(parts)
