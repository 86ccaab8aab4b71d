"""Driving the cases of a suite, several at a time, each judged where it was driven."""

from __future__ import annotations

import os
import time
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor, as_completed
from concurrent.futures.process import BrokenProcessPool
from dataclasses import dataclass
from multiprocessing import active_children
from pathlib import Path

import numpy as np
from msgspec import structs

from tcs_hil.canbus.bus import open_bus
from tcs_hil.errors import ConfigError, TcsError
from tcs_hil.hil.judging.evidence import Evidence
from tcs_hil.hil.judging.measured import CannotJudgeError
from tcs_hil.hil.judging.of_run import RUN_METRICS, Stretch, stretch
from tcs_hil.hil.judging.verdict import Finding, Verdict, overall
from tcs_hil.hil.processes.interruption import uninterrupted
from tcs_hil.hil.processes.program import ProcessError, fork_server
from tcs_hil.hil.report import picture
from tcs_hil.hil.run import Mode, RunPlan, execute
from tcs_hil.hil.suite.case import Case
from tcs_hil.hil.suite.result import CLOCKED_FIGURES, FIGURES, Result
from tcs_hil.service.settings import BusSettings

Progress = Callable[[float, str], None]


@dataclass(frozen=True, slots=True)
class Bench:
    """Where and at which pace cases are driven; ``folder`` keeps what they leave.

    Without a ``channel`` every worker has an embedded bus of its own.
    """

    mode: Mode
    folder: Path
    interface: str = "auto"
    channel: str | None = None
    bitrate: int | None = None

    def jobs(self, wanted: int | None) -> int:
        """How many cases to drive at a time.

        Raises:
            ConfigError: more than one is wanted on one bus.
        """
        shared = self.channel is not None and self.mode != "in-process"
        if shared and wanted is not None and wanted > 1:
            raise ConfigError(f"cases on {self.channel} are driven one after another: no -j")
        if shared or self.mode == "real-time":
            return wanted or 1  # side by side they would disturb each other's clock
        return wanted or os.cpu_count() or 1

    def check_bus(self) -> None:
        """Open the bus once where it is a given one: what is misspelt must not cost a run.

        Raises:
            BusError: it cannot be opened.
        """
        if self.channel is not None and self.mode != "in-process":
            open_bus(self.interface, self.channel, self.bitrate)[0].shutdown()

    def bus(self, worker: str) -> BusSettings:
        """The bus of one worker."""
        if self.channel is None:
            return BusSettings(interface="embedded", channel=f"vcan-hil-{worker}")
        return BusSettings(interface=self.interface, channel=self.channel, bitrate=self.bitrate)

    def case_folder(self, case: str) -> Path:
        """Where the files of a case are kept."""
        return self.folder / "runs" / case


def run_cases(cases: Sequence[Case], bench: Bench, jobs: int, progress: Progress) -> list[Result]:
    """Drive every case, ``jobs`` at a time; results are in the order of ``cases``.

    ``progress`` hears of the share done and the case that was last finished.

    Raises:
        ProcessError: a worker was killed.
    """
    pool = ProcessPoolExecutor(jobs, mp_context=fork_server())
    try:
        with uninterrupted():
            tasks = [pool.submit(run_case, case, bench) for case in cases]
        for done, task in enumerate(as_completed(tasks), 1):
            result = task.result()
            progress(done / len(tasks), f"{result.name} {result.verdict}")
        return [task.result() for task in tasks]
    except BrokenProcessPool as error:
        raise ProcessError("a worker was killed, perhaps for want of memory: try -j 1") from error
    except KeyboardInterrupt:
        for worker in active_children():  # their programs end with them
            worker.terminate()
        raise
    finally:
        pool.shutdown(cancel_futures=True)


def run_case(case: Case, bench: Bench) -> Result:
    """Drive one case and judge it; a run that does not come about is blocked."""
    begun_s = time.monotonic()
    try:
        findings, figures = _driven(case, bench)
        error = ""
    except TcsError as failure:
        findings, figures, error = [], {}, str(failure)
    return Result(
        name=case.name,
        suite=case.suite,
        description=case.scenario.description,
        controller=case.config.controller,
        preset=case.config.control.preset,
        mode=bench.mode,
        verdict=Verdict.BLOCKED if error else overall(each.verdict for each in findings),
        findings=findings,
        figures=figures,
        wall_s=time.monotonic() - begun_s,
        error=error,
    )


def _driven(case: Case, bench: Bench) -> tuple[list[Finding], dict[str, float | None]]:
    bus = structs.replace(bench.bus(str(os.getpid())), database=case.config.bus.database)
    config = structs.replace(case.config, bus=bus)
    plan = RunPlan(case.scenario, config, bench.mode, bench.case_folder(case.name))
    evidence = Evidence(execute(plan), case.scenario, config, bench.mode)
    picture.save(picture.take(evidence), plan.folder)
    return case.judge(evidence), dict(_figures(evidence))


def _figures(evidence: Evidence) -> Iterator[tuple[str, float | None]]:
    whole = stretch(evidence, 0.0, np.inf)
    for name in FIGURES + (CLOCKED_FIGURES if evidence.clocked else ()):
        yield name, _measured(name, whole)


def _measured(name: str, run: Stretch) -> float | None:
    try:
        return RUN_METRICS[name].measure(run).value
    except CannotJudgeError:
        return None
