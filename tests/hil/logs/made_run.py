"""A run made by hand: bus log, flight recording and truth whose every number is known."""

from __future__ import annotations

from pathlib import Path

import can
import numpy as np
from factories import command
from msgspec.structs import replace
from runtime.fakes import RUN, insight, made_pass

from plant_emulator.truth import TRUTH_DTYPE
from tcs_hil.canbus.database import load_database
from tcs_hil.canbus.tcs_node import TcsNode
from tcs_hil.canbus.vehicle_node import VehicleNode, VehicleSignals
from tcs_hil.hil.run import RunFiles
from tcs_hil.runtime.record import record
from tcs_hil.runtime.recorder import FlightRecorder
from tcs_hil.signals import NO_LIMIT, Command, ControllerKind

TICKS, PERIOD_NS = 40, 2_000_000
STARTED_MONOTONIC_NS = 500_000_000_000
STARTED_REALTIME_NS = 1_790_000_000_000_000_000
PLANT_NS = 10_000_000  # the plant began this long after the service was started, in real time
JITTER_NS = 300_000  # and woke this late
PHASE_NS = 500_000  # the service ticks this long after the plant


def wheel_speed_radps(tick: int) -> float:
    return 20.0 + 0.01 * tick


def limit_nm(tick: int) -> float:
    return 100.0 - 0.05 * tick


def made_run(folder: Path, *, lockstep: bool) -> RunFiles:
    """Forty ticks; in real time each begins ``PLANT_NS`` plus a multiple of the period later."""
    folder.mkdir()
    files = RunFiles(folder)
    _write_bus(files.bus, lockstep)
    _write_flight(files.flight, lockstep)
    _write_truth(files.truth, lockstep)
    return files


def _write_bus(path: Path, lockstep: bool) -> None:
    database = load_database()
    car, service = VehicleNode(database), TcsNode(database)
    with can.Logger(str(path)) as write:
        for tick in range(TICKS):
            sent = sorted(car.frames(_signals(tick), tick * PERIOD_NS))
            answers = service.frames(_command(tick), tick * PERIOD_NS)
            if lockstep:
                sent.append(car.bench_tick(tick))
                answers.append(service.bench_tick_done(tick))
            began_ns = STARTED_REALTIME_NS + PLANT_NS + tick * PERIOD_NS
            for frame in sent:
                write(_message(began_ns + JITTER_NS, *frame))
            for frame in answers:
                write(_message(began_ns + PHASE_NS + 100_000, *frame))


def _message(stamp_ns: int, frame_id: int, data: bytes) -> can.Message:
    return can.Message(
        timestamp=stamp_ns * 1e-9, arbitration_id=frame_id, data=data, is_extended_id=False
    )


def _signals(tick: int) -> VehicleSignals:
    return VehicleSignals(
        wheel_speed_radps=(wheel_speed_radps(tick), 21.0, 19.0, 19.5),
        wheel_speed_valid=(True, True, True, False),
        motor_speed_radps=(66.0, 66.5),
        motor_torque_nm=(-12.25, 80.5),
        driver_torque_nm=(200.0, 199.875),
        accel_x_mps2=1.234,
    )


def _command(tick: int) -> Command:
    return command(
        *(limit_nm(tick), NO_LIMIT), controller=ControllerKind.PI, slip_ratio=(0.1, -0.05)
    )


def _write_flight(path: Path, lockstep: bool) -> None:
    run = replace(
        RUN,
        started_monotonic_ns=STARTED_MONOTONIC_NS,
        started_realtime_ns=STARTED_REALTIME_NS,
        controller="pi",
    )
    with FlightRecorder(path, run, 2 * TICKS) as recorder:
        for tick in range(TICKS):
            began_ns = STARTED_MONOTONIC_NS + PLANT_NS + tick * PERIOD_NS
            made = made_pass(tick, scheduled_ns=began_ns + PHASE_NS)
            if lockstep:
                made = replace(made, tick=replace(made.tick, now_ns=tick * PERIOD_NS))
            recorder.write(record(made, insight()))


def _write_truth(path: Path, lockstep: bool) -> None:
    rows = np.zeros(TICKS, TRUTH_DTYPE)
    rows["time_s"] = np.arange(TICKS) * PERIOD_NS * 1e-9
    rows["wheel_speed_radps"][:, 0] = [wheel_speed_radps(tick) for tick in range(TICKS)]
    rows["mu"][:, 2] = 0.3
    jitter_ns = np.empty(0, np.int64) if lockstep else np.full(TICKS, JITTER_NS)
    np.savez(path, truth=rows, jitter_ns=jitter_ns, scenario=np.array('{"mu": "<0.3 & wet>"}'))
