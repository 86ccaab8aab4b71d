"""Boots a User-Mode-Linux guest, an ordinary process on the host's own files."""

from __future__ import annotations

import os
import socket
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

from . import job, place
from .kernels import Kernel
from .watch import LOG, Watch

_SCRIPTS = Path(__file__).resolve().parent.parent
_MEMORY_BYTES = 2 << 30  # numpy, casadi and numba in a few processes; only what is touched is used
_SIMULATED_START_NS = 1_700_000_000 * 10**9  # any fixed moment, so that runs repeat


@dataclass(frozen=True)
class Wishes:
    """How the guest runs: its kernel, simulated time or not, host seconds the command may take."""

    kernel: Kernel
    simulated_time: bool
    timeout_s: float | None


def run(task: job.Job, wishes: Wishes) -> int:
    """Run the task in a guest of its own.

    Returns:
        The command's status, 128 + N after signal N, or one of `job`'s constants.
    """
    folder = Path(tempfile.mkdtemp(prefix="with-vcan."))
    task.save(folder)
    for stream in (job.STDOUT, job.STDERR):
        (folder / stream).touch()
    with _booted(folder, wishes) as watch:
        return watch.see_through(wishes.timeout_s)


@contextmanager
def _booted(folder: Path, wishes: Wishes) -> Iterator[Watch]:
    ours, guests = socket.socketpair()
    with ours, guests, (folder / LOG).open("wb") as log, _one_processor():
        process = subprocess.Popen(
            [wishes.kernel.path, *_kernel_arguments(folder, wishes, guests.fileno(), log.fileno())],
            stdin=subprocess.DEVNULL,
            stdout=log,
            stderr=log,
            pass_fds=[guests.fileno(), log.fileno()],
            env={**os.environ, "TMPDIR": place.memory_folder(_MEMORY_BYTES)},
            cwd=folder,
            start_new_session=True,  # Ctrl-C is for the command, not for its kernel
        )
        reaper = _start_reaper(process.pid, folder)
        try:
            yield Watch(process, folder, ours)
        finally:
            process.kill()
            process.wait()
            place.kill_session(process.pid)
            reaper.communicate()


def _kernel_arguments(folder: Path, wishes: Wishes, line: int, log: int) -> list[str]:
    arguments = [
        "rootfstype=hostfs",
        "rootflags=/",
        "ro",
        f"mem={_MEMORY_BYTES >> 20}M",
        "uml_dir=./",
        "umid=guest",
        f"con0=null,fd:{log}",
        f"con1=fd:{line},fd:{line}",
        "con=null",
        "ssl=null",
        "noreboot",
        "panic=-1",
        "random.trust_cpu=1",  # else the first getrandom() waits for entropy
    ]
    if wishes.simulated_time:
        arguments += ["time-travel=inf-cpu", f"time-travel-start={_SIMULATED_START_NS}"]
    # What follows `--` goes to init; quotes keep a path with blanks together.
    python = os.path.realpath(sys.executable)
    init = f'init="{python}"', "--", "-ESs", f'"{_SCRIPTS / "guest_init.py"}"', f'"{folder}"'
    return [*arguments, *init]


@contextmanager
def _one_processor() -> Iterator[None]:
    """Keep what is started inside on one processor."""
    allowed = os.sched_getaffinity(0)
    os.sched_setaffinity(0, {place.idlest_processor()})
    try:
        yield
    finally:
        os.sched_setaffinity(0, allowed)


def _start_reaper(session: int, folder: Path) -> subprocess.Popen[bytes]:
    """A process that ends the guest and removes its folder when this one is done, or killed."""
    return subprocess.Popen(
        [sys.executable, "-ESs", _SCRIPTS / "guest_reaper.py", str(session), folder],
        stdin=subprocess.PIPE,
        start_new_session=True,
    )
