"""The nominal quarter car without delay: what the paper promises, through codec and pipeline."""

import numpy as np
import pytest

from plant_emulator.scenario import load_scenario
from tcs_hil.control.settings import ControlSettings
from tcs_hil.hil.metrics import SlipMetrics, slip_metrics
from tcs_hil.hil.simulation import Simulation, simulate
from tcs_hil.model.vehicle import Vehicle
from tcs_hil.service.settings import ControllerName, ServiceConfig
from tcs_hil.signals import TcsState

PAPER = ControlSettings(preset="paper")
CITY_SPEED_MPS = 40.0 / 3.6


def run(manoeuvre: str, controller: ControllerName) -> Simulation:
    scenario = load_scenario(manoeuvre).with_variant("quarter-car")
    return simulate(scenario, ServiceConfig(controller=controller, control=PAPER))


def judge(manoeuvre: str, controller: ControllerName, up_to_mps: float = np.inf) -> SlipMetrics:
    return slip_metrics(run(manoeuvre, controller).truth, 0.1, Vehicle(), up_to_mps)


@pytest.mark.parametrize(
    ("controller", "rmse", "peak"), [("kmpc", 0.006, 0.135), ("nmpc", 0.001, 0.11)]
)
def test_on_constant_friction_the_papers_laws_hold_the_reference(
    controller: ControllerName, rmse: float, peak: float
) -> None:
    metrics = judge("manoeuvre-1", controller)
    assert metrics.rmse_ratio <= rmse
    assert metrics.peak_ratio <= peak


@pytest.mark.parametrize(("controller", "rmse"), [("kmpc", 0.012), ("nmpc", 0.010)])
def test_on_varying_friction_they_hold_it_up_to_40_kmph(
    controller: ControllerName, rmse: float
) -> None:
    assert judge("manoeuvre-2", controller, CITY_SPEED_MPS).rmse_ratio <= rmse


@pytest.mark.parametrize("manoeuvre", ["manoeuvre-1", "manoeuvre-2"])
def test_without_control_the_wheels_spin(manoeuvre: str) -> None:
    assert judge(manoeuvre, "off").peak_ratio > 0.9


def test_no_ceiling_ever_exceeds_the_request_the_service_has_seen() -> None:
    simulation = run("manoeuvre-2", "kmpc")
    # The request on the bus is up to one cycle of DriverRequest (5 ticks) old.
    request_nm = simulation.truth["request_nm"]
    newest_nm = [request_nm[max(k - 4, 0) : k + 1].max() for k in range(len(simulation.commands))]
    for command, seen_nm in zip(simulation.commands, newest_nm, strict=True):
        for limit_nm in command.limits:
            assert limit_nm == np.inf or limit_nm <= seen_nm + 0.125  # one bit of the request


def test_the_service_is_active_while_it_holds_a_motor_and_never_faulty() -> None:
    states = {command.state for command in run("manoeuvre-1", "nmpc").commands}
    assert states == {TcsState.INIT, TcsState.STANDBY, TcsState.ACTIVE}
