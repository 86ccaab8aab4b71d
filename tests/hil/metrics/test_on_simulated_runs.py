"""The limit-cycle detector on runs one has looked at, rather than on made-up signals."""

import pytest

from plant_emulator.scenario import Variant, load_scenario
from tcs_hil.control.settings import ControlSettings
from tcs_hil.hil.metrics import Score, score
from tcs_hil.hil.simulation import simulate
from tcs_hil.model.vehicle import Vehicle
from tcs_hil.service.settings import ControllerName, ServiceConfig

LEAST_VISIBLE = {"slip_ratio": 0.1, "motor_torque_nm": 100.0}


def judge(manoeuvre: str, variant: Variant, controller: ControllerName) -> Score:
    scenario = load_scenario(manoeuvre).with_variant(variant)
    config = ServiceConfig(controller=controller, control=ControlSettings(preset="paper"))
    return score(simulate(scenario, config).truth, scenario, 0.1, Vehicle())


@pytest.mark.parametrize("controller", ["kmpc", "nmpc"])
def test_the_papers_laws_behind_a_bus_and_a_driveline_limit_cycle(
    controller: ControllerName,
) -> None:
    cycle = judge("manoeuvre-1", "vehicle", controller).limit_cycle
    assert cycle is not None
    assert cycle.swing > LEAST_VISIBLE[cycle.signal]


def test_the_pi_on_the_papers_car_does_not_even_over_jumps_of_friction() -> None:
    assert judge("manoeuvre-2", "quarter-car", "pi").limit_cycle is None


def test_a_car_without_control_spins_but_does_not_cycle() -> None:
    run = judge("manoeuvre-1", "vehicle", "off")
    assert run.limit_cycle is None
    assert run.spin_s > 2.0
    assert 0.8 < run.gain_ratio < 0.9  # sliding gives 86 % of the peak force


def test_held_at_the_reference_a_run_gains_what_the_curve_gives_there() -> None:
    # At slip 0.1 the paper's tyre gives 99.4 % of its peak.
    assert judge("manoeuvre-1", "quarter-car", "pi").gain_ratio == pytest.approx(0.994, abs=0.005)
