"""One run from an opened bus to a summary: builds the rooms, warms up, drives, saves."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import closing
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

import msgspec
import numpy as np

from plant_emulator.emulator import PERIOD_NS, Emulator
from plant_emulator.lockstep import run_lockstep
from plant_emulator.plant import Plant
from plant_emulator.realtime import Jitter, run_realtime
from plant_emulator.recording import TruthRecorder
from plant_emulator.scenario import Scenario
from plant_emulator.undisturbed import undisturbed
from tcs_hil.canbus.database import load_database
from tcs_hil.canbus.port import CanPort, open_port
from tcs_hil.canbus.vehicle_node import VehicleNode
from tcs_hil.runtime.clock import MonotonicClock
from tcs_hil.runtime.notify import notify

PERIOD_S = PERIOD_NS * 1e-9
_SEND_TIMEOUT_S = {"realtime": 0.0, "lockstep": 10.0}


@dataclass(frozen=True, kw_only=True)
class Options:
    """Where and at which pace a scenario is driven."""

    interface: str
    channel: str
    bitrate: int | None = None
    mode: Literal["realtime", "lockstep"] = "realtime"
    phase_us: int = 0
    record: Path | None = None
    allow_control: bool = False


class Summary(msgspec.Struct, frozen=True):
    """How a run ended and how well the grid was kept (jitter is 0 in lockstep).

    ``refused_controls`` counts the control frames of a bench that nobody had allowed.
    """

    time_s: float
    distance_m: float
    speed_mps: float
    jitter_p50_us: float = 0.0
    jitter_p99_us: float = 0.0
    jitter_max_us: float = 0.0
    refused_controls: int = 0


def run(
    scenario: Scenario, options: Options, stop: Callable[[], bool], say: Callable[[str], None]
) -> Summary:
    """Drive ``scenario`` until its end or until ``stop()``; ``say`` is told which bus it is on.

    Raises:
        BusError: the bus cannot be opened or, in lockstep, the service is silent.
        ConfigError: the recording cannot be written.
    """
    recorder = TruthRecorder(options.record, scenario)
    port, description = open_port(
        options.interface,
        options.channel,
        options.bitrate,
        send_timeout_s=_SEND_TIMEOUT_S[options.mode],
    )
    say(f"bus: {description}")
    with closing(port):
        warm_up(scenario)
        plant = Plant(scenario)
        emulator = Emulator(
            plant,
            VehicleNode(load_database()),
            port,
            recorder,
            live=options.mode == "realtime",
            allow_control=options.allow_control,
        )
        notify("READY=1")
        jitter_ns = np.empty(0, np.int64)
        try:
            jitter_ns = _drive(emulator, port, options, stop)
        finally:  # a run that a silent service cut short is worth looking at, too
            recorder.save(jitter_ns)
    return _summary(emulator, jitter_ns)


def warm_up(scenario: Scenario) -> None:
    """Compile everything on a plant of its own: the first grid instant must not wait for it."""
    plant = Plant(scenario)
    plant.step(None, PERIOD_S)
    plant.signals()


def check_own_car(scenario: Scenario) -> None:
    """Drive a car of somebody's own for a period; the shipped ones need no such proof.

    Raises:
        ConfigError: it cannot be made, or fails.
    """
    if scenario.vehicle.variant == "own":
        warm_up(scenario)


def _drive(emulator: Emulator, port: CanPort, options: Options, stop: Callable[[], bool]) -> Jitter:
    if options.mode == "lockstep":
        run_lockstep(emulator, port, stop)
        return np.empty(0, np.int64)
    with undisturbed():
        return run_realtime(emulator, port, MonotonicClock(), stop, options.phase_us * 1000)


def _summary(emulator: Emulator, jitter_ns: Jitter) -> Summary:
    truth = emulator.plant.truth
    end = (truth.time_s, truth.distance_m, truth.speed_mps)
    refused = emulator.refused_controls
    if jitter_ns.size == 0:
        return Summary(*end, refused_controls=refused)
    p50, p99, most = np.percentile(jitter_ns, [50, 99, 100]) * 1e-3
    return Summary(*end, float(p50), float(p99), float(most), refused)
