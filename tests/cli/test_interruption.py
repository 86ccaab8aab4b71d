"""Ctrl-C before a command has found its feet: status 130, nothing said, nobody left behind."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import suppress
from pathlib import Path

import pytest

PATIENCE_S = 60.0  # a busy machine loads everything three times
AWAITED = "*awaited*"
# Python imports it at its start, in every process: tells when one of a kind comes to a module, and
# waits there for the signal where that is the process which must end of it.
SITE = f"""
import os, signal, sys

class Watch:
    def find_spec(self, name, path, target=None):
        if name == os.environ["AWAITED_MODULE"] and os.environ["AWAITED_KIND"] in sys.orig_argv[-1]:
            sys.meta_path.remove(self)
            os.write(2, b"{AWAITED}\\n")
            if "-m" in sys.orig_argv:
                signal.pause()

sys.meta_path.insert(0, Watch())
"""
STUDY = """
scenario = "manoeuvre-1"
points = 8
[[vary]]
key = "road.0.mu"
low = 0.2
high = 0.4
"""
COMMANDS = {
    "hil": ["hil", "manoeuvre-1", "--controller", "pi"],
    "demo": ["demo"],
    "campaign": ["campaign", "study.toml", "-j", "1"],
    "bench": ["bench", "--quick", "--only", "bus"],
    "run": ["run", "--interface", "embedded", "--channel", "vcan-interrupted"],
}


class Interrupted:
    """A command and all it starts, told to end when one of them comes to a module."""

    def __init__(self, folder: Path, command: str, module: str, kind: str) -> None:
        (folder / "sitecustomize.py").write_text(SITE)
        (folder / "study.toml").write_text(STUDY)
        path = os.pathsep.join([str(folder), str(Path.cwd())])
        told = {"AWAITED_MODULE": module, "AWAITED_KIND": kind, "PYTHONPATH": path}
        self._child = subprocess.Popen(
            [sys.executable, "-m", "tcs_hil", *COMMANDS[command]],
            stdout=subprocess.DEVNULL,
            stderr=subprocess.PIPE,
            text=True,
            cwd=folder,
            env=os.environ | told,
            start_new_session=True,
        )

    def end(self) -> tuple[int, list[str]]:
        """Send the signal as a terminal does, to all; the status and what was said from then on."""
        assert self._child.stderr is not None
        while AWAITED not in (line := self._child.stderr.readline()):
            assert line, "it ended before"
        os.killpg(self._child.pid, signal.SIGINT)
        _, error = self._child.communicate(timeout=PATIENCE_S)
        return self._child.returncode, error.split("\n")

    def await_nobody(self) -> None:
        """Return once no process of the group lives; whoever helped multiprocessing is last."""
        deadline_s = time.monotonic() + PATIENCE_S
        with suppress(ProcessLookupError):
            while True:
                os.killpg(self._child.pid, 0)
                assert time.monotonic() < deadline_s, "somebody was left behind"
                time.sleep(0.01)  # a group has to be looked at: nobody tells of its end

    def clean_up(self) -> None:
        with suppress(ProcessLookupError):
            os.killpg(self._child.pid, signal.SIGKILL)
        self._child.communicate()


@pytest.fixture
def interrupted(tmp_path: Path) -> Iterator[Callable[..., Interrupted]]:
    started: list[Interrupted] = []

    def start(command: str, module: str, kind: str) -> Interrupted:
        started.append(Interrupted(tmp_path, command, module, kind))
        return started[-1]

    yield start
    for each in started:
        each.clean_up()


@pytest.mark.parametrize("module", ["click", "the command"])
@pytest.mark.parametrize("command", COMMANDS)
def test_while_it_loads_a_command_ends_without_a_word(
    interrupted: Callable[..., Interrupted], command: str, module: str
) -> None:
    awaited = f"tcs_hil.cli.{command}" if module == "the command" else module
    program = interrupted(command, awaited, kind=COMMANDS[command][-1])
    assert program.end() == (130, [""])
    program.await_nobody()


@pytest.mark.parametrize(
    ("command", "module", "kind"),
    [
        ("hil", "tcs_hil.hil.processes.warm", "forkserver"),
        ("demo", "tcs_hil.hil.processes.warm", "forkserver"),
        ("campaign", "distributed", "--multiprocessing-fork"),
    ],
)
def test_while_its_processes_start_a_command_ends_with_at_most_a_line(
    interrupted: Callable[..., Interrupted], command: str, module: str, kind: str
) -> None:
    program = interrupted(command, module, kind)
    status, said = program.end()
    assert status == 130
    assert len([line for line in said if line]) <= 1, said
    program.await_nobody()
