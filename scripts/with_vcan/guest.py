"""PID 1 of the guest: prepares root and vcan0, runs the command, reports its status.

Started by the kernel as `python guest_init.py FOLDER`, with the host's root as its own.
"""

from __future__ import annotations

import os
import signal
import threading
import time
import traceback
import tty
from pathlib import Path

from . import interface, job, root
from .kernelcalls import mount, power_off

_GRACE_S = 1.0  # for what the command left running, between TERM and KILL
_SIGNAL_LINE = "/dev/tty1"  # each byte that arrives here is the number of a signal


def main(shared: Path) -> None:
    """Run the job of the shared folder and switch the machine off, whatever happens."""
    status = job.NO_PLACE
    try:
        task = _prepare(shared)
        shared = root.SHARED
        status = _run(task, shared)
    except Exception:  # noqa: BLE001 - nobody is above PID 1 to catch it
        Path("/dev/kmsg").write_text(traceback.format_exc())
    finally:
        (shared / job.STATUS).write_text(str(status))
        power_off()


def _prepare(shared: Path) -> job.Job:
    mount("proc", "/proc", "proc")
    task = job.load(shared)
    if task.modules is not None:
        root.load_modules(task.modules)
    root.switch(shared, task.writable)
    interface.create_vcan("vcan0")
    for name in ("lo", "vcan0"):
        interface.set_up(name)
    return task


def _run(task: job.Job, shared: Path) -> int:
    line = os.open(_SIGNAL_LINE, os.O_RDONLY | os.O_NOCTTY)
    tty.setraw(line)
    (shared / job.READY).touch()
    command = os.fork()
    if command == 0:
        os._exit(_become(task, shared))
    threading.Thread(target=_forward_signals, args=(line, command), daemon=True).start()
    status = _wait_for(command)
    _end_everything()
    return status


def _become(task: job.Job, shared: Path) -> int:
    os.setsid()
    streams = (
        os.open(os.devnull, os.O_RDONLY),
        os.open(shared / job.STDOUT, os.O_WRONLY | os.O_APPEND),
        os.open(shared / job.STDERR, os.O_WRONLY | os.O_APPEND),
    )
    for number, stream in enumerate(streams):
        os.dup2(stream, number)
    # Python ignores these two; what it starts should find them as a shell would leave them.
    for number in (signal.SIGPIPE, signal.SIGXFSZ):
        signal.signal(number, signal.SIG_DFL)
    try:
        os.chdir(task.cwd)
    except OSError as error:
        os.write(2, f"with-vcan: {task.cwd}: {error.strerror}\n".encode())
        return job.NOT_EXECUTABLE
    return job.execute(task.argv, task.env)


def _forward_signals(line: int, group: int) -> None:
    while number := os.read(line, 1):
        try:
            os.killpg(group, number[0])
        except ProcessLookupError:
            return


def _wait_for(command: int) -> int:
    while True:  # PID 1 also reaps what others left behind
        pid, status = os.wait()
        if pid == command:
            code = os.waitstatus_to_exitcode(status)
            return code if code >= 0 else 128 - code


def _end_everything() -> None:
    deadline = time.monotonic() + _GRACE_S
    try:
        os.kill(-1, signal.SIGTERM)
        while time.monotonic() < deadline:
            if os.waitpid(-1, os.WNOHANG) == (0, 0):
                time.sleep(0.01)
        os.kill(-1, signal.SIGKILL)
    except (ProcessLookupError, ChildProcessError):
        return  # nobody is left
