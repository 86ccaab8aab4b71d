"""Driving cases side by side."""

from __future__ import annotations

from pathlib import Path

import pytest
from hil.driven import LAUNCH
from msgspec import structs

from plant_emulator.expect import Expect
from tcs_hil.errors import ConfigError
from tcs_hil.hil.judging.verdict import Verdict
from tcs_hil.hil.suite.case import Case
from tcs_hil.hil.suite.runner import Bench, run_case, run_cases
from tcs_hil.service.settings import BusSettings, ServiceConfig

CONFIG = ServiceConfig(controller="pi")


def case(name: str, limit: float, config: ServiceConfig = CONFIG) -> Case:
    expect = (Expect(metric="peak slip", op="<", value=limit),)
    return Case("own", name, structs.replace(LAUNCH, expect=expect), config)


def test_cases_are_driven_side_by_side_each_on_a_bus_of_its_own(tmp_path: Path) -> None:
    told: list[str] = []
    cases = [case("strict", 0.01), case("loose", 0.9)]
    bench = Bench("lockstep", tmp_path)
    results = run_cases(cases, bench, 2, lambda _share, what: told.append(what))
    assert [(result.name, result.verdict) for result in results] == [
        ("strict/pi", Verdict.FAILED),
        ("loose/pi", Verdict.PASSED),
    ]
    assert sorted(told) == ["loose/pi passed", "strict/pi failed"]
    assert results[0].figures == results[1].figures
    assert (tmp_path / "runs" / "strict" / "pi" / "bus.blf").is_file()


def test_a_run_that_does_not_come_about_is_blocked_and_says_why(tmp_path: Path) -> None:
    broken = case("broken", 0.9, structs.replace(CONFIG, controller="kmpc", model="/no/model.npz"))
    result = run_case(broken, Bench("in-process", tmp_path))
    assert result.verdict is Verdict.BLOCKED
    assert "/no/model.npz" in result.reason
    assert not result.findings


def test_in_real_time_the_machines_times_are_judged(tmp_path: Path) -> None:
    expect = (Expect(metric="latency p50", op=">", value=0.0),)
    timed = Case("own", "timed", structs.replace(LAUNCH, expect=expect), CONFIG)
    result = run_case(timed, Bench("real-time", tmp_path))
    assert result.findings[0].verdict is Verdict.PASSED
    assert result.figures["latency max"] >= result.figures["latency p99"] > 0.0


def test_one_bus_takes_one_case_at_a_time(tmp_path: Path) -> None:
    shared = Bench("lockstep", tmp_path, "socketcan", "can0")
    assert shared.jobs(None) == 1
    assert shared.bus("7") == BusSettings(interface="socketcan", channel="can0")
    with pytest.raises(ConfigError, match="can0 are driven one after another"):
        shared.jobs(2)


def test_clocks_are_not_disturbed_by_neighbours_unless_asked(tmp_path: Path) -> None:
    assert Bench("real-time", tmp_path).jobs(None) == 1
    assert Bench("real-time", tmp_path).jobs(2) == 2
    assert Bench("lockstep", tmp_path).jobs(3) == 3
