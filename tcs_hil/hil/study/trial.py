"""One point of a study: the scenario and service it stands for, and what came of them."""

from __future__ import annotations

from typing import Any

import msgspec

from plant_emulator.scenario import Scenario
from tcs_hil.config import convert
from tcs_hil.errors import ConfigError, TcsError, offer
from tcs_hil.hil.batch import Job, judge
from tcs_hil.hil.metrics import Score
from tcs_hil.hil.study.design import Point
from tcs_hil.hil.study.plan import Plan, Success, Value
from tcs_hil.service.settings import ServiceConfig

SERVICE = "service"
UNKNOWN_TO_QUARTER_CAR = (
    *("vehicle.body.", "vehicle.tyre.", "vehicle.driveline."),
    *("sensors.", "bus."),
)
"""A quarter car has none of these: to vary them would show a space without any difference."""

Row = dict[str, Any]


def job(plan: Plan, point: Point, index: int) -> Job:
    """The run that a point stands for.

    Raises:
        ConfigError: a key does not exist, takes no such value or has no effect.
    """
    scenario, service = _plain(plan.scenario), _plain(plan.study.service)
    for axis, value in zip(plan.study.vary, point, strict=True):
        if scenario["vehicle"]["variant"] == "quarter-car":
            _refuse_on_quarter_car(axis.key)
        root, _, rest = axis.key.partition(".")
        table, key = (service, rest) if root == SERVICE else (scenario, axis.key)
        _put(table, key, value, axis.key)
    source = f"point {index}"
    config = convert(service, ServiceConfig, source)
    scenario["controller"] = {"kind": config.controller, "preset": config.control.preset}
    return Job(source, convert(scenario, Scenario, source), config)


def run(plan: Plan, point: Point, index: int) -> Row:
    """Drive one point and judge it: a row of the table, its values under their keys.

    A run that breaks is a row, too, with what was said; it is no success.
    """
    row: Row = {"index": index}
    row |= {axis.key: value for axis, value in zip(plan.study.vary, point, strict=True)}
    try:
        score = judge(job(plan, point, index))
    except TcsError as error:
        return row | _nothing() | {"error": str(error)}
    return row | _figures(score) | {"success": _succeeds(score, plan.study.success), "error": ""}


def _figures(score: Score) -> Row:
    cycle = score.limit_cycle
    return {
        "rmse_ratio": float(score.slip.rmse_ratio),
        "peak_slip_ratio": float(score.slip.peak_ratio),
        "gain_ratio": float(score.gain_ratio),
        "spin_s": float(score.spin_s),
        "limit_cycle_hz": 0.0 if cycle is None else float(cycle.frequency_hz),
    }


def _nothing() -> Row:
    names = ("rmse_ratio", "peak_slip_ratio", "gain_ratio", "spin_s", "limit_cycle_hz")
    return {**dict.fromkeys(names, float("nan")), "success": False}


def _succeeds(score: Score, success: Success) -> bool:
    """Whether a run keeps every limit; what could not be measured keeps none and breaks none."""
    slip = score.slip
    broken = (
        not success.limit_cycle and score.limit_cycle is not None,
        success.spin_s is not None and score.spin_s > success.spin_s,
        success.rmse_ratio is not None and slip.rmse_ratio > success.rmse_ratio,
        success.peak_slip_ratio is not None and slip.peak_ratio > success.peak_slip_ratio,
        success.gain_ratio is not None and score.gain_ratio < success.gain_ratio,
    )
    return not any(broken)


def _refuse_on_quarter_car(key: str) -> None:
    if key.startswith(UNKNOWN_TO_QUARTER_CAR):
        raise ConfigError(f'`{key}` is nothing to the quarter car: set vehicle = "vehicle"')


def _plain(struct: msgspec.Struct) -> Any:
    return msgspec.json.decode(msgspec.json.encode(struct))


def _put(table: Any, path: str, value: Value, key: str) -> None:
    """Set ``path``, names and places in lists joined by dots, in plain tables."""
    *way, last = path.split(".")
    for name in way:
        table = table[_place(table, name, key)]
    table[_place(table, last, key)] = value


def _place(table: Any, name: str, key: str) -> int | str:
    """Where ``name`` is in a table; one that is not there is not made."""
    if isinstance(table, list) and name.isdecimal() and int(name) < len(table):
        return int(name)
    if isinstance(table, dict) and name in table:
        return name
    hint = offer(name, table) if isinstance(table, dict) else ""
    raise ConfigError(f"there is no `{key}` to vary{hint}")
