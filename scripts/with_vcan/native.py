"""A network namespace of the running kernel with a vcan0 of its own, where the kernel can."""

from __future__ import annotations

import os
import socket
from pathlib import Path

from . import interface, job, kernelcalls


def available() -> bool:
    """Whether `enter` would work; tried in a child, which takes the namespace with it."""
    child = os.fork()
    if child == 0:
        try:
            enter()
            os._exit(0)
        finally:
            os._exit(1)
    return os.waitpid(child, 0)[1] == 0


def run(task: job.Job, timeout_s: float | None) -> int:
    """Become the command, inside the namespace; returns only if it cannot be executed."""
    enter()
    limit = [] if timeout_s is None else ["timeout", "--kill-after=3", str(timeout_s)]
    os.chdir(task.cwd)
    return job.execute(limit + task.argv, task.env)


def enter() -> None:
    """Move this process into a new network namespace with `vcan0` and `lo` up.

    Raises:
        OSError: the kernel has no CAN, or this user may not have a namespace.
    """
    _new_network()
    interface.create_vcan("vcan0")
    for name in ("lo", "vcan0"):
        interface.set_up(name)
    with socket.socket(socket.AF_CAN, socket.SOCK_RAW, socket.CAN_RAW) as probe:
        probe.bind(("vcan0",))


def _new_network() -> None:
    try:
        kernelcalls.unshare(kernelcalls.CLONE_NEWNET)
    except PermissionError:
        user, group = os.geteuid(), os.getegid()
        kernelcalls.unshare(kernelcalls.CLONE_NEWUSER | kernelcalls.CLONE_NEWNET)
        # The kernel takes a group map from an ordinary user only after setgroups is given up.
        Path("/proc/self/setgroups").write_text("deny")
        Path("/proc/self/uid_map").write_text(f"0 {user} 1")
        Path("/proc/self/gid_map").write_text(f"0 {group} 1")
