import numpy as np
import pytest

from tcs_hil.hil.metrics import longest_spin_s, reachable, slip_metrics
from tcs_hil.model.vehicle import Vehicle
from tests.hil.truths import steady

VEHICLE = Vehicle()


def test_a_constant_error_is_its_own_rmse() -> None:
    rows = steady()
    rows["slip_ratio"][:, 1] = 0.13
    assert slip_metrics(rows, 0.1, VEHICLE).rmse_ratio == pytest.approx(0.03)


def test_the_drivers_ramp_does_not_count_for_rmse_but_does_for_the_peak() -> None:
    rows = steady()
    rows["request_nm"][:300] = np.linspace(200.0, 249.0, 300)
    rows["slip_ratio"][:299, 0] = 0.4
    metrics = slip_metrics(rows, 0.1, VEHICLE)
    assert metrics.rmse_ratio == pytest.approx(0.0)
    assert metrics.peak_ratio == pytest.approx(0.4)


def test_a_second_ramp_counts() -> None:
    rows = steady()
    rows["request_nm"][500:600] = np.linspace(200.0, 249.0, 100)
    rows["slip_ratio"][500:600, 0] = 0.4
    assert slip_metrics(rows, 0.1, VEHICLE).rmse_ratio == pytest.approx(0.3 * np.sqrt(0.1))


@pytest.mark.parametrize(("mu", "can"), [(0.15, True), (0.3, True), (0.6, False)])
def test_the_papers_motor_reaches_the_reference_up_to_mu_just_below_0_6(
    mu: float, can: bool
) -> None:
    rows = steady(1)
    rows["mu"] = mu
    assert reachable(rows, 0.1, VEHICLE).all() == can


def test_at_speed_the_motors_power_decides_what_can_be_reached() -> None:
    rows = steady(2)
    rows["speed_mps"] = 10.0, 50.0  # 133 Nm are needed, at 50 m/s 80 kW give 153 and 60 kW 115
    assert reachable(rows, 0.1, VEHICLE, 80e3).tolist() == [[True, True], [True, True]]
    assert reachable(rows, 0.1, VEHICLE, 60e3).tolist() == [[True, True], [False, False]]


def test_what_cannot_be_reached_is_left_out() -> None:
    rows = steady()
    rows["mu"][500:] = 0.6
    rows["slip_ratio"][500:, :2] = 0.06
    metrics = slip_metrics(rows, 0.1, VEHICLE)
    assert metrics.rmse_ratio == pytest.approx(0.0)
    assert metrics.reachable_share == pytest.approx(0.5)


def test_a_wheel_whose_reference_is_never_reachable_leaves_the_other_ones_rmse() -> None:
    rows = steady()
    rows["mu"][:, 0] = 0.6
    rows["slip_ratio"][:, 1] = 0.13
    assert slip_metrics(rows, 0.1, VEHICLE).rmse_ratio == pytest.approx(0.03)


def test_without_a_sample_that_counts_there_is_no_rmse() -> None:
    rows = steady()
    rows["request_nm"] = 10.0
    assert np.isnan(slip_metrics(rows, 0.1, VEHICLE).rmse_ratio)


def test_chatter_is_the_mean_rate_of_the_torque() -> None:
    rows = steady()
    rows["motor_torque_nm"][::2, 0] += 10.0
    assert slip_metrics(rows, 0.1, VEHICLE).chatter_nmps == pytest.approx(10.0 / 0.002)


def test_a_speed_bound_leaves_faster_samples_out() -> None:
    rows = steady()
    rows["speed_mps"][500:] = 20.0
    rows["slip_ratio"][500:, :2] = 0.9
    assert slip_metrics(rows, 0.1, VEHICLE, up_to_mps=10.0).peak_ratio == pytest.approx(0.1)


def test_the_longest_spin_is_of_one_wheel_and_without_a_break() -> None:
    rows = steady()
    rows["slip_ratio"][100:151, 0] = 0.7
    rows["slip_ratio"][151:252, 1] = 0.7
    rows["slip_ratio"][300:351, 1] = 0.7
    assert longest_spin_s(rows) == pytest.approx(0.2)


def test_a_wheel_that_never_spins_spins_for_no_time() -> None:
    assert longest_spin_s(steady()) == 0.0
