"""Lockstep pace: each tick waits for the service's answer; no clock drives anything."""

from __future__ import annotations

from collections.abc import Callable

from plant_emulator.emulator import PERIOD_NS, Emulator
from tcs_hil.canbus.port import CanPort
from tcs_hil.errors import BusError
from tcs_hil.runtime.clock import MonotonicClock

POLL_S = 0.1


def run_lockstep(
    emulator: Emulator, port: CanPort, stop: Callable[[], bool], timeout_s: float = 10.0
) -> None:
    """Drive the plant to the end of its scenario, or until ``stop()``.

    Tick k: the frames due at k x 2 ms, BenchTick(k), everything the service
    answers up to BenchTickDone(k), then 2 ms of driving.  Answers act at once:
    the delay of a bus, where wanted, is the emulator's own (``[bus]``).

    Raises:
        BusError: no answer within ``timeout_s``.
    """
    tick = 0
    while not emulator.plant.finished and not stop():
        emulator.publish()
        emulator.send_tick(tick)
        _await_answer(emulator, port, tick, stop, timeout_s)
        tick += 1
        emulator.advance_to(tick * PERIOD_NS)


def _await_answer(
    emulator: Emulator, port: CanPort, tick: int, stop: Callable[[], bool], timeout_s: float
) -> None:
    clock = MonotonicClock()  # for giving up only
    give_up_ns = clock.now_ns() + round(timeout_s * 1e9)
    while not emulator.answered(tick) and not stop():
        port.wait(POLL_S)
        for frame in port.receive():
            emulator.hear(frame.frame_id, frame.data, tick * PERIOD_NS)
        if clock.now_ns() > give_up_ns:
            raise BusError(
                f"no answer to tick {tick} within {timeout_s:g} s; "
                "start `tcs-hil run --trigger lockstep` first"
            )
