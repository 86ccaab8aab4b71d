"""Whole runs: recorder, service and emulator as processes on the embedded bus."""

import uuid
from dataclasses import replace
from pathlib import Path

import can
import numpy as np
import pytest
from msgspec import structs

from plant_emulator.scenario import load_scenario
from tcs_hil.control.settings import ControlSettings
from tcs_hil.hil.metrics import slip_metrics
from tcs_hil.hil.processes.program import ProcessError
from tcs_hil.hil.run import Mode, RunPlan, execute
from tcs_hil.model.vehicle import Vehicle
from tcs_hil.service.settings import BusSettings, ControllerName, ServiceConfig, read_service
from tcs_hil.signals import TcsState

SHORT = """
description = "the paper's launch, cut short"
duration_s = 0.5
start_speed_kmph = 2.0
road = [{ mu = 0.3 }]
vehicle = { variant = "quarter-car" }

[driver]
request = [[0.05, 0.0], [0.25, 250.0]]
"""

PERIOD_NS = 2_000_000
SERVICE_IDS = {0x090, 0x300, 0x301, 0x7F1}
DECISIONS = ("now_ns", "slip_ratio_fl", "proposal_fl_nm", "limit_fl_nm", "limit_fr_nm", "state")


@pytest.fixture
def plan(tmp_path: Path):
    scenario = tmp_path / "short.toml"
    scenario.write_text(SHORT)

    def make(controller: ControllerName, mode: Mode, name: str = "run") -> RunPlan:
        config = ServiceConfig(
            controller=controller,
            bus=BusSettings(interface="embedded", channel=f"vcan-{uuid.uuid4().hex[:8]}"),
            control=ControlSettings(preset="paper"),
        )
        return RunPlan(load_scenario(scenario), config, mode, tmp_path / name)

    return make


def test_in_lockstep_two_runs_give_the_same_bytes(plan) -> None:
    first, second = execute(plan("kmpc", "lockstep", "a")), execute(plan("kmpc", "lockstep", "b"))
    np.testing.assert_array_equal(first.read_truth(), second.read_truth())
    for name in DECISIONS:
        np.testing.assert_array_equal(first.read_flight()[name], second.read_flight()[name])
    # The embedded bus keeps the order of each sender, not that between senders.
    for ids in (SERVICE_IDS, set(range(0x800)) - SERVICE_IDS):
        assert [f for f in frames(first.bus) if f[0] in ids] == [
            f for f in frames(second.bus) if f[0] in ids
        ]


def test_the_controller_holds_what_no_control_loses(plan) -> None:
    peaks = {}
    for controller in ("off", "kmpc"):
        truth = execute(plan(controller, "lockstep", controller)).read_truth()
        peaks[controller] = slip_metrics(truth, 0.1, Vehicle()).peak_ratio
    # In its first second, near standstill, the published law overshoots most.
    assert peaks["kmpc"] < 0.25
    assert peaks["off"] > 0.5


def test_in_real_time_every_tick_is_on_the_grid_or_counted_as_skipped(plan) -> None:
    # How many are skipped is the machine's affair; none may vanish.
    ticks = execute(plan("pi", "real-time")).read_flight()
    offsets_ns = ticks["scheduled_ns"] - ticks["scheduled_ns"][0]
    assert not (offsets_ns % PERIOD_NS).any()
    np.testing.assert_array_equal(
        np.diff(offsets_ns) // PERIOD_NS, 1 + ticks["skipped"][1:].astype(int)
    )


def test_every_frame_of_a_run_is_in_a_recording_others_can_read(plan) -> None:
    files = execute(plan("pi", "lockstep"))
    ticks = len(files.read_flight())
    sent = [frame_id for frame_id, _ in frames(files.bus)]
    assert ticks == 250
    assert sent.count(0x090) == sent.count(0x0A0) == sent.count(0x0A2) == ticks
    assert sent.count(0x098) == ticks // 5
    assert sent.count(0x300) == ticks // 10


def test_the_flight_recording_tells_the_states_in_order(plan) -> None:
    states = execute(plan("nmpc", "lockstep")).read_flight()["state"]
    changes = states[np.flatnonzero(np.diff(states, prepend=-1))]
    assert list(changes[:3]) == [TcsState.INIT, TcsState.STANDBY, TcsState.ACTIVE]


def test_a_program_that_fails_ends_the_run_with_its_last_words(plan) -> None:
    unknown = plan("off", "lockstep")
    bus = BusSettings(interface="no-such-interface", channel="x")
    unknown = replace(unknown, config=structs.replace(unknown.config, bus=bus))
    with pytest.raises(ProcessError, match="no-such-interface"):
        execute(unknown)


def test_in_one_process_a_run_is_the_same_as_in_lockstep_on_a_bus(plan) -> None:
    apart, together = execute(plan("nmpc", "lockstep", "a")), execute(plan("nmpc", "in-process"))
    np.testing.assert_array_equal(apart.read_truth(), together.read_truth())
    for name in DECISIONS:
        np.testing.assert_array_equal(apart.read_flight()[name], together.read_flight()[name])
    assert sorted(frames(apart.bus)) == sorted(frames(together.bus))


def test_what_was_run_can_be_read_back(plan) -> None:
    planned = plan("pi", "in-process")
    files = execute(planned)
    assert load_scenario(files.scenario) == planned.scenario
    config = read_service(files.config)
    assert (config.controller, config.control) == ("pi", planned.config.control)


def test_the_paths_of_what_was_run_hold_in_the_folder_of_the_run(plan, monkeypatch) -> None:
    dbc = Path("tcs_hil/canbus/tcs.dbc").absolute()
    monkeypatch.chdir(dbc.parent)
    planned = plan("pi", "in-process")
    bus = structs.replace(planned.config.bus, database="tcs.dbc")
    files = execute(replace(planned, config=structs.replace(planned.config, bus=bus)))
    assert read_service(files.config).bus.database == str(dbc)


def frames(path: Path) -> list[tuple[int, bytes]]:
    with can.LogReader(str(path)) as reader:
        return [(message.arbitration_id, bytes(message.data)) for message in reader]
