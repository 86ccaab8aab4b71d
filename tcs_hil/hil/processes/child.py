"""A program of the bench, in the process forked off for it."""

from __future__ import annotations

import fcntl
import multiprocessing
import os
import runpy
import select
import signal
import sys
from collections.abc import Sequence
from pathlib import Path


def run_module(
    arguments: Sequence[str], log: Path, folder: Path, environment: dict[str, str]
) -> None:
    """Be ``python -m arguments...`` in ``folder``, all output to ``log``."""
    _end_with_the_bench()
    output = os.open(log, os.O_WRONLY | os.O_CREAT | os.O_TRUNC, 0o666)
    os.dup2(output, sys.stdout.fileno())
    os.dup2(output, sys.stderr.fileno())
    os.close(output)
    os.chdir(folder)
    os.environ.clear()
    os.environ.update(environment)
    sys.argv = list(arguments)
    runpy.run_module(sys.argv[0], run_name="__main__", alter_sys=True)


def _end_with_the_bench() -> None:
    """A bench that is killed outright cannot stop its programs: let the kernel do it.

    The pipe from the bench hangs up with it, and the kernel makes a SIGTERM of that.
    """
    bench = multiprocessing.parent_process()
    if bench is None:
        return
    pipe = bench.sentinel
    fcntl.fcntl(pipe, fcntl.F_SETOWN, os.getpid())
    fcntl.fcntl(pipe, fcntl.F_SETSIG, signal.SIGTERM)
    fcntl.fcntl(pipe, fcntl.F_SETFL, fcntl.fcntl(pipe, fcntl.F_GETFL) | os.O_ASYNC)
    if select.select([pipe], [], [], 0.0)[0]:  # it has gone already
        signal.raise_signal(signal.SIGTERM)
