"""Where a guest runs on the host: a folder for its memory, a processor, a session to end."""

from __future__ import annotations

import os
import signal
import tempfile
import time
from pathlib import Path

_HEADROOM_RATIO = 1.05
_OBSERVED_S = 0.05


def memory_folder(size_bytes: int) -> str:
    """A folder with room for the guest's memory, which is an unlinked file.

    A file in memory is best, but containers often give /dev/shm only 64 MB, and a guest that
    outgrows its file dies of SIGBUS.
    """
    for folder in ("/dev/shm", tempfile.gettempdir()):  # noqa: S108 - UML's own default
        if not Path(folder).is_dir():
            continue
        state = os.statvfs(folder)
        room_bytes = state.f_bavail * state.f_frsize
        if room_bytes > _HEADROOM_RATIO * size_bytes and not state.f_flag & os.ST_NOEXEC:
            return folder
    return "/var/tmp"  # noqa: S108


def idlest_processor() -> int:
    """The processor, among those this process may use, that idled most just now.

    A guest has one processor and hops between host processes at each of its system calls; kept
    on one processor of the host such a call costs a quarter.
    """
    before = _idle_ticks()
    time.sleep(_OBSERVED_S)
    after = _idle_ticks()
    return max(os.sched_getaffinity(0), key=lambda cpu: after.get(cpu, 0) - before.get(cpu, 0))


def _idle_ticks() -> dict[int, int]:
    rows = (line.split() for line in Path("/proc/stat").read_text().splitlines())
    return {int(row[0][3:]): int(row[4]) for row in rows if row[0][3:].isdigit()}


def kill_session(session: int) -> None:
    """Kill every process of a session: a guest has helpers beside its first process."""
    while members := [pid for pid in _processes() if _is_alive_in(session, pid)]:
        for pid in members:
            try:
                os.kill(pid, signal.SIGKILL)
            except ProcessLookupError:
                continue
        time.sleep(0.005)


def _processes() -> list[int]:
    return [int(entry.name) for entry in Path("/proc").iterdir() if entry.name.isdigit()]


def _is_alive_in(session: int, pid: int) -> bool:
    try:
        # The name in parentheses may hold anything; the fields behind it are fixed.
        fields = Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()
    except (FileNotFoundError, ProcessLookupError):
        return False
    state, member_of = fields[0], int(fields[3])
    return member_of == session and state not in "ZX"
