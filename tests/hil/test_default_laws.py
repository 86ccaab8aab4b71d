"""The default laws on the whole car: driveline, toothed sensors, delay; levels to hold."""

from __future__ import annotations

import pytest
from msgspec.structs import replace

from plant_emulator.scenario import load_scenario
from tcs_hil.control.settings import ControlSettings, DefaultSettings, DelaySettings
from tcs_hil.hil.metrics import Score, score
from tcs_hil.hil.simulation import simulate
from tcs_hil.model.vehicle import Vehicle
from tcs_hil.service.settings import ControllerName, ServiceConfig


def judge(manoeuvre: str, config: ServiceConfig, duration_s: float | None = None) -> Score:
    scenario = load_scenario(manoeuvre).with_variant("vehicle")
    if duration_s is not None:
        scenario = replace(scenario, duration_s=duration_s)
    truth = simulate(scenario, config).truth
    return score(truth, scenario, config.control.slip_reference, Vehicle())


@pytest.mark.parametrize("controller", ["kmpc", "nmpc"])
@pytest.mark.parametrize(
    ("manoeuvre", "rmse", "peak"), [("manoeuvre-1", 0.015, 0.20), ("manoeuvre-2", 0.035, 0.28)]
)
def test_on_a_real_bus_the_default_laws_hold_the_reference(
    controller: ControllerName, manoeuvre: str, rmse: float, peak: float
) -> None:
    run = judge(manoeuvre, ServiceConfig(controller=controller))
    assert run.slip.rmse_ratio <= rmse
    assert run.slip.peak_ratio <= peak
    assert run.slip.chatter_nmps <= 300.0
    assert run.gain_ratio >= 0.97
    assert run.limit_cycle is None


@pytest.mark.parametrize("controller", ["kmpc", "nmpc"])
@pytest.mark.parametrize("delay_s", [0.004, 0.008])
def test_a_delay_believed_wrong_by_a_period_makes_no_limit_cycle(
    controller: ControllerName, delay_s: float
) -> None:
    delay = DelaySettings(delay_s=delay_s, measured=False)
    control = ControlSettings(default=DefaultSettings(delay=delay))
    run = judge("manoeuvre-1", ServiceConfig(controller=controller, control=control), 1.5)
    assert run.limit_cycle is None
    assert run.slip.peak_ratio < 0.3


def test_a_delay_believed_wrong_at_first_is_measured() -> None:
    delay = DelaySettings(delay_s=0.002)
    control = ControlSettings(default=DefaultSettings(delay=delay))
    scenario = replace(load_scenario("manoeuvre-1").with_variant("vehicle"), duration_s=2.0)
    commands = simulate(scenario, ServiceConfig(controller="nmpc", control=control)).commands
    # 1.7 ms until the service answers, 0.3 ms of bus, 4 ms of gateway and inverter.
    assert commands[-1].road.loop_delay_s == pytest.approx(0.006, abs=0.0005)


def test_the_friction_of_the_road_is_told_with_confidence() -> None:
    scenario = replace(load_scenario("manoeuvre-1").with_variant("vehicle"), duration_s=1.5)
    road = simulate(scenario, ServiceConfig(controller="nmpc")).commands[-1].road
    assert road.friction_ratio == pytest.approx((0.3, 0.3), abs=0.03)
    assert min(road.confidence_ratio) > 0.8
