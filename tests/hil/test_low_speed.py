"""Walking pace with toothed sensors: no limit cycle, no stand-still on ice, no bump in between."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
from msgspec.structs import replace
from numpy.typing import NDArray

from plant_emulator.driver import Driver
from plant_emulator.scenario import load_scenario
from tcs_hil.control.settings import ControlSettings
from tcs_hil.hil.metrics import Score, score
from tcs_hil.hil.simulation import Simulation, simulate
from tcs_hil.model.vehicle import Vehicle
from tcs_hil.service.settings import ControllerName, ServiceConfig

FLOAT = NDArray[np.float64]
LAWS: tuple[ControllerName, ...] = ("kmpc", "nmpc")

ICE = replace(load_scenario("launch-mu-008").with_variant("vehicle"), duration_s=2.0)
SNOW = replace(
    load_scenario("manoeuvre-1").with_variant("vehicle"),
    duration_s=1.8,
    driver=Driver(request=((0.1, 0.0), (0.6, 250.0), (1.1, 250.0), (1.6, 60.0))),
)
"""From 2 km/h on, the driver asking for twice what the tyres carry and then for half of it."""

JUMP_NM = 5.0
"""Most by which a motor's torque may move in the tick of a hand-over: 2500 Nm/s, an eighth of the
rate the gate would let through, and a fiftieth of the motor's torque."""

ROADS = {"ice": ICE, "snow": SNOW}


@cache
def driven(law: ControllerName, road: str) -> Simulation:
    return simulate(ROADS[road], ServiceConfig(controller=law))


def judged(law: ControllerName, road: str) -> Score:
    reference = ControlSettings().slip_reference
    return score(driven(law, road).truth, ROADS[road], reference, Vehicle())


def granted_nm(run: Simulation) -> FLOAT:
    """What each motor may give (ticks, 2): the lower of limit and request."""
    request_nm = np.interp(
        np.arange(len(run.commands)) * 0.002, run.truth["time_s"], run.truth["request_nm"]
    )
    limits = np.array([command.limits for command in run.commands])
    return np.minimum(limits, request_nm[:, None])


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("road", ROADS)
def test_no_limit_cycle_at_walking_pace(law: ControllerName, road: str) -> None:
    assert judged(law, road).limit_cycle is None


@pytest.mark.parametrize("law", LAWS)
def test_a_car_on_ice_is_not_stuck_at_standstill(law: ControllerName) -> None:
    gained = judged(law, "ice")
    assert gained.gain_ratio > 0.85
    assert gained.spin_s < 0.2


@pytest.mark.parametrize("law", LAWS)
def test_the_law_takes_over_and_lets_go_without_a_bump(law: ControllerName) -> None:
    run = driven(law, "snow")
    active = np.array([command.active for command in run.commands])
    assert active.any(axis=0).all()
    assert not active[-1].any()
    steps_nm = np.abs(np.diff(granted_nm(run), axis=0))
    hand_over = active[1:] != active[:-1]
    assert steps_nm[hand_over].max() <= JUMP_NM
