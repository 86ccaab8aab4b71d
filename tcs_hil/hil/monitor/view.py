"""The terminal: lays the panels out, draws them ten times a second, hears the keys."""

from __future__ import annotations

from typing import ClassVar

from textual.app import App, ComposeResult
from textual.containers import Horizontal
from textual.events import Key
from textual.widgets import Static

from tcs_hil.canbus.bench_control import AS_IN_SCENARIO, BenchControl
from tcs_hil.errors import TcsError
from tcs_hil.hil.monitor import hand, panels
from tcs_hil.hil.monitor.sources import Source

DRAW_PERIOD_S = 0.1
TITLES = {
    "slip": "slip · last 12 s · ╌ target",
    "torque": "torque allowed, Nm · ╌ driver",
    "timing": "p50/p99/max µs · frames/s · counts",
    "hand": "by hand",
}
STYLE = """
Screen { background: #10141a; color: #d7dae0; }
Static {
    border: round #3a4350; padding: 0 1;
    border-title-color: #8a94a3; border-subtitle-color: #8a94a3;
}
#head { height: 1; border: none; }
.plots { height: 1fr; }
.plot { width: 1fr; height: 100%; }
.numbers { width: 34; height: 100%; }
#timing { height: auto; }
#hand { height: 3; border: round #af5fd7; }
#keys { border: none; height: 1; color: #8a94a3; }
"""


class Monitor(App[TcsError]):
    """Ends when ``q`` is pressed, or with the error that took its source away."""

    CSS = STYLE
    TITLE = "tcs-hil monitor"
    BINDINGS: ClassVar = [("q", "quit", "quit")]
    ENABLE_COMMAND_PALETTE = False

    def __init__(self, source: Source, *, in_control: bool) -> None:
        super().__init__()
        self._source = source
        self._in_control = in_control
        self._control = AS_IN_SCENARIO
        self._request_nm = 0.0
        self._panels: dict[str, Static] = {}

    @property
    def control(self) -> BenchControl:
        """What the keys have asked for so far."""
        return self._control

    def compose(self) -> ComposeResult:
        """Every panel, empty."""
        yield Static(id="head")
        with Horizontal(classes="plots"):
            yield Static(id="slip", classes="plot")
            yield Static(id="slip-numbers", classes="numbers")
        with Horizontal(classes="plots"):
            yield Static(id="torque", classes="plot")
            yield Static(id="torque-numbers", classes="numbers")
        yield Static(id="timing")
        yield Static(id="hand")
        yield Static(panels.keys(in_control=self._in_control), id="keys")

    def on_mount(self) -> None:
        """Name the panels and begin to draw."""
        # Held on to: a timer may still go off while the screen is being taken down.
        self._panels = {str(panel.id): panel for panel in self.query(Static)}
        for name, title in TITLES.items():
            self._panels[name].border_title = title
        self._panels["hand"].display = self._in_control
        self.set_interval(DRAW_PERIOD_S, self.redraw)
        self.call_after_refresh(self.redraw)  # sizes are known only then

    def on_key(self, event: Key) -> None:
        """Ask the emulator for what the key means."""
        if self._in_control and event.key in hand.KEYS:
            self._control = hand.press(self._control, event.key, self._request_nm)
            self._source.ask(self._control)

    def redraw(self) -> None:
        """Show what the source knows now."""
        try:
            snapshot, points = self._source.look()
        except TcsError as error:
            self.exit(error)
            return
        self._panels["hand"].update(panels.hand(self._control))
        if snapshot is None:
            return
        self._request_nm = max(snapshot.left.request_nm, snapshot.right.request_nm)
        self._panels["head"].update(panels.head(snapshot))
        self._panels["timing"].border_subtitle = snapshot.source
        self._panels["slip-numbers"].update(panels.slip_numbers(snapshot))
        self._panels["torque-numbers"].update(panels.torque_numbers(snapshot))
        self._panels["timing"].update(panels.timing(snapshot))
        for name, draw in (("slip", panels.slip_plot), ("torque", panels.torque_plot)):
            size = self._panels[name].content_size
            self._panels[name].update(draw(points, size.width, size.height))
