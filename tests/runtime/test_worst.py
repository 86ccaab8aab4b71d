"""Which ticks are the worst, and what is to blame."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
from msgspec.structs import replace
from runtime.fakes import PERIOD_NS, RUN, TRACE, insight, made_pass

from tcs_hil.control.protocol import Proposal, SolveStatus
from tcs_hil.runtime.record import record
from tcs_hil.runtime.recorder import FlightRecorder
from tcs_hil.runtime.recording import read
from tcs_hil.runtime.tick import Insight, Pass
from tcs_hil.runtime.worst import BadTick, worst_ticks

Judge = Callable[..., list[BadTick]]


@pytest.fixture
def worst(tmp_path: Path) -> Judge:
    """Record quiet ticks with the given ones in their midst, and ask for the worst."""

    def judge(count: int, *passes: Pass, knowing: Insight | None = None) -> list[BadTick]:
        quiet = [made_pass(n, scheduled_ns=(n + 1) * PERIOD_NS) for n in range(10)]
        with FlightRecorder(tmp_path / "flight", RUN, 100) as recorder:
            for made in quiet:
                recorder.write(record(made, insight()))
            for made in passes:
                recorder.write(record(made, knowing or insight()))
        return worst_ticks(read(tmp_path / "flight"), count)

    return judge


def late(number: int, *, wake_us: int = 0, receive_us: int = 0, send_us: int = 0) -> Pass:
    """A tick in which some stages took longer than in the quiet ones."""
    made = made_pass(number, scheduled_ns=(number + 1) * PERIOD_NS)
    wake_ns = made.tick.wake_ns + wake_us * 1000
    received_ns = made.stamps.received_ns + (wake_us + receive_us) * 1000
    stepped_ns = made.stamps.stepped_ns + (wake_us + receive_us) * 1000
    sent_ns = made.stamps.sent_ns + (wake_us + receive_us + send_us) * 1000
    stamps = replace(made.stamps, received_ns=received_ns, stepped_ns=stepped_ns, sent_ns=sent_ns)
    return replace(made, tick=replace(made.tick, wake_ns=wake_ns), stamps=stamps)


def test_the_slowest_ticks_are_listed_in_the_order_of_time(worst: Judge) -> None:
    found = worst(2, late(20, send_us=50), late(21, send_us=300), late(22, send_us=200))
    assert [tick.number for tick in found] == [21, 22]
    assert found[0].response_us == pytest.approx(390)
    assert found[0].at_s == pytest.approx(21 * PERIOD_NS * 1e-9)


@pytest.mark.parametrize(
    ("slow", "culprit"),
    [({"wake_us": 90}, "wake"), ({"receive_us": 90}, "receive"), ({"send_us": 90}, "send")],
)
def test_the_stage_that_took_more_than_it_usually_does_is_to_blame(
    worst: Judge, slow: dict[str, int], culprit: str
) -> None:
    (tick,) = worst(1, late(20, **slow))
    assert tick.culprit == culprit


def test_a_law_that_thought_long_is_to_blame_and_not_the_rest_of_the_decision(
    worst: Judge,
) -> None:
    made = made_pass(20, sent_us=3000)
    made = replace(made, stamps=replace(made.stamps, stepped_ns=made.stamps.sent_ns - 40_000))
    (tick,) = worst(1, made, knowing=replace(insight(), solve_ns=(81, 2_900_000)))
    assert tick.culprit == "solve_fr"
    assert tick.overrun


def test_the_stages_add_up_to_the_response(worst: Judge) -> None:
    (tick,) = worst(1, late(20, wake_us=11, receive_us=7, send_us=400))
    assert sum(tick.stages_us.values()) == pytest.approx(tick.response_us)


def test_what_the_tick_met_stands_beside_it(worst: Judge) -> None:
    failed = (Proposal(51.0, SolveStatus.FAILED, iterations=9), Proposal(52.0, iterations=8))
    skipper = late(20, send_us=90)
    skipper = replace(skipper, tick=replace(skipper.tick, skipped=3))
    knowing = replace(insight(), trace=replace(TRACE, proposals=failed))
    (tick,) = worst(1, skipper, knowing=knowing)
    assert (tick.frames, tick.skipped, tick.state) == (4, 3, "ACTIVE")
    assert tick.statuses == ("FAILED", "OK")
    assert tick.iterations == (9, 8)


def test_more_than_there_are_is_all_of_them(worst: Judge) -> None:
    assert len(worst(100)) == 10


def test_an_empty_recording_has_no_worst_tick(tmp_path: Path) -> None:
    with FlightRecorder(tmp_path / "flight", RUN, 4):
        pass
    assert worst_ticks(read(tmp_path / "flight"), 5) == []
