"""The baseline PI: hand-over, limits and schedule."""

from __future__ import annotations

import pytest

from tcs_hil.control.pi import PiController
from tcs_hil.control.settings import ControlSettings
from tests.control.recorder import wheel_at


@pytest.fixture
def controller() -> PiController:
    return PiController(ControlSettings(preset="paper"))


def test_it_takes_over_from_the_driver_without_a_bump(controller: PiController) -> None:
    assert controller.step(wheel_at(5.0, 0.05), 150.0).torque_nm == 150.0
    assert controller.step(wheel_at(5.0, 0.09), 150.0).torque_nm == pytest.approx(150.0, abs=0.5)


def test_it_gives_all_torque_back_once_the_wheel_grips(controller: PiController) -> None:
    for _ in range(20):
        reduced = controller.step(wheel_at(5.0, 0.2), 150.0).torque_nm
    assert reduced < 110.0
    for _ in range(500):
        returned = controller.step(wheel_at(5.0, 0.02), 150.0).torque_nm
    assert returned == 150.0


def test_a_dip_below_the_entry_slip_does_not_hand_the_request_back_at_once(
    controller: PiController,
) -> None:
    for _ in range(20):
        controller.step(wheel_at(5.0, 0.2), 150.0)
    assert controller.step(wheel_at(5.0, 0.07), 150.0).torque_nm < 140.0


def test_an_integral_held_down_by_a_small_request_does_not_wind_up(
    controller: PiController,
) -> None:
    for _ in range(500):
        controller.step(wheel_at(5.0, 0.095), 30.0)
    assert controller.step(wheel_at(5.0, 0.12), 200.0).torque_nm < 31.0


def test_the_gain_rises_with_speed_up_to_its_ceiling() -> None:
    def drop(speed_mps: float) -> float:
        controller = PiController(ControlSettings(preset="paper"))
        controller.step(wheel_at(speed_mps, 0.1), 150.0)
        return 150.0 - controller.step(wheel_at(speed_mps, 0.15), 150.0).torque_nm

    assert drop(1.0) < drop(5.0) < drop(15.0)
    assert drop(30.0) == pytest.approx(drop(15.0), rel=1e-3)  # kappa's epsilon fades with speed


def test_a_slip_ratio_without_a_slip_speed_does_not_wake_it_near_standstill() -> None:
    controller = PiController(ControlSettings())
    assert controller.step(wheel_at(0.5, 0.15), 150.0).torque_nm == 150.0
    for _ in range(20):
        reduced = controller.step(wheel_at(2.0, 0.15), 150.0).torque_nm
    assert reduced < 150.0
