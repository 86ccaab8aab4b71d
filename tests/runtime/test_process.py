"""Clock, stop request and real-time set-up, each against the real operating system."""

from __future__ import annotations

import os
import signal
import subprocess
import sys

import pytest

from tcs_hil.runtime.clock import MonotonicClock
from tcs_hil.runtime.stop import StopRequest


def run(script: str) -> subprocess.CompletedProcess[str]:
    setup = "import sys; sys.path[:0] = sys.argv[1:]\n"
    return subprocess.run(
        [sys.executable, "-c", setup + script, *sys.path],
        capture_output=True,
        text=True,
        timeout=30,
        check=False,
    )


def test_a_sleep_never_ends_before_its_deadline() -> None:
    clock = MonotonicClock()
    for ahead_ns in (1, 1_000, 123_457, 2_000_000):
        deadline_ns = clock.now_ns() + ahead_ns
        clock.sleep_until(deadline_ns)
        assert clock.now_ns() >= deadline_ns


def test_the_end_of_a_wait_is_spent_awake_when_asked(monkeypatch: pytest.MonkeyPatch) -> None:
    slept_s: list[float] = []
    monkeypatch.setattr("time.sleep", slept_s.append)  # returns at once: the rest is spun
    clock = MonotonicClock(spin_ns=1_000_000)
    deadline_ns = clock.now_ns() + 2_000_000
    clock.sleep_until(deadline_ns)
    assert clock.now_ns() >= deadline_ns
    assert 0 < slept_s[0] <= 0.001


def test_a_signal_does_not_cut_a_sleep_short() -> None:
    previous = signal.signal(signal.SIGALRM, lambda *_: None)
    try:
        clock = MonotonicClock()
        deadline_ns = clock.now_ns() + 20_000_000
        signal.setitimer(signal.ITIMER_REAL, 0.005)
        clock.sleep_until(deadline_ns)
        assert clock.now_ns() >= deadline_ns
    finally:
        signal.signal(signal.SIGALRM, previous)


def test_a_deadline_in_the_past_does_not_sleep(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("time.sleep", lambda _: pytest.fail("slept"))
    clock = MonotonicClock()
    clock.sleep_until(clock.now_ns() - 1)
    clock.sleep_until(0)


@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGINT])
def test_the_first_signal_asks_politely(number: signal.Signals) -> None:
    with StopRequest() as stop:
        assert not stop.requested()
        os.kill(os.getpid(), number)
        assert stop.requested()


def test_the_handlers_of_before_are_back_afterwards() -> None:
    before = signal.getsignal(signal.SIGTERM), signal.getsignal(signal.SIGINT)
    with StopRequest():
        os.kill(os.getpid(), signal.SIGTERM)
    assert (signal.getsignal(signal.SIGTERM), signal.getsignal(signal.SIGINT)) == before


def test_the_second_signal_ends_a_process_that_does_not_listen() -> None:
    ended = run("""
import os, signal, time
from tcs_hil.runtime.stop import INSISTING_S, StopRequest
with StopRequest() as stop:
    for _ in range(2):
        os.kill(os.getpid(), signal.SIGTERM)
        print("still here", stop.requested(), flush=True)
    now_s = time.monotonic() + INSISTING_S
    time.monotonic = lambda: now_s
    os.kill(os.getpid(), signal.SIGTERM)
    print("never printed", flush=True)
""")
    assert ended.stdout == "still here True\n" * 2
    assert ended.returncode == -signal.SIGTERM


def test_every_real_time_request_is_answered_and_the_collector_is_off() -> None:
    ended = run("""
import gc
from tcs_hil.runtime.realtime import prepare
grants = prepare(cpu=0)
print(gc.isenabled(), gc.get_freeze_count() > 0)
for grant in grants:
    print(tuple(grant))
""")
    assert ended.returncode == 0, ended.stderr
    collector, *lines = ended.stdout.splitlines()
    assert collector == "False True"
    assert len(lines) == 5


def test_a_refusal_says_what_would_grant_it() -> None:
    ended = run("""
import os
from tcs_hil.runtime import realtime
def refuse(*_):
    raise PermissionError(1, "Operation not permitted")
os.sched_setscheduler = os.sched_setaffinity = refuse
for grant in realtime.prepare(cpu=4096, priority=60):
    print(grant.got, grant.what, grant.why, sep="|")
""")
    answers = [line.split("|") for line in ended.stdout.splitlines()]
    assert answers[3] == [
        "False",
        "SCHED_FIFO 60",
        "Operation not permitted: raise LimitRTPRIO / ulimit -r",
    ]
    assert answers[4][0] == "False"
    assert "core 4096" in answers[4][1]


def test_affinity_is_asked_for_only_when_a_core_is_named() -> None:
    ended = run("""
from tcs_hil.runtime.realtime import prepare
print(*(grant.what for grant in prepare()), sep="|")
""")
    assert not any(what.startswith("core") for what in ended.stdout.split("|"))
