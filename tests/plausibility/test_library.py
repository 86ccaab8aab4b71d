"""No healthy car is ever accused, and every faulty sensor that can be told is found in time."""

from __future__ import annotations

import msgspec
import pytest
from plausibility.driving import PERIOD_S, suspects_of

from benchmarks.random_plants import draw, scenario_of
from plant_emulator.faults import Fault
from plant_emulator.scenario import Scenario, list_scenarios, load_scenario
from tcs_hil.signals import Suspect

TIP_IN = "tip-in-050-kmph"
HEALTHY = [item.name for item in list_scenarios() if item.suite not in ("fault", "paper")]
LONGEST_S = 4.0
START_S, END_S = 1.0, 1.8
HEALED_S = 1.1


@pytest.mark.parametrize("name", HEALTHY)
def test_no_car_of_the_library_is_accused_however_its_wheels_spin(name: str) -> None:
    scenario = load_scenario(name)
    short = msgspec.structs.replace(scenario, duration_s=min(scenario.duration_s, LONGEST_S))
    assert set(suspects_of(short)) == {0}


@pytest.mark.parametrize("index", range(5))
def test_no_car_of_the_campaign_is_accused(index: int) -> None:
    assert set(suspects_of(scenario_of(draw(2026, index)))) == {0}


def with_fault(name: str, target: str, kind: str, **values: float) -> Scenario:
    fault = Fault(target=target, kind=kind, start_s=START_S, end_s=END_S, **values)
    scenario = msgspec.structs.replace(load_scenario(name), fault=(fault,), end_distance_m=None)
    return msgspec.structs.replace(scenario, duration_s=END_S + HEALED_S)


@pytest.mark.parametrize(
    ("name", "target", "kind", "values", "within_s", "who"),
    [
        (TIP_IN, "WheelSpeedFL", "stuck", {}, 0.1, Suspect.WHEEL_FL),
        (TIP_IN, "WheelSpeedFR", "garbage", {}, 0.1, Suspect.WHEEL_FR),
        (TIP_IN, "WheelSpeedFL", "wrong", {"scale": 0.5}, 0.06, Suspect.WHEEL_FL),
        (TIP_IN, "WheelSpeedFR", "wrong", {"offset": 30.0}, 0.06, Suspect.WHEEL_FR),
        ("launch-mu-060", "WheelSpeedRL", "stuck", {}, 0.3, Suspect.WHEEL_RL),
        (TIP_IN, "WheelSpeedRL", "garbage", {}, 0.02, Suspect.WHEEL_RL),
        (TIP_IN, "WheelSpeedRR", "wrong", {"scale": 1.2}, 0.02, Suspect.WHEEL_RR),
        (TIP_IN, "WheelSpeedRR", "wrong", {"scale": 0.0}, 0.02, Suspect.WHEEL_RR),
        (TIP_IN, "MotorSpeedL", "stuck", {}, 0.1, Suspect.MOTOR_LEFT),
        (TIP_IN, "MotorSpeedR", "garbage", {"high": 1000.0}, 0.1, Suspect.MOTOR_RIGHT),
        (TIP_IN, "MotorSpeedR", "wrong", {"scale": 1.5}, 0.06, Suspect.MOTOR_RIGHT),
        (TIP_IN, "MotorTorqueL", "garbage", {}, 0.1, Suspect.MOTOR_LEFT),
        (TIP_IN, "MotorTorqueR", "off", {}, 0.12, Suspect.MOTOR_RIGHT),
        (TIP_IN, "DriverTorqueRequestL", "off", {}, 0.13, Suspect.DRIVER),
        (TIP_IN, "VehicleAccelX", "garbage", {}, 0.02, Suspect.ACCELEROMETER),
    ],
)
def test_a_faulty_sensor_is_found_in_time_and_believed_again_after_it(
    name: str, target: str, kind: str, values: dict[str, float], within_s: float, who: Suspect
) -> None:
    suspects = suspects_of(with_fault(name, target, kind, **values))
    start = round(START_S / PERIOD_S)
    assert set(suspects[:start]) == {0}
    found = next(tick for tick, bits in enumerate(suspects) if bits)
    assert (found - start) * PERIOD_S <= within_s
    assert suspects[found] == who
    assert suspects[-1] == 0
