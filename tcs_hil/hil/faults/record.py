"""What a run of the campaign is judged by: the limits as the car decodes them, tick by tick."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from tcs_hil.canbus.database import load_database
from tcs_hil.canbus.vehicle_node import VehicleNode
from tcs_hil.hil.judging.evidence import Evidence
from tcs_hil.hil.judging.measured import CannotJudgeError
from tcs_hil.hil.logs.bus_log import read_log, stamp_ns
from tcs_hil.hil.run import RunFiles

FloatArray = NDArray[np.float64]

SIDES = ("fl", "fr")


@dataclass(frozen=True, slots=True)
class Record:
    """One row per tick of the service; left and right motor in the columns.

    ``limit_nm`` (n, 2) is decoded from the bus, infinite for no limit; ``request_nm``
    (n, 2) is what the service knew, ``wanted_nm`` (n, 2) what its law proposed, NaN where
    it was not asked; ages (n,) are those it decided with.
    """

    time_s: FloatArray
    limit_nm: FloatArray
    request_nm: FloatArray
    wanted_nm: FloatArray
    estimate: FloatArray  # (n, 3): the car's speed and both slips
    wheel_age_s: FloatArray
    driver_age_s: FloatArray
    state: NDArray[np.uint8]
    fault_code: NDArray[np.uint8]
    failed: NDArray[np.bool_]


def read_record(evidence: Evidence) -> Record:
    """Read a run's limits from its bus and the rest from the flight recording.

    Raises:
        CannotJudgeError: the bus does not hold one good frame of limits per tick.
    """
    ticks = evidence.ticks
    limit_nm = read_limits(evidence.files)
    if len(limit_nm) != len(ticks):
        raise CannotJudgeError(f"{len(limit_nm)} good limits on the bus, {len(ticks)} ticks")
    return Record(
        time_s=evidence.tick_time_s,
        limit_nm=limit_nm,
        request_nm=_both(ticks, "driver_torque_{}_nm"),
        wanted_nm=_both(ticks, "proposal_{}_nm"),
        estimate=np.column_stack([ticks["vehicle_speed_mps"], _both(ticks, "slip_ratio_{}")]),
        wheel_age_s=np.maximum(ticks["front_speed_age_s"], ticks["rear_speed_age_s"]),
        driver_age_s=ticks["driver_age_s"],
        state=ticks["state"],
        fault_code=ticks["fault_code"],
        failed=ticks["failed"],
    )


def _both(ticks: NDArray[np.void], field: str) -> FloatArray:
    return np.column_stack([ticks[field.format(side)] for side in SIDES])


def read_limits(files: RunFiles) -> FloatArray:
    """Torque limits (n, 2) that passed the car's own checks, in the order they were sent."""
    database = load_database()
    car, frame_id = VehicleNode(database), database.messages["TorqueLimit"].frame_id
    limits = [
        car.limits
        for frame in read_log(files.bus)
        if frame.arbitration_id == frame_id
        and car.feed(frame_id, bytes(frame.data), stamp_ns(frame))
    ]
    return np.array(limits, float).reshape(-1, 2)
