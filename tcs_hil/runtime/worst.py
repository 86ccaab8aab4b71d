"""The worst ticks of a run, and what each of them was doing."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tcs_hil.control.protocol import SolveStatus
from tcs_hil.runtime.times import US_PER_NS
from tcs_hil.signals import TcsState

STAGES = ("wake", "receive", "solve_fl", "solve_fr", "decide", "send")
"""Waking late, draining the bus, each wheel's law, the rest of the decision, sending."""


@dataclass(frozen=True, slots=True)
class BadTick:
    """One tick that took long, from the moment it was due to its last frame sent.

    ``culprit`` is the stage that took most beyond its own median over the run.
    """

    at_s: float  # since the first tick of the recording
    number: int
    response_us: float
    stages_us: dict[str, float]
    culprit: str
    frames: int
    skipped: int
    iterations: tuple[int, int]
    statuses: tuple[str, str]
    state: str
    overrun: bool
    failed: bool

    def as_dict(self) -> dict[str, Any]:
        """Return plain values, fit for JSON."""
        return asdict(self)


def worst_ticks(ticks: NDArray[np.void], count: int) -> list[BadTick]:
    """The ``count`` ticks with the longest response, in the order of time.

    ``ticks`` are as ``recording.read`` returns them: (n,), n may be 0.
    """
    stages_us = _stages_us(ticks)
    beyond_us = stages_us - np.median(stages_us, axis=0) if len(ticks) else stages_us
    culprits = beyond_us.argmax(axis=1)
    slowest = np.sort(np.argsort(stages_us.sum(axis=1))[::-1][:count])
    return [
        _bad_tick(ticks[index], _since_s(ticks, index), stages_us[index], STAGES[culprits[index]])
        for index in slowest
    ]


def _stages_us(ticks: NDArray[np.void]) -> NDArray[np.float64]:
    """Time spent in each of ``STAGES``: (n, 6); a row adds up to the response."""
    left, right = ticks["solve_fl_ns"], ticks["solve_fr_ns"]
    stages_ns = (
        ticks["wake_ns"] - ticks["scheduled_ns"],
        ticks["received_ns"] - ticks["wake_ns"],
        left,
        right,
        ticks["stepped_ns"] - ticks["received_ns"] - left - right,
        ticks["sent_ns"] - ticks["stepped_ns"],
    )
    return np.column_stack(stages_ns) * US_PER_NS


def _since_s(ticks: NDArray[np.void], index: int) -> float:
    return float(ticks["wake_ns"][index] - ticks["wake_ns"][0]) * 1e-9


def _bad_tick(tick: np.void, at_s: float, stages_us: NDArray[np.float64], culprit: str) -> BadTick:
    return BadTick(
        at_s=at_s,
        number=int(tick["number"]),
        response_us=float(stages_us.sum()),
        stages_us=dict(zip(STAGES, stages_us.tolist(), strict=True)),
        culprit=culprit,
        frames=int(tick["frames"]),
        skipped=int(tick["skipped"]),
        iterations=(int(tick["iterations_fl"]), int(tick["iterations_fr"])),
        statuses=(SolveStatus(tick["status_fl"]).name, SolveStatus(tick["status_fr"]).name),
        state=TcsState(tick["state"]).name,
        overrun=bool(tick["overrun"]),
        failed=bool(tick["failed"]),
    )
