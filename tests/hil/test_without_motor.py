"""A car whose motors say nothing on the bus: both default laws leave it to the PI."""

from __future__ import annotations

import pytest
from msgspec.structs import replace

from plant_emulator.scenario import load_scenario
from tcs_hil.control.settings import ControlSettings
from tcs_hil.hil.metrics import Score, score
from tcs_hil.hil.simulation import simulate
from tcs_hil.model.vehicle import Vehicle
from tcs_hil.service.settings import ControllerName, ServiceConfig

ALWAYS = [replace(load_scenario("fault-wrong-crc").fault[0], start_s=0.0, end_s=10.0)]
"""No motor state is ever believed."""


def judged(law: ControllerName, name: str) -> Score:
    scenario = replace(load_scenario(name).with_variant("vehicle"), fault=tuple(ALWAYS))
    truth = simulate(scenario, ServiceConfig(controller=law)).truth
    return score(truth, scenario, ControlSettings().slip_reference, Vehicle())


@pytest.mark.parametrize("law", ["kmpc", "nmpc"])
def test_a_launch_without_motors_on_the_bus_is_held_as_by_the_pi(law: ControllerName) -> None:
    held, by_the_pi = judged(law, "manoeuvre-1"), judged("pi", "manoeuvre-1")
    assert held.slip == by_the_pi.slip
    assert held.gain_ratio > 0.9
    assert held.slip.peak_ratio < 0.6
