"""Another car's bus: any signal map on its DBC, and any frames through a good one."""

from __future__ import annotations

import copy
import math
from pathlib import Path

import msgspec

from tcs_hil.canbus.database import parse_dbc
from tcs_hil.canbus.mapping.advice import look_over
from tcs_hil.canbus.mapping.findings import Findings
from tcs_hil.canbus.mapping.node import MappedNode
from tcs_hil.canbus.mapping.plan import Plan
from tcs_hil.canbus.mapping.resolve import resolve
from tcs_hil.canbus.mapping.settings import SignalMap
from tcs_hil.config import read_toml
from tcs_hil.service.bus_end import examine_map
from tcs_hil.service.settings import ServiceConfig, read_service

from .file_targets import through_file
from .frame_targets import LATER_NS, STEP

CARS = {path.stem: path for path in sorted(Path("tests/data/dbc").glob("*.toml"))}
CONFIGS = {name: read_service(path) for name, path in CARS.items()}
DBCS = [parse_dbc(path.with_suffix(".dbc"))[1] for path in CARS.values()]
PLANS: list[Plan] = [examine_map(config)[0] for config in CONFIGS.values()]
NODES = [MappedNode(plan) for plan in PLANS]


class MapFile(msgspec.Struct, frozen=True):
    """The part of a configuration that is looked at here."""

    map: SignalMap = SignalMap()


def signal_map(data: bytes) -> None:
    """A signal map; the first byte chooses the car it is for."""
    dbc = DBCS[data[0] % len(DBCS)] if data else DBCS[0]
    vehicle = ServiceConfig().vehicle

    def look(path: Path) -> None:
        settings = read_toml(path, MapFile).map
        findings = Findings()
        plan = resolve(dbc, settings, vehicle, findings)
        look_over(plan, dbc, settings, vehicle, findings)
        if not findings.errors:
            MappedNode(plan)

    through_file(data[1:], look)


def mapped_frames(data: bytes) -> None:
    """A row of frames into the node of one of the cars."""
    chosen = data[0] % len(NODES) if data else 0
    node, messages = copy.deepcopy(NODES[chosen]), tuple(PLANS[chosen].messages.values())
    now_ns = 0
    whole = (len(data) - 1) // STEP.size * STEP.size if data else 0
    for how, which, later, length, content in STEP.iter_unpack(data[1 : 1 + whole]):
        now_ns += LATER_NS[later % len(LATER_NS)]
        message = messages[which % len(messages)]
        payload = bytearray(content.ljust(message.length, b"\0")[: message.length])
        if how & 2 and message.protection is not None:
            message.protection.protector().protect(payload)
        node.feed(message.frame_id, bytes(payload[: length if how & 1 else None]), now_ns)
    seen = node.measurement(now_ns)
    numbers = (*seen.wheel_speed_radps, *seen.motor_speed_radps, *seen.driver_torque_nm)
    if not all(map(math.isfinite, numbers)):
        raise AssertionError(f"{seen} holds a number that is none")
