"""The step of every law and of every peer, along the same recorded drives."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Sequence
from functools import cache

import msgspec
import numpy as np
from numpy.typing import NDArray

from tcs_hil.control.protocol import Controller
from tcs_hil.control.settings import ControlSettings, PresetName
from tcs_hil.hil.bench.candidates import Candidate, candidates
from tcs_hil.hil.bench.effort import Effort, Progress
from tcs_hil.hil.bench.recorded import Drive, Question, record_drive
from tcs_hil.hil.bench.statistics import Cost, Stopwatch, quiet_collector
from tcs_hil.hil.paper import SOLVE_TIMES, SolveTime
from tcs_hil.hil.processes.interruption import uninterrupted
from tcs_hil.service.settings import ServiceConfig

MANOEUVRES = ("manoeuvre-1", "manoeuvre-2")
PART = 100
"""Questions asked in one go: half a second of the slowest peer."""


class ControllerRow(msgspec.Struct, frozen=True):
    """One candidate along one drive, in the steps in which the driver wanted torque.

    ``deviation_nm`` is the largest from the exact solver's answers: None where
    there is no such solver.  ``cost`` is None where the candidate is not installed.
    """

    law: str
    preset: str
    code: str
    manoeuvre: str
    cost: Cost | None
    deviation_nm: float | None
    paper: SolveTime | None


def measure_controllers(effort: Effort, progress: Progress) -> list[ControllerRow]:
    """Replay both manoeuvres through everybody."""
    work = [(m, c) for m in MANOEUVRES for c in candidates()]
    exact: dict[tuple[str, str], NDArray[np.float64]] = {}
    rows = []
    for done, (manoeuvre, candidate) in enumerate(work):
        progress(done / len(work), f"{candidate.kind.name} by {candidate.code}, {manoeuvre}")
        questions = drive_of(manoeuvre, candidate.kind.name, candidate.preset).questions
        cost, answers = _asked(candidate, questions[: effort.questions], effort.repeats)
        if candidate.is_exact:
            exact[manoeuvre, candidate.kind.name] = answers
        truth = exact[manoeuvre, candidate.kind.name] if candidate.preset == "paper" else None
        rows.append(_row(candidate, manoeuvre, cost, _deviation_nm(answers, truth)))
    return rows


@cache
def drive_of(manoeuvre: str, law: str, preset: PresetName) -> Drive:
    """The drive that a law of a preset makes of a manoeuvre."""
    control = ControlSettings(preset=preset)
    config = ServiceConfig(controller=law.lower(), control=control)  # type: ignore[arg-type]
    return record_drive(manoeuvre, config)


def _asked(
    candidate: Candidate, questions: Sequence[Question], repeats: int
) -> tuple[Cost | None, NDArray[np.float64]]:
    """What the answers cost, and the answers (n,) in Nm; none from who is not there."""
    if candidate.make is None:
        return None, np.empty(0)
    watch = Stopwatch()
    with warnings.catch_warnings(), quiet_collector():
        warnings.simplefilter("ignore")  # what peers say about their own dependencies
        for _ in range(repeats if candidate.ours else 1):
            answers = _answers(candidate.make, questions, watch)
    return watch.cost, answers


def _answers(
    make: Callable[[], Controller], questions: Sequence[Question], watch: Stopwatch
) -> NDArray[np.float64]:
    """`replay`, but Ctrl-C waits for the end of a part: CasADi takes it for a failed step."""
    with uninterrupted():
        controller = make()
    parts = []
    for first in range(0, len(questions), PART):
        with uninterrupted():
            parts.append(replay(controller, questions[first : first + PART], watch))
    return np.concatenate(parts)


def replay(
    controller: Controller, questions: Sequence[Question], watch: Stopwatch
) -> NDArray[np.float64]:
    """Ask a fresh controller everything in order; its answers (n,) in Nm."""
    answers = np.empty(len(questions))
    for index, (wheel, torque_ref_nm) in enumerate(questions):
        if torque_ref_nm <= 0.0:  # decided without solving anything
            answers[index] = controller.step(wheel, torque_ref_nm).torque_nm
            continue
        watch.start()
        proposal = controller.step(wheel, torque_ref_nm)
        watch.stop()
        answers[index] = proposal.torque_nm
    return answers


def _deviation_nm(answers: NDArray[np.float64], truth: NDArray[np.float64] | None) -> float | None:
    if truth is None or not len(answers):
        return None
    return float(np.abs(answers - truth).max())


def _row(
    candidate: Candidate, manoeuvre: str, cost: Cost | None, deviation_nm: float | None
) -> ControllerRow:
    law, preset = candidate.kind.name, candidate.preset
    paper = SOLVE_TIMES.get((manoeuvre, law.lower())) if preset == "paper" else None
    return ControllerRow(law, preset, candidate.code, manoeuvre, cost, deviation_nm, paper)
