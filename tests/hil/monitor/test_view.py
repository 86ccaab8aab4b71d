"""The terminal, driven by textual's pilot: every panel is legible at 80 x 24, every key acts."""

import asyncio
from collections.abc import Awaitable, Callable

from textual.pilot import Pilot
from textual.widgets import Static

from tcs_hil.canbus.bench_control import AS_IN_SCENARIO, BenchControl, BenchFault
from tcs_hil.errors import TcsError
from tcs_hil.hil.monitor.history import Point
from tcs_hil.hil.monitor.snapshot import Side, Snapshot, Spread
from tcs_hil.hil.monitor.view import Monitor

SIDE = Side(
    slip_ratio=0.1,
    wheel_speed_radps=50.0,
    rear_speed_radps=45.0,
    request_nm=120.0,
    limit_nm=80.0,
    motor_nm=79.0,
    mu_ratio=0.3,
    mu_confidence=0.9,
)
SNAPSHOT = Snapshot(
    source="test bus",
    silent_s=0.0,
    state="DEGRADED",
    controller="KMPC",
    fault_code=42,
    fault="a rear wheel's sensor says that it fails; the other serves",
    slip_reference=0.1,
    vehicle_speed_mps=None,
    left=SIDE,
    right=SIDE,
    times={"limit cycle": Spread(2000.0, 2050.0, 2100.0)},
    rates_hz={"TorqueLimit": 500.0, "others": 3.0},
    counts={"e2e_errors": 7},
)


class Canned:
    """A source that always says the same, and remembers what it was asked for."""

    def __init__(self, error: TcsError | None = None) -> None:
        self.asked: list[BenchControl] = []
        self._error = error

    def look(self) -> tuple[Snapshot | None, list[Point]]:
        if self._error is not None:
            raise self._error
        return SNAPSHOT, [Point(i, (0.1, 0.05), 0.1, 120.0, (80.0, 80.0)) for i in range(100)]

    def ask(self, control: BenchControl) -> None:
        self.asked.append(control)

    def close(self) -> None:
        """Nothing is held."""


def piloted(app: Monitor, act: Callable[[Pilot[TcsError]], Awaitable[None]]) -> list[str]:
    """Run ``app`` at 80 x 24, let the pilot act, return the lines on the screen."""

    async def session() -> list[str]:
        async with app.run_test(size=(80, 24)) as pilot:
            await pilot.pause()  # sizes are known
            app.redraw()
            await act(pilot)
            app.redraw()
            await pilot.pause()
            return [
                "".join(s.text for s in line) for line in app.screen._compositor.render_strips()
            ]

    return asyncio.run(session())


async def nothing(_pilot: Pilot[TcsError]) -> None:
    """Just look."""


def test_everything_is_on_a_small_screen() -> None:
    screen = "\n".join(piloted(Monitor(Canned(), in_control=True), nothing))
    for words in (
        *("DEGRADED", "KMPC", "42 a rear wheel's sensor says that it fails; the other serves"),
        *("slip", "0.100", "front rad/s", "mu, certain", "0.30 90%"),
        *("driver Nm", "120.0", "limit", "80.0", "held back", "40.0"),
        *("limit cycle 2000/2050/2100", "limit 500", "others 3", "E2E errors 7", "test bus"),
        *("throttle scenario", "fault none", "space as in scenario", "q quit"),
    ):
        assert words in screen


def test_the_plots_fill_their_panels() -> None:
    lines = piloted(Monitor(Canned(), in_control=True), nothing)
    dots = [line for line in lines if any("\u2801" <= character <= "\u28ff" for character in line)]
    assert len(dots) >= 2


def test_keys_ask_the_emulator_and_show_what_they_ask() -> None:
    source = Canned()

    async def act(pilot: Pilot[TcsError]) -> None:
        await pilot.press("up", "right", "8")

    screen = "\n".join(piloted(Monitor(source, in_control=True), act))
    assert source.asked[-1] == BenchControl(130.0, 0.3, BenchFault.VEHICLE_BROWN_OUT)
    assert "throttle 130" in screen
    assert "8 vehicle brown out" in screen


def test_space_asks_for_the_scenario() -> None:
    source = Canned()

    async def act(pilot: Pilot[TcsError]) -> None:
        await pilot.press("up", "space")

    piloted(Monitor(source, in_control=True), act)
    assert source.asked[-1] == AS_IN_SCENARIO


def test_without_leave_keys_do_nothing_and_are_not_offered() -> None:
    source = Canned()

    async def act(pilot: Pilot[TcsError]) -> None:
        await pilot.press("up", "right", "8")

    screen = "\n".join(piloted(Monitor(source, in_control=False), act))
    assert source.asked == []
    assert "throttle" not in screen
    assert "q quit" in screen


def test_q_ends_it() -> None:
    app = Monitor(Canned(), in_control=False)

    async def session() -> None:
        async with app.run_test(size=(80, 24)) as pilot:
            await pilot.press("q")

    asyncio.run(session())
    assert app.return_value is None
    assert not app.is_running


def test_a_timer_that_goes_off_once_the_panels_are_gone_does_no_harm() -> None:
    app = Monitor(Canned(), in_control=True)

    async def act(_pilot: Pilot[TcsError]) -> None:
        await app.query("*").remove()

    assert not any(line.strip() for line in piloted(app, act))


def test_a_source_that_is_gone_ends_it_with_its_sentence() -> None:
    gone = TcsError("the recording is gone")
    app = Monitor(Canned(gone), in_control=False)

    async def session() -> None:
        async with app.run_test(size=(80, 24)) as pilot:
            await pilot.pause(0.15)

    asyncio.run(session())
    assert app.return_value is gone


def test_a_panel_is_empty_until_anything_is_known() -> None:
    class Nothing(Canned):
        def look(self) -> tuple[Snapshot | None, list[Point]]:
            return None, []

    app = Monitor(Nothing(), in_control=False)

    async def session() -> None:
        async with app.run_test(size=(80, 24)) as pilot:
            await pilot.pause(0.15)
            assert str(app.query_one("#head", Static).render()) == ""

    asyncio.run(session())
