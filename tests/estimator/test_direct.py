import pytest
from factories import measurement

from tcs_hil.estimator import Estimator
from tcs_hil.model.vehicle import Vehicle

VEHICLE = Vehicle()


def test_speed_is_the_mean_of_the_rear_wheels() -> None:
    estimate = Estimator(VEHICLE).update(measurement(wheel_speed_radps=(30.0, 25.0, 19.0, 21.0)))
    assert estimate.vehicle_speed_mps == pytest.approx(20.0 * 0.318)


def test_slip_of_each_front_wheel_follows_the_modified_definition() -> None:
    left, right = (
        Estimator(VEHICLE).update(measurement(wheel_speed_radps=(25.0, 20.0, 20.0, 20.0))).wheels
    )
    rim_mps = 25.0 * 0.318
    assert left.slip_speed_mps == pytest.approx(5.0 * 0.318)
    assert left.slip_ratio == pytest.approx(5.0 * 0.318 * rim_mps / (rim_mps**2 + 0.1))
    assert right.slip_ratio == pytest.approx(0.0)


def test_an_invalid_rear_wheel_is_left_out() -> None:
    estimate = Estimator(VEHICLE).update(
        measurement(
            wheel_speed_radps=(20.0, 20.0, 90.0, 20.0), wheel_speed_valid=(True, True, False, True)
        )
    )
    assert estimate.vehicle_speed_mps == pytest.approx(20.0 * 0.318)


def test_with_both_rear_wheels_invalid_the_last_speed_is_held() -> None:
    estimator = Estimator(VEHICLE)
    estimator.update(measurement())
    estimate = estimator.update(
        measurement(
            wheel_speed_radps=(20.0, 20.0, 0.0, 0.0), wheel_speed_valid=(True, True, False, False)
        )
    )
    assert estimate.vehicle_speed_mps == pytest.approx(20.0 * 0.318)


def test_motor_state_goes_to_its_own_side() -> None:
    left, right = Estimator(VEHICLE).update(measurement(motor_torque_nm=(10.0, 20.0))).wheels
    assert (left.motor_torque_nm, right.motor_torque_nm) == (10.0, 20.0)
