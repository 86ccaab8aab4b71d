"""Which node the service is: of our own DBC, or of another car's through a signal map."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from tcs_hil.canbus.database import load_database, parse_dbc
from tcs_hil.canbus.mapping.advice import look_over
from tcs_hil.canbus.mapping.findings import Findings
from tcs_hil.canbus.mapping.node import MappedNode
from tcs_hil.canbus.mapping.plan import WHEEL_INPUTS, Plan
from tcs_hil.canbus.mapping.resolve import resolve
from tcs_hil.canbus.tcs_node import TcsNode
from tcs_hil.errors import ConfigError
from tcs_hil.runtime.seams import Node
from tcs_hil.service.map_advice import advise
from tcs_hil.service.settings import ServiceConfig

NS_PER_S = 1_000_000_000


@dataclass(frozen=True, slots=True)
class BusEnd:
    """The service's end of the bus, and the frames its triggers may wait for.

    ``last_wheel_id`` completes a cycle of wheel speeds; ``bench_tick_id`` is that
    of lockstep.
    """

    node: Node
    last_wheel_id: int
    bench_tick_id: int


def bus_end(config: ServiceConfig) -> BusEnd:
    """Build the node that the configuration asks for.

    Raises:
        DatabaseError: The DBC cannot be used.
        ConfigError: The signal map does not fit the DBC, or the period our own.
    """
    return _own(config) if config.map is None else _mapped(config)


def examine_map(config: ServiceConfig) -> tuple[Plan, Findings]:
    """Look the signal map over; the plan is whole only where the findings have no errors.

    Raises:
        DatabaseError: The DBC cannot be read.
        ConfigError: There is no map, or no DBC of the car to go with it.
    """
    if config.map is None:
        raise ConfigError("map: is missing; it says which signals of the DBC mean what")
    if config.bus.database is None:
        raise ConfigError("bus.database: is missing; a signal map needs the DBC of the car")
    findings = Findings()
    _, dbc = parse_dbc(Path(config.bus.database))
    plan = resolve(dbc, config.map, config.vehicle, findings)
    look_over(plan, dbc, config.map, config.vehicle, findings)
    advise(plan, config, findings)
    return plan, findings


def _own(config: ServiceConfig) -> BusEnd:
    database = load_database(None if config.bus.database is None else Path(config.bus.database))
    messages = database.messages
    # Limits go out with every tick, so a tick is their cycle.
    cycle_s = messages["TorqueLimit"].cycle_ns / NS_PER_S
    if round(config.control.period_s * NS_PER_S) != messages["TorqueLimit"].cycle_ns:
        raise ConfigError(
            f"control.period_s: {config.control.period_s} s is not the cycle of TorqueLimit "
            f"in the DBC, {cycle_s} s"
        )
    rear, bench = messages["WheelSpeedsRear"], messages["BenchTick"]
    return BusEnd(TcsNode(database), rear.frame_id, bench.frame_id)


def _mapped(config: ServiceConfig) -> BusEnd:
    plan, findings = examine_map(config)
    if findings.errors:
        first, *others = findings.errors
        more = f" (and {len(others)} more: tcs-hil map check)" if others else ""
        raise ConfigError(f"map.{first.key}: {first.sentence}{more}")
    bench = load_database().messages["BenchTick"]
    return BusEnd(MappedNode(plan), plan.sources(WHEEL_INPUTS)[-1].frame_id, bench.frame_id)
