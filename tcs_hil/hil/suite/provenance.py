"""What a suite was run with, beside what came of it."""

from __future__ import annotations

import platform
import sys
from collections.abc import Sequence
from datetime import datetime
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

from tcs_hil.hil.machine import describe_machine
from tcs_hil.hil.suite.result import Result, SuiteResult

PACKAGES = ("tcs-hil", "python-can", "cantools", "numpy", "osqp", "casadi", "numba")


def sum_up(title: str, results: Sequence[Result], started: datetime, jobs: int = 1) -> SuiteResult:
    """Results with the command, the machine and the versions of this process; it ends now."""
    return SuiteResult(
        title=title,
        command=" ".join([Path(sys.argv[0]).name, *sys.argv[1:]]),
        started=started.isoformat(timespec="seconds"),
        machine=describe_machine(),
        versions=versions(),
        jobs=jobs,
        wall_s=(datetime.now().astimezone() - started).total_seconds(),
        results=list(results),
    )


def versions() -> dict[str, str]:
    """Versions of this package, of Python and of what the figures may depend on."""
    return {"python": platform.python_version()} | {name: _version(name) for name in PACKAGES}


def _version(name: str) -> str:
    try:
        return version(name)
    except PackageNotFoundError:
        return "not installed"  # run from a checkout
