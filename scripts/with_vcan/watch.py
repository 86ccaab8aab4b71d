"""Sees a command in a guest through: its output, the signals meant for it, its time limit."""

from __future__ import annotations

import math
import os
import signal
import socket
import subprocess
import sys
import time
from pathlib import Path

from . import job

LOG = "log"  # the guest kernel's messages, in the shared folder

_BOOT_LIMIT_S = 60.0
_GRACE_S = 3.0  # between one way to end the command and the next, firmer one
_POLL_S = 0.01
_LOG_LINES = 40
_ENOUGH = 3  # a guest that ignores so many interrupts is ended itself
_INTERRUPTS = (signal.SIGINT, signal.SIGTERM)
_FORWARDED = (*_INTERRUPTS, signal.SIGHUP, signal.SIGQUIT, signal.SIGUSR1, signal.SIGUSR2)
_AWAITED = (*_FORWARDED, signal.SIGCHLD)


class Watch:
    """Watches one guest from its first instruction to its last."""

    def __init__(self, guest: subprocess.Popen[bytes], folder: Path, line: socket.socket) -> None:
        self._guest = guest
        self._folder = folder
        self._line = line
        self._outputs = [
            ((folder / name).open("rb", buffering=0), descriptor)
            for descriptor, name in ((1, job.STDOUT), (2, job.STDERR))
        ]
        self._interrupts = 0
        self._verdict: int | None = None  # stands above the command's own status

    def see_through(self, timeout_s: float | None) -> int:
        """Stream output and forward signals until the guest has switched itself off.

        Args:
            timeout_s: how long the command may run on the host's clock, once the guest is up.

        Returns:
            The exit status to pass on; where the guest failed its log goes to stderr.
        """
        signal.pthread_sigmask(signal.SIG_BLOCK, _AWAITED)
        try:
            self._boot()
            self._serve(timeout_s)
            self._copy_output()
        except BrokenPipeError:
            self._end_guest(128 + signal.SIGPIPE)
        status = self._reported_status() if self._verdict is None else self._verdict
        if status == job.NO_PLACE:
            log = (self._folder / LOG).read_text(errors="replace").splitlines()
            print("with-vcan: the guest failed", *log[-_LOG_LINES:], sep="\n  ", file=sys.stderr)
        return status

    def _reported_status(self) -> int:
        try:
            return int((self._folder / job.STATUS).read_text())
        except (FileNotFoundError, ValueError):
            return job.NO_PLACE

    def _boot(self) -> None:
        limit_s = time.monotonic() + _BOOT_LIMIT_S
        while self._turn() and not self._is_up():
            if time.monotonic() > limit_s:
                self._end_guest(job.NO_PLACE)

    def _serve(self, timeout_s: float | None) -> None:
        deadline_s = math.inf if timeout_s is None else time.monotonic() + timeout_s
        ways = iter((signal.SIGTERM, signal.SIGKILL))
        while self._turn():
            if time.monotonic() < deadline_s:
                continue
            if self._verdict is None:
                print(f"with-vcan: timeout after {timeout_s:g} s", file=sys.stderr)
            if way := next(ways, None):
                self._verdict = job.TIMED_OUT
                self._line.send(bytes([way]))
            else:
                self._end_guest(job.TIMED_OUT)
            deadline_s = time.monotonic() + _GRACE_S

    def _turn(self) -> bool:
        """Copy what was written, wait a moment or for a signal; False once the guest is gone."""
        self._copy_output()
        arrived = signal.sigtimedwait(_AWAITED, _POLL_S)
        if arrived is not None and arrived.si_signo in _FORWARDED:
            self._forward(arrived.si_signo)
        return self._guest.poll() is None

    def _forward(self, number: int) -> None:
        self._interrupts += number in _INTERRUPTS
        if self._interrupts >= _ENOUGH or not self._is_up():
            self._end_guest(128 + number)
        else:
            self._line.send(bytes([number]))

    def _is_up(self) -> bool:
        return (self._folder / job.READY).exists()

    def _end_guest(self, verdict: int) -> None:
        self._verdict = verdict
        self._guest.kill()

    def _copy_output(self) -> None:
        for source, descriptor in self._outputs:
            while chunk := source.read(1 << 16):
                while chunk:
                    chunk = chunk[os.write(descriptor, chunk) :]
