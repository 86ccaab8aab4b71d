"""Daemon and emulator as processes on a real vcan0, with strangers on the bus."""

import subprocess
import sys
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path

import can
import pytest

from plant_emulator.scenario import load_scenario
from tcs_hil.canbus.bus import open_bus
from tcs_hil.control.settings import ControlSettings
from tcs_hil.hil.metrics import slip_metrics
from tcs_hil.hil.processes.program import Program, program
from tcs_hil.hil.run import Mode, RunPlan, execute
from tcs_hil.model.vehicle import Vehicle
from tcs_hil.runtime.recording import read
from tcs_hil.service.settings import BusSettings, ControllerName, ServiceConfig

from .conftest import CHANNEL, Candump, Interface

LIMIT_ID = 0x090


def paper_plan(controller: ControllerName, mode: Mode, folder: Path) -> RunPlan:
    config = ServiceConfig(
        controller=controller,
        bus=BusSettings(channel=CHANNEL),
        control=ControlSettings(preset="paper"),
    )
    return RunPlan(load_scenario("manoeuvre-1"), config, mode, folder)


@contextmanager
def daemon(tmp_path: Path, *options: str) -> Iterator[Program]:
    # Small: a User-Mode-Linux guest can only lock so many pages before its host says no.
    config = tmp_path / "service.toml"
    config.write_text("[recorder]\nticks = 5_000\n")
    arguments = ("tcs_hil", "run", "--config", str(config), "--channel", CHANNEL)
    with program(*arguments, "--controller", "pi", *options, log=tmp_path / "service.log") as child:
        yield child


def next_limit(bus: can.BusABC) -> can.Message:
    while (message := bus.recv(timeout=10.0)) is not None:
        if message.arbitration_id == LIMIT_ID:
            return message
    raise AssertionError("the daemon is silent")


def test_the_papers_manoeuvre_runs_in_lockstep_on_a_real_bus(tmp_path: Path) -> None:
    files = execute(paper_plan("kmpc", "lockstep", tmp_path / "run"))
    assert "bus: socketcan vcan0" in (tmp_path / "run" / "service.log").read_text()
    metrics = slip_metrics(files.read_truth(), 0.1, Vehicle())
    assert metrics.rmse_ratio <= 0.006
    assert metrics.peak_ratio <= 0.135


@pytest.mark.simulated_time
@pytest.mark.parametrize(("controller", "peak"), [("pi", 0.11), ("kmpc", 0.15), ("nmpc", 0.12)])
def test_the_papers_manoeuvre_runs_in_real_time_on_a_real_bus(
    tmp_path: Path, controller: ControllerName, peak: float
) -> None:
    files = execute(paper_plan(controller, "real-time", tmp_path / "run"))
    assert slip_metrics(files.read_truth(), 0.1, Vehicle()).peak_ratio < peak
    ticks = read(files.flight)
    assert not ticks["skipped"].any()
    assert not ticks["overrun"].any()
    # The plant is there for 3 s: 1500 ticks with speeds that are less than a period old.
    fresh = ticks["rear_speed_age_s"] < 0.002
    assert 1495 <= fresh.sum() <= 1505


def test_candump_sees_the_limits(tmp_path: Path, candump: Callable[[int], Candump]) -> None:
    dump = candump(100)
    with daemon(tmp_path):
        seen = dump.frames()
    assert {frame.partition("#")[0] for frame in seen} == {"090", "300", "301"}


def test_frames_typed_by_hand_do_not_disturb_it(
    tmp_path: Path, cansend: Callable[[str], None]
) -> None:
    bus, _ = open_bus("socketcan", CHANNEL)
    with bus, daemon(tmp_path) as child:
        for frame in ("0A2#0000000000000000", "0A2#00", "7AA#DEADBEEF", "0A2#R", "1FFFFFFF#01"):
            cansend(frame)
        for _ in range(20):
            next_limit(bus)
        assert child.running


def test_it_outlives_its_interface_going_down_and_up(tmp_path: Path, vcan0: Interface) -> None:
    with daemon(tmp_path) as child:
        vcan0.down()
        vcan0.up()
        bus, _ = open_bus("socketcan", CHANNEL)
        with bus:
            next_limit(bus)
        assert child.running


def test_it_finds_its_interface_again_after_it_was_removed(
    tmp_path: Path, vcan0: Interface
) -> None:
    with daemon(tmp_path) as child:
        vcan0.remove()
        vcan0.add()
        bus, _ = open_bus("socketcan", CHANNEL)
        with bus:
            next_limit(bus)
        assert child.running


@contextmanager
def hogs(count: int) -> Iterator[None]:
    """A context in which processes compute and compute."""
    with ExitStack() as stack:
        for _ in range(count):
            hog = stack.enter_context(subprocess.Popen([sys.executable, "-c", "while True: pass"]))
            stack.callback(hog.kill)
        yield


def test_processes_that_want_the_whole_machine_do_not_silence_it(tmp_path: Path) -> None:
    bus, _ = open_bus("socketcan", CHANNEL)
    with bus, daemon(tmp_path) as child, hogs(4):
        for _ in range(100):
            next_limit(bus)
        assert child.running
