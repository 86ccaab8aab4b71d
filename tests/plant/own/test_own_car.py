"""Anybody's own car as the plant."""

from pathlib import Path

import numpy as np
import pytest

from plant_emulator.plant import Plant
from plant_emulator.scenario import load_scenario
from plant_emulator.session import check_own_car
from plant_emulator.truth import BODY_SPEED, DISTANCE, SLIP_RATIO
from tcs_hil.errors import ConfigError
from tcs_hil.hil.simulation import simulate
from tcs_hil.service.settings import ServiceConfig
from tcs_hil.signals import TorqueLimits

from .unit import build_unit

HERE = Path(__file__).parent
SCENARIO = """
description = "own car"
duration_s = 0.5
start_speed_kmph = 36.0
[[road]]
mu = 0.3
[driver]
request = [[0.0, 150.0]]
"""


@pytest.fixture
def scenario(tmp_path):
    def write(vehicle):
        path = tmp_path / "own.toml"
        path.write_text(f"{SCENARIO}\n[vehicle]\n{vehicle}\n")
        return load_scenario(path)

    return write


def drive(scenario, limits=None):
    plant = Plant(scenario)
    rows = []
    while not plant.finished:
        plant.step(limits, 0.002)
        rows.append(plant.row.copy())
    return np.array(rows)


@pytest.mark.parametrize("version", [2, 3])
def test_a_unit_drives_as_the_car_it_was_made_from(version, scenario, tmp_path):
    build_unit(tmp_path / "car.fmu", version)
    own = drive(scenario('variant = "own"\nsource = "car.fmu"'))
    shipped = drive(scenario('variant = "quarter-car"'))
    # Euler in the unit, Runge-Kutta in the plant, both at 0.1 ms.
    assert own[:, BODY_SPEED] == pytest.approx(shipped[:, BODY_SPEED], abs=1e-3)
    assert own[:, SLIP_RATIO] == pytest.approx(shipped[:, SLIP_RATIO], abs=2e-3)
    # The unit does not tell its distance: it follows from its speed.
    assert own[:, DISTANCE] == pytest.approx(shipped[:, DISTANCE], abs=1e-3)


def test_the_service_holds_the_slip_of_a_unit(scenario, tmp_path):
    build_unit(tmp_path / "car.fmu", 2)
    driven = scenario('variant = "own"\nsource = "car.fmu"\n[sensors]\nteeth = 0')
    held = simulate(driven, ServiceConfig(controller="pi")).truth["slip_ratio"][-50:, 0]
    loose = simulate(driven, ServiceConfig(controller="off")).truth["slip_ratio"][-50:, 0]
    assert held.max() < 0.3 < loose.max()


def test_variables_may_be_called_as_they_like(scenario, tmp_path):
    build_unit(tmp_path / "car.fmu", 2, {"speed_mps": "v", "torque_demand_fl_nm": "tau.L"})
    names = 'names = { speed_mps = "v", torque_demand_fl_nm = "tau.L" }'
    rows = drive(scenario(f'variant = "own"\nsource = "car.fmu"\n[vehicle.fmu]\n{names}'))
    assert rows[-1, BODY_SPEED] > 10.0


def test_parameters_are_set_before_the_start(scenario, tmp_path):
    build_unit(tmp_path / "car.fmu", 3)
    heavy = "[vehicle.fmu]\nstart = { mass_kg = 2800.0 }"
    light = drive(scenario('variant = "own"\nsource = "car.fmu"'), TorqueLimits(20.0, 20.0))
    laden = drive(
        scenario(f'variant = "own"\nsource = "car.fmu"\n{heavy}'), TorqueLimits(20.0, 20.0)
    )
    gained = [rows[-1, BODY_SPEED] - rows[0, BODY_SPEED] for rows in (light, laden)]
    assert gained[0] == pytest.approx(2.0 * gained[1], rel=0.05)


@pytest.mark.parametrize(
    ("vehicle", "named"),
    [
        ('source = "car.fmu"\n[vehicle.fmu]\nnames = { speed_mps = "v" }', "no real variable v"),
        ('source = "car.fmu"\n[vehicle.fmu]\nstart = { colour = 1.0 }', "no real variable colour"),
        ('source = "nowhere.fmu"', "nowhere.fmu is no .fmu and no file.py:Class that exists"),
        ('source = "own.toml:Car"', "own.toml: cannot be run"),
        (f'source = "{HERE / "brick.py"}:Stone"', "brick.py: has no Stone"),
        ('source = "nowhere.py:Car"', "nowhere.py:Car is no .fmu and no file.py:Class"),
        (f'source = "{HERE / "brick.py"}"', "brick.py is no .fmu and no file.py:Class"),
        (f'source = "{HERE / "brick.py"}:truth"', "cannot be made of a scenario"),
        ('variant = "vehicle"\nsource = "car.fmu"', '`source` is for `variant = "own"`'),
        ("", "needs the file of the car as `source`"),
    ],
)
def test_a_car_that_cannot_be_had_is_refused_in_one_sentence(vehicle, named, scenario, tmp_path):
    build_unit(tmp_path / "car.fmu", 2)
    with pytest.raises(ConfigError, match=named):
        Plant(scenario(vehicle if "variant" in vehicle else f'variant = "own"\n{vehicle}'))


CAR = """
class Car:
    def __init__(self, scenario): pass
    def advance(self, demand, time_s, duration_s): {advance}
    def observe(self, demand, row): {observe}
"""


@pytest.mark.parametrize(
    ("advance", "observe", "named"),
    [
        ("1 / 0", "pass", "car.py:Car: fails in `advance` .ZeroDivisionError"),
        ("pass", "row.speed", "car.py:Car: fails in `observe` .AttributeError"),
        ("pass", "row[2] = float('nan')", "car.py:Car: tells no number as speed_mps"),
    ],
)
def test_a_class_that_fails_is_told_by_its_name(advance, observe, named, scenario, tmp_path):
    (tmp_path / "car.py").write_text(CAR.format(advance=advance, observe=observe))
    own = scenario('variant = "own"\nsource = "car.py:Car"')
    with pytest.raises(ConfigError, match=named):
        check_own_car(own)


def test_a_class_in_a_file_is_a_car(scenario):
    plant = scenario(f'variant = "own"\nsource = "{HERE / "brick.py"}:Brick"')
    rows = drive(plant, TorqueLimits(70.0, 70.0))
    # 2 motors of 70 Nm through a gear of 3 on 0.318 m push 1400 kg for half a second.
    assert rows[-1, BODY_SPEED] == pytest.approx(10.0 + 0.5 * 2 * 70 * 3 / 0.318 / 1400, abs=0.1)


def test_the_documented_example_is_the_one_tested():
    documented = (HERE.parents[2] / "docs" / "plant.md").read_text()
    assert (HERE / "brick.py").read_text() in documented
