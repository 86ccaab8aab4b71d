"""Many simulated runs on every core; each is judged where it ran, and only its score comes back."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass

from plant_emulator.scenario import Scenario
from tcs_hil.hil.metrics import Score, score
from tcs_hil.hil.processes.program import spawned
from tcs_hil.hil.simulation import simulate
from tcs_hil.service.settings import ServiceConfig

Progress = Callable[[float, str], None]


@dataclass(frozen=True, slots=True)
class Job:
    """One run: a name to show, what happens and which service meets it."""

    name: str
    scenario: Scenario
    config: ServiceConfig


def judge(job: Job) -> Score:
    """Drive one job to its end and judge it.

    Raises:
        TcsError: the job's configuration cannot be used.
    """
    truth = simulate(job.scenario, job.config).truth
    control = job.config.control
    return score(truth, job.scenario, control.slip_reference, job.config.vehicle)


def judge_all(jobs: Sequence[Job], progress: Progress, processes: int | None = None) -> list[Score]:
    """Judge every job, in their order, by ``processes`` at a time (one per core without).

    ``progress`` hears of the share done and the job that was last finished.  What
    a job raises is raised here.
    """
    with spawned(processes or os.cpu_count() or 1) as pool:
        return list(_reported(jobs, pool.imap(judge, jobs), progress))


def _reported(jobs: Sequence[Job], scores: Iterator[Score], progress: Progress) -> Iterator[Score]:
    for done, (job, judged) in enumerate(zip(jobs, scores, strict=True), 1):
        progress(done / len(jobs), job.name)
        yield judged
