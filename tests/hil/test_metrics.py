import numpy as np
import pytest

from tcs_hil.hil.metrics import reachable, slip_metrics
from tcs_hil.model.vehicle import Vehicle

VEHICLE = Vehicle()
QUARTER_LOAD_N = VEHICLE.wheel_load_n
DTYPE = np.dtype(
    [
        ("time_s", "f8"),
        ("speed_mps", "f8"),
        ("request_nm", "f8"),
        ("motor_torque_nm", "f8", 2),
        ("slip_ratio", "f8", 4),
        ("load_n", "f8", 4),
        ("mu", "f8", 4),
    ]
)


def truth(samples: int = 1000) -> np.ndarray:
    """Two seconds at 2 ms on mu 0.3 with both front wheels at slip 0.1."""
    rows = np.zeros(samples, DTYPE)
    rows["time_s"] = 0.002 * np.arange(samples)
    rows["speed_mps"] = 5.0
    rows["request_nm"] = 250.0
    rows["slip_ratio"][:, :2] = 0.1
    rows["load_n"] = QUARTER_LOAD_N
    rows["mu"] = 0.3
    return rows


def test_a_constant_error_is_its_own_rmse() -> None:
    rows = truth()
    rows["slip_ratio"][:, 1] = 0.13
    assert slip_metrics(rows, 0.1, VEHICLE).rmse_ratio == pytest.approx(0.03)


def test_the_ramp_does_not_count_for_rmse_but_does_for_the_peak() -> None:
    rows = truth()
    rows["slip_ratio"][:299, 0] = 0.4
    metrics = slip_metrics(rows, 0.1, VEHICLE)
    assert metrics.rmse_ratio == pytest.approx(0.0)
    assert metrics.peak_ratio == pytest.approx(0.4)


@pytest.mark.parametrize(("mu", "can"), [(0.15, True), (0.3, True), (0.6, False)])
def test_the_papers_motor_reaches_the_reference_up_to_mu_just_below_0_6(
    mu: float, can: bool
) -> None:
    rows = truth(1)
    rows["mu"] = mu
    assert reachable(rows, 0.1, VEHICLE).all() == can


def test_what_cannot_be_reached_is_left_out() -> None:
    rows = truth()
    rows["mu"][500:] = 0.6
    rows["slip_ratio"][500:, :2] = 0.06
    metrics = slip_metrics(rows, 0.1, VEHICLE)
    assert metrics.rmse_ratio == pytest.approx(0.0)
    assert metrics.reachable_share == pytest.approx(0.2)


def test_without_a_sample_that_counts_there_is_no_rmse() -> None:
    rows = truth()
    rows["request_nm"] = 10.0
    assert np.isnan(slip_metrics(rows, 0.1, VEHICLE).rmse_ratio)


def test_chatter_is_the_mean_rate_of_the_torque() -> None:
    rows = truth()
    rows["motor_torque_nm"][::2, 0] = 10.0
    assert slip_metrics(rows, 0.1, VEHICLE).chatter_nmps == pytest.approx(10.0 / 0.002)


def test_a_speed_bound_leaves_faster_samples_out() -> None:
    rows = truth()
    rows["speed_mps"][500:] = 20.0
    rows["slip_ratio"][500:, :2] = 0.9
    assert slip_metrics(rows, 0.1, VEHICLE, up_to_mps=10.0).peak_ratio == pytest.approx(0.1)
