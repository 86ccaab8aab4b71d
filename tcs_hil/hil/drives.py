"""Recorded drives for identification: a log of this service's bus, or a CSV."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from itertools import groupby
from pathlib import Path
from typing import NamedTuple

import can
import numpy as np
from numpy.typing import NDArray

from tcs_hil.canbus.database import Database, load_database, parse_dbc
from tcs_hil.canbus.tcs_node import TcsNode
from tcs_hil.canbus.vehicle_node import VehicleNode
from tcs_hil.control.settings import ControlSettings
from tcs_hil.errors import ConfigError
from tcs_hil.estimator.fused import FusedEstimator
from tcs_hil.hil.export.time_base import Parts, align
from tcs_hil.hil.logs.bus_log import BrokenOffError, read_log
from tcs_hil.model.excitation import Runs
from tcs_hil.model.observables import Sample
from tcs_hil.model.vehicle import Vehicle
from tcs_hil.signals import Pair

FloatArray = NDArray[np.float64]

CSV_COLUMNS = (
    "speed_mps",
    "wheel_speed_radps",
    "motor_speed_radps",
    "motor_torque_nm",
    "command_nm",
)
"""Of one driven wheel, a row per period; the command is the one acting from that row on."""


class _Tick(NamedTuple):
    """One tick of the service, both wheels: rows of a `Sample`, speed, command sent, delay."""

    sample: FloatArray  # (4, 2)
    speed_mps: float
    command_nm: Pair
    delay_s: float

    def is_known(self) -> bool:
        """Whether all of it is a number."""
        return bool(np.isfinite([*self.sample.flat, self.speed_mps, *self.command_nm]).all())


def read_drive(path: Path, settings: ControlSettings, vehicle: Vehicle) -> Runs:
    """The driven wheels of one recording, estimated as the service does.

    By suffix: ``.csv`` with `CSV_COLUMNS`, else a log python-can reads (``.blf``,
    ``.asc``, candump's ``.log``; ``.mf4`` where asammdf is installed), of which the
    longest stretch counts in which everything is known.

    Raises:
        ConfigError: the file cannot be read or holds no drive; it is named.
    """
    if path.suffix == ".csv":
        return _read_csv(path, vehicle)
    try:
        ticks = _known(_ticks(path, settings, vehicle))
    except BrokenOffError as error:  # half a drive is not what was asked to be learnt from
        remedy = f"`tcs-hil export {path} -o whole.log` saves what is there"
        raise ConfigError(f"{error}; {remedy}") from error
    if len(ticks) < 2:
        raise ConfigError(f"{path}: holds no drive of this service's bus")
    return _aligned(ticks, settings.period_s)


def _ticks(path: Path, settings: ControlSettings, vehicle: Vehicle) -> Iterator[_Tick]:
    """What the service knew and sent, tick by tick: the newest rear speeds complete a cycle."""
    database = load_database()
    service, car = TcsNode(database), VehicleNode(database)
    estimator = FusedEstimator(settings, vehicle)
    last_id = database.messages["WheelSpeedsRear"].frame_id
    for now_ns, message in _frames(path, database):
        car.feed(message.arbitration_id, bytes(message.data), now_ns)
        good = service.feed(message.arbitration_id, bytes(message.data), now_ns)
        if not (good and message.arbitration_id == last_id):
            continue
        measurement = service.measurement(now_ns)
        request_nm = measurement.driver_torque_nm
        command_nm = (min(request_nm[0], car.limits[0]), min(request_nm[1], car.limits[1]))
        estimator.sent(command_nm, request_nm)
        estimate = estimator.update(measurement)
        rows = [
            (
                wheel.slip_speed_mps,
                wheel.wheel_speed_radps,
                wheel.motor_speed_radps / vehicle.gear_ratio,
                wheel.motor_torque_nm,
            )
            for wheel in estimate.wheels
        ]
        delay_s = estimate.wheels[0].loop_delay_s
        yield _Tick(np.array(rows).T, estimate.vehicle_speed_mps, command_nm, delay_s)


def _known(ticks: Iterable[_Tick]) -> list[_Tick]:
    """The longest stretch in which all is known: not before all was heard, nor after the end."""
    stretches = (list(stretch) for known, stretch in groupby(ticks, _Tick.is_known) if known)
    return max(stretches, key=len, default=[])


def _aligned(ticks: list[_Tick], period_s: float) -> Runs:
    """Columns over time, each command moved to the period from which on it acts.

    At a tick the newest limits on the bus are those of the tick before.
    """
    delay = max(round(ticks[-1].delay_s / period_s) - 1, 0)
    samples = np.stack([tick.sample for tick in ticks])  # (T, 4, 2)
    commands = np.array([tick.command_nm for tick in ticks])  # (T, 2)
    speed = np.repeat([[tick.speed_mps] for tick in ticks], 2, axis=1)
    first = samples[delay:]
    acting = commands[: len(commands) - delay]
    columns = (first[:, index] for index in range(first.shape[1]))
    return Runs(Sample(*columns), speed[delay:], acting[:-1])


def _frames(path: Path, database: Database) -> Iterator[tuple[int, can.Message]]:
    """Frames and their instants in ns: in lockstep the bench's, whatever the log's clock says."""
    known = {message.frame_id for message in database.messages.values()}
    messages = [message for message in read_log(path) if message.arbitration_id in known]
    base = align(Parts(messages, None, None, None, np.empty(0, np.int64)), parse_dbc(None)[1])
    for now_ns, place in zip(base.frames_ns.tolist(), base.order, strict=True):
        yield now_ns, messages[place]


def _read_csv(path: Path, vehicle: Vehicle) -> Runs:
    try:
        with path.open(encoding="utf-8") as file:
            names = file.readline().strip().split(",")
            usable = set(names).issuperset(CSV_COLUMNS)
            rows = np.loadtxt(file, delimiter=",", ndmin=2) if usable else np.empty((0, 0))
    except (OSError, ValueError) as error:
        raise ConfigError(f"{path}: cannot be read as CSV ({error})") from error
    if len(rows) < 2 or rows.shape[1] != len(names):
        raise ConfigError(f"{path}: needs two rows and the columns {', '.join(CSV_COLUMNS)}")
    speed, omega, motor, torque, command = (rows[:, [names.index(name)]] for name in CSV_COLUMNS)
    slip_speed = omega * vehicle.wheel_radius_m - speed
    sample = Sample(slip_speed, omega, motor / vehicle.gear_ratio, torque)
    return Runs(sample, speed, command[:-1])
