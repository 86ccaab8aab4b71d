"""Starting and stopping the programs of a run; readiness through sd_notify, as under systemd.

Programs are forked off a server that has imported and compiled everything, so
that a suite of many short runs does not spend its time on starting Python.
"""

from __future__ import annotations

import multiprocessing
import os
import socket
import tempfile
from collections.abc import Iterator, Sequence
from contextlib import ExitStack, contextmanager
from multiprocessing.context import ForkServerContext
from multiprocessing.pool import Pool
from pathlib import Path

from tcs_hil.errors import TcsError
from tcs_hil.hil.processes.child import run_module
from tcs_hil.hil.processes.interruption import uninterrupted

READY_TIMEOUT_S = 60.0
STOP_TIMEOUT_S = 10.0
PRELOADED = (
    "tcs_hil.hil.processes.warm",
    "tcs_hil.cli.run",
    "tcs_hil.cli.record",
    "plant_emulator.cli",
)
"""Modules imported before any program is forked off; the programs by name, as they are started."""


class ProcessError(TcsError):
    """A program of the bench ended early or would not start."""


def fork_server() -> ForkServerContext:
    """The context of processes that start with everything loaded."""
    context = multiprocessing.get_context("forkserver")
    context.set_forkserver_preload(list(PRELOADED))
    return context


@contextmanager
def spawned(processes: int) -> Iterator[Pool]:
    """Processes that start afresh: solvers and compiled code must not inherit half a state."""
    with ExitStack() as cleanup:
        with uninterrupted():
            pool = cleanup.enter_context(multiprocessing.get_context("spawn").Pool(processes))
        yield pool


class Program:
    """A running child; its output goes to ``log``, which an error quotes the end of."""

    def __init__(self, arguments: Sequence[str], log: Path, environment: dict[str, str]) -> None:
        self._name = " ".join(arguments[:2])
        self._log = log
        log.write_bytes(b"")
        self._process = fork_server().Process(
            target=run_module,
            args=(arguments, log.absolute(), Path.cwd(), dict(os.environ) | environment),
            daemon=True,
        )
        self._process.start()

    def wait(self, timeout_s: float) -> None:
        """Wait for an end of its own accord.

        Raises:
            ProcessError: it failed, or still runs after ``timeout_s``.
        """
        self._process.join(timeout_s)
        if self.running:
            raise ProcessError(f"{self._name} still runs after {timeout_s:g} s")
        if self._process.exitcode != 0:
            raise self.failure(f"ended with status {self._process.exitcode}")

    def end(self) -> None:
        """Stop it as a matter of course.

        Raises:
            ProcessError: it had already failed, or failed in stopping.
        """
        self.stop()
        if self._process.exitcode != 0:
            raise self.failure(f"ended with status {self._process.exitcode}")

    def stop(self) -> None:
        """Ask it to stop and wait until it has; a program that will not is killed."""
        if not self.running:
            return
        self._process.terminate()
        self._process.join(STOP_TIMEOUT_S)
        if self.running:
            self._process.kill()
            self._process.join()

    @property
    def running(self) -> bool:
        """Whether it has not ended yet."""
        return self._process.is_alive()

    def failure(self, what: str) -> ProcessError:
        """An error that quotes the last line the program printed."""
        lines = self._log.read_text(errors="replace").strip().splitlines()
        return ProcessError(f"{self._name} {what}: {lines[-1] if lines else 'it printed nothing'}")


@contextmanager
def program(*arguments: str, log: Path) -> Iterator[Program]:
    """Start ``python -m arguments...``, wait until it reports READY=1, stop it at the end.

    Raises:
        ProcessError: it ended or kept silent before it was ready, or failed later.
    """
    with ExitStack() as cleanup:
        folder = cleanup.enter_context(tempfile.TemporaryDirectory(prefix="tcs-hil."))
        address = str(Path(folder) / "notify")
        listener = cleanup.enter_context(socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM))
        listener.bind(address)
        with uninterrupted():  # the first one waits for the server, which would start it later
            child = Program(arguments, log, {"NOTIFY_SOCKET": address})
            cleanup.callback(child.stop)
        _await_ready(child, listener)
        yield child
        child.end()


def _await_ready(child: Program, listener: socket.socket) -> None:
    listener.settimeout(0.1)
    for _ in range(int(READY_TIMEOUT_S / 0.1)):
        try:
            if b"READY=1" in listener.recv(4096).split(b"\n"):
                return
        except TimeoutError:
            if not child.running:
                raise child.failure("ended before it was ready") from None
    raise child.failure(f"was not ready within {READY_TIMEOUT_S:g} s")
