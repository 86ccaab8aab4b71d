"""What the operating system lets this user have."""

from __future__ import annotations

import resource

from tcs_hil.canbus.bus import RECEIVE_BUFFER_BYTES
from tcs_hil.runtime.doctor.finding import Finding, ok, warn
from tcs_hil.runtime.doctor.machine import Machine
from tcs_hil.runtime.realtime import FIFO_PRIORITY

CAP_NET_ADMIN, CAP_IPC_LOCK, CAP_SYS_NICE = 12, 14, 23  # linux/capability.h
MEMORY_BYTES = 1 << 30  # more than the service and its recording ever map


def realtime_priority(machine: Machine) -> Finding:
    """SCHED_FIFO, which needs a limit and no privilege."""
    what, limit = "real-time priority", machine.limit(resource.RLIMIT_RTPRIO)
    if _has_capability(machine, CAP_SYS_NICE):
        return ok(what, "unlimited (CAP_SYS_NICE)")
    if limit >= FIFO_PRIORITY:
        return ok(what, f"up to {limit:g}")
    return warn(
        what,
        f"up to {limit:g}, {FIFO_PRIORITY} is wanted",
        "sudo prlimit --pid $$ --rtprio=60, or LimitRTPRIO=60 in the unit",
    )


def locked_memory(machine: Machine) -> Finding:
    """Memory that is never paged out."""
    what, limit = "locked memory", machine.limit(resource.RLIMIT_MEMLOCK)
    if _has_capability(machine, CAP_IPC_LOCK):
        return ok(what, "unlimited (CAP_IPC_LOCK)")
    if limit >= MEMORY_BYTES:
        return ok(what, "unlimited" if limit == float("inf") else f"{limit / 1e6:.0f} MB")
    return warn(
        what,
        f"{limit / 1e6:.0f} MB",
        "sudo prlimit --pid $$ --memlock=unlimited, or LimitMEMLOCK=infinity in the unit",
    )


def receive_buffer(machine: Machine) -> Finding:
    """How many frames wait while the service is held up."""
    what, text = "socket buffer", machine.read("/proc/sys/net/core/rmem_max")
    if _has_capability(machine, CAP_NET_ADMIN):
        return ok(what, "as large as wanted (CAP_NET_ADMIN)")
    if text is None:
        return ok(what, "unknown")
    if int(text) >= RECEIVE_BUFFER_BYTES:
        return ok(what, f"up to {int(text) / 1e6:.1f} MB")
    return warn(
        what,
        f"up to {int(text) / 1e6:.1f} MB",
        f"sudo sysctl -w net.core.rmem_max={RECEIVE_BUFFER_BYTES}",
    )


def _has_capability(machine: Machine, number: int) -> bool:
    for line in (machine.read("/proc/self/status") or "").splitlines():
        name, _, value = line.partition(":")
        if name == "CapEff":
            return bool(int(value, 16) >> number & 1)
    return False
