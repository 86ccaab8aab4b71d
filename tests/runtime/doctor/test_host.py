"""Kernel, cores, limits and software of machines good and bad."""

from __future__ import annotations

import math

import pytest
from runtime.doctor.machines import FakeMachine

from tcs_hil.runtime.doctor import cores, kernel, limits, software
from tcs_hil.runtime.doctor.finding import Verdict

OK, WARN, FAIL = Verdict.OK, Verdict.WARN, Verdict.FAIL
VERSION = "/proc/version"
MODE = "/sys/kernel/debug/sched/preempt"
CLOCK = "/sys/devices/system/clocksource/clocksource0/current_clocksource"
CPU = "/sys/devices/system/cpu"
NOBODY, ROOT = (
    {"/proc/self/status": "CapEff:\t0000000000000000"},
    {"/proc/self/status": "Name:\tpytest\nCapEff:\t000001ffffffffff"},
)


@pytest.mark.parametrize(
    ("files", "verdict", "words"),
    [
        ({VERSION: "Linux version 6.12 (x) #1 SMP PREEMPT_RT"}, OK, "PREEMPT_RT"),
        ({VERSION: "Linux version 5.10-rt (x) #1 SMP", "/sys/kernel/realtime": "1"}, OK, "RT"),
        ({VERSION: "Linux version 6.1 (x) #1 SMP PREEMPT"}, OK, "fully preemptible"),
        (
            {VERSION: "Linux version 6.1 (x) PREEMPT_DYNAMIC", MODE: "none voluntary (full)"},
            OK,
            "fully preemptible",
        ),
        (
            {VERSION: "Linux version 6.1 (x) PREEMPT_DYNAMIC", MODE: "none (voluntary) full"},
            WARN,
            "(voluntary)",
        ),
        ({VERSION: "Linux version 6.1 (x) PREEMPT_DYNAMIC"}, WARN, "chosen at boot"),
        ({VERSION: "Linux version 4.4 (x) #1 SMP"}, WARN, "not preemptible"),
        ({}, WARN, "unknown kernel"),
    ],
)
def test_the_preemption_model_is_told_from_version_and_mode(
    files: dict[str, str], verdict: Verdict, words: str
) -> None:
    finding = kernel.preemption(FakeMachine(files))
    assert finding.verdict is verdict
    assert words in finding.found


def test_a_slow_clock_source_is_named() -> None:
    assert kernel.clock_source(FakeMachine({CLOCK: "tsc"})).verdict is OK
    finding = kernel.clock_source(FakeMachine({CLOCK: "hpet"}))
    assert (finding.verdict, finding.found) == (WARN, "hpet: slow to read")


def test_timers_too_coarse_for_the_period_are_a_hard_failure() -> None:
    assert kernel.timers(FakeMachine(resolution_s=1e-9)).verdict is OK
    assert kernel.timers(FakeMachine(resolution_s=4e-3)).verdict is FAIL


def test_one_slow_core_spoils_the_governor() -> None:
    files = {f"{CPU}/cpu{n}/cpufreq/scaling_governor": "performance" for n in range(4)}
    assert cores.governor(FakeMachine(files)).verdict is OK
    finding = cores.governor(
        FakeMachine(files | {f"{CPU}/cpu3/cpufreq/scaling_governor": "powersave"})
    )
    assert (finding.verdict, finding.found) == (WARN, "performance, powersave")
    assert "cpupower" in finding.remedy


def test_a_machine_without_frequency_scaling_has_no_governor_to_set() -> None:
    assert cores.governor(FakeMachine()).verdict is OK


@pytest.mark.parametrize(
    ("files", "verdict", "words"),
    [
        ({f"{CPU}/isolated": "3"}, OK, "tick.cpu"),
        ({f"{CPU}/isolated": "", f"{CPU}/online": "0-7"}, WARN, "isolcpus=7"),
        ({f"{CPU}/isolated": "", f"{CPU}/online": "0-2,5"}, WARN, "isolcpus=5"),
        ({f"{CPU}/isolated": "", f"{CPU}/online": "0"}, WARN, "more than one core"),
    ],
)
def test_the_last_core_is_offered_for_isolation(
    files: dict[str, str], verdict: Verdict, words: str
) -> None:
    finding = cores.isolation(FakeMachine(files))
    assert finding.verdict is verdict
    assert words in finding.found + finding.remedy


@pytest.mark.parametrize(
    ("files", "limit", "verdict"),
    [(NOBODY, 0, WARN), (NOBODY, 49, WARN), (NOBODY, 50, OK), (ROOT, 0, OK), ({}, 0, WARN)],
)
def test_real_time_priority_needs_a_limit_or_a_capability(
    files: dict[str, str], limit: float, verdict: Verdict
) -> None:
    finding = limits.realtime_priority(FakeMachine(files, limits=limit))
    assert finding.verdict is verdict
    assert bool(finding.remedy) is (verdict is WARN)


@pytest.mark.parametrize(
    ("files", "limit", "verdict"),
    [(NOBODY, 8 << 20, WARN), (NOBODY, 1 << 30, OK), (NOBODY, math.inf, OK), (ROOT, 0, OK)],
)
def test_locked_memory_needs_a_limit_or_a_capability(
    files: dict[str, str], limit: float, verdict: Verdict
) -> None:
    assert limits.locked_memory(FakeMachine(files, limits=limit)).verdict is verdict


@pytest.mark.parametrize(("size", "verdict"), [("212992", WARN), ("4194304", OK), (None, OK)])
def test_the_receive_buffer_may_grow_to_what_the_bus_asks_for(
    size: str | None, verdict: Verdict
) -> None:
    files = NOBODY | ({} if size is None else {"/proc/sys/net/core/rmem_max": size})
    finding = limits.receive_buffer(FakeMachine(files))
    assert finding.verdict is verdict
    if verdict is WARN:
        assert finding.remedy == "sudo sysctl -w net.core.rmem_max=4194304"


def test_without_a_native_step_the_doctor_says_how_to_get_one() -> None:
    assert software.native_step(FakeMachine()).verdict is OK
    finding = software.native_step(FakeMachine(native_step=False))
    assert finding.verdict is WARN
    assert "gcc" in finding.remedy


def test_an_interpreted_tick_is_no_failure_but_told() -> None:
    assert software.compiled_tick(FakeMachine()).verdict is OK
    finding = software.compiled_tick(FakeMachine(compiled_tick=False))
    assert finding.verdict is WARN
    assert "pip install ." in finding.remedy


def test_a_missing_distribution_is_a_hard_failure_with_its_name() -> None:
    present = dict.fromkeys((*software.BUS, *software.SOLVERS), "1.0")
    assert software.bus_software(FakeMachine(versions=present)).verdict is OK
    del present["daqp"]
    finding = software.solvers(FakeMachine(versions=present))
    assert (finding.verdict, finding.remedy) == (FAIL, "pip install daqp")
