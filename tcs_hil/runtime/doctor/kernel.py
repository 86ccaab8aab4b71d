"""The kernel and its clocks."""

from __future__ import annotations

from tcs_hil.runtime.doctor.finding import Finding, fail, ok, warn
from tcs_hil.runtime.doctor.machine import Machine

EXACT_CLOCKS = ("tsc", "kvm-clock", "arch_sys_counter", "hyperv_clocksource_tsc_page")
COARSEST_TIMER_S = 200e-6  # a tenth of the period
RT_KERNEL = "install a PREEMPT_RT kernel (Debian: apt-get install linux-image-rt-amd64)"


def preemption(machine: Machine) -> Finding:
    """How soon a running system call makes way."""
    what, build = "kernel", machine.read("/proc/version") or "unknown kernel"
    release = " ".join(build.split()[:3])
    if machine.read("/sys/kernel/realtime") == "1" or "PREEMPT_RT" in build:
        return ok(what, f"{release}, PREEMPT_RT")
    mode = machine.read("/sys/kernel/debug/sched/preempt") or ""
    if "(full)" in mode or ("PREEMPT" in build and "PREEMPT_DYNAMIC" not in build):
        return ok(what, f"{release}, fully preemptible")
    if "PREEMPT_DYNAMIC" in build:
        return warn(
            what, f"{release}, preemption {mode or 'chosen at boot'}", "boot with preempt=full"
        )
    return warn(what, f"{release}, not preemptible", RT_KERNEL)


def clock_source(machine: Machine) -> Finding:
    """What reading the time costs and is worth."""
    what = "clock source"
    name = machine.read("/sys/devices/system/clocksource/clocksource0/current_clocksource")
    if name is None:
        return ok(what, "unknown")
    if name in EXACT_CLOCKS:
        return ok(what, name)
    return warn(what, f"{name}: slow to read", "boot with clocksource=tsc tsc=reliable")


def timers(machine: Machine) -> Finding:
    """How exactly a sleep can end; the service asks for a slack of 1 ns by itself."""
    what, resolution_s = "timers", machine.timer_resolution_s()
    slack_ns = machine.read("/proc/self/timerslack_ns") or "unknown"
    found = f"resolution {resolution_s * 1e9:.0f} ns, slack {slack_ns} ns before the service sets 1"
    if resolution_s <= COARSEST_TIMER_S:
        return ok(what, found)
    return fail(
        what, found, "use a kernel with CONFIG_HIGH_RES_TIMERS and boot without highres=off"
    )
