"""Whatever comes from the bus: no byte sequence may raise or give a number that is none."""

from __future__ import annotations

import math
import struct

from e2e.p02 import e2e_p02_protect

from tcs_hil.canbus.database import load_database
from tcs_hil.canbus.tcs_node import TcsNode
from tcs_hil.canbus.vehicle_node import VehicleNode

DATABASE = load_database()
SPECS = tuple(DATABASE.messages.values())
STEP = struct.Struct("<BBBB8s")  # how, which message, how much later, length, bytes
LATER_NS = (0, 1, 500_000, 1_999_999, 2_000_000, 10_000_000, -2_000_000, 10**12, -(10**12))


def frames(data: bytes) -> None:
    """A row of frames, some signed as their sender would, into both nodes."""
    service, vehicle, now_ns = TcsNode(DATABASE), VehicleNode(DATABASE), 0
    for how, which, later, length, content in STEP.iter_unpack(data[: len(data) // 12 * 12]):
        now_ns += LATER_NS[later % len(LATER_NS)]
        frame_id, payload = _frame(how, which, content[: length % 9])
        service.feed(frame_id, payload, now_ns)
        vehicle.feed(frame_id, payload, now_ns)
    _look(service, vehicle, now_ns)


def _frame(how: int, which: int, payload: bytes) -> tuple[int, bytes]:
    spec = SPECS[which % len(SPECS)]
    if how & 1:
        return (how << 3 | which) & 0x7FF, payload
    if how & 2 and spec.e2e is not None:
        whole = bytearray(payload.ljust(spec.length, b"\0")[: spec.length])
        e2e_p02_protect(whole, spec.e2e.data_ids)
        return spec.frame_id, bytes(whole)
    return spec.frame_id, payload.ljust(spec.length, b"\0") if how & 4 else payload


def _look(service: TcsNode, vehicle: VehicleNode, now_ns: int) -> None:
    seen = service.measurement(now_ns)
    numbers = (
        *seen.wheel_speed_radps,
        *seen.motor_speed_radps,
        *seen.motor_torque_nm,
        *seen.driver_torque_nm,
    )
    if not all(map(math.isfinite, numbers)):
        raise AssertionError(f"{seen} holds a number that is none")
    if min(vehicle.limits) < 0.0:
        raise AssertionError(f"{vehicle.limits} is below zero")
    _ = vehicle.service, vehicle.road, service.bench_tick, vehicle.bench_tick_done


def codec(data: bytes) -> None:
    """Any payload decodes into its range or its bits; any floats encode and stay put."""
    if not data:
        return
    spec = SPECS[data[0] % len(SPECS)]
    values = spec.codec.decode(data[1:].ljust(spec.length, b"\0")[: spec.length])
    if not all(map(math.isfinite, values)):
        raise AssertionError(f"{spec.name} decodes {data!r} to {values}")
    count = len(spec.signals)
    wanted = struct.unpack(f"<{count}d", data[1:].ljust(8 * count, b"\0")[: 8 * count])
    once = spec.codec.encode(*wanted)
    decoded = spec.codec.decode(bytes(once))
    for signal, value in zip(spec.signals, decoded, strict=True):
        if not signal.minimum - signal.scale < value < signal.maximum + signal.scale:
            raise AssertionError(f"{signal.name} sends {value}")
    if spec.codec.encode(*decoded) != once:
        raise AssertionError(f"{spec.name} does not encode what it decodes")
