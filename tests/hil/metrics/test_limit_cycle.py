import numpy as np
import pytest

from tcs_hil.hil.metrics import Truth, find_limit_cycle
from tcs_hil.hil.metrics.limit_cycle import turning_points
from tests.hil.truths import steady


def wave(rows: Truth, frequency_hz: float) -> np.ndarray:
    return np.sin(2.0 * np.pi * frequency_hz * rows["time_s"])


def shaken(frequency_hz: float, slip: float = 0.05) -> Truth:
    """The left wheel's slip swings by ``slip`` to either side."""
    rows = steady()
    rows["slip_ratio"][:, 0] += slip * wave(rows, frequency_hz)
    return rows


@pytest.mark.parametrize("frequency_hz", [3.0, 11.0, 25.0, 150.0])
def test_a_lasting_oscillation_of_slip_is_found(frequency_hz: float) -> None:
    cycle = find_limit_cycle(shaken(frequency_hz))
    assert cycle is not None
    assert (cycle.signal, cycle.side) == ("slip_ratio", 0)
    assert cycle.frequency_hz == pytest.approx(frequency_hz, rel=0.05)
    assert cycle.swing == pytest.approx(0.1, rel=0.2)  # 500 Hz misses peaks of 150 Hz


def test_torque_that_goes_bang_bang_every_tick_is_found_though_slip_hardly_moves() -> None:
    rows = steady()
    rows["motor_torque_nm"][::2, 1] = 100.0
    cycle = find_limit_cycle(rows)
    assert cycle is not None
    assert (cycle.signal, cycle.side) == ("motor_torque_nm", 1)


def test_a_growing_oscillation_is_found_before_it_has_grown() -> None:
    rows = steady()
    rows["slip_ratio"][:, 0] += 0.01 * np.exp(2.0 * rows["time_s"]) * wave(rows, 10.0)
    cycle = find_limit_cycle(rows)
    assert cycle is not None
    assert cycle.start_s < 1.0


def test_what_rings_down_after_a_jump_of_friction_is_none() -> None:
    rows = steady()
    late = rows[300:]
    late["mu"] = 0.15
    decay = np.exp(-3.0 * (late["time_s"] - 0.6))
    late["slip_ratio"][:, 0] += 0.4 * decay * wave(late, 12.0)
    late["motor_torque_nm"][:, 0] += 100.0 * decay * wave(late, 12.0)
    assert find_limit_cycle(rows) is None


def test_a_lightly_damped_shaft_at_25_hz_is_none() -> None:
    rows = steady()
    decay = np.exp(-0.05 * 2.0 * np.pi * 25.0 * rows["time_s"])
    rows["motor_torque_nm"][:, 0] += 120.0 * decay * wave(rows, 25.0)
    assert find_limit_cycle(rows) is None


def test_the_ripple_of_a_toothed_sensor_is_none() -> None:
    rows = steady()
    noise = np.random.default_rng(1).normal(size=(len(rows), 2))
    rows["slip_ratio"][:, :2] += 0.006 * noise
    rows["motor_torque_nm"] += 3.0 * noise
    assert find_limit_cycle(rows) is None


def test_ripple_does_not_hide_a_slow_oscillation() -> None:
    rows = shaken(4.0)
    rows["slip_ratio"][:, 0] += 0.005 * np.random.default_rng(1).normal(size=len(rows))
    cycle = find_limit_cycle(rows)
    assert cycle is not None
    assert cycle.frequency_hz == pytest.approx(4.0, rel=0.1)


def test_an_answer_to_friction_that_changes_five_times_a_second_is_none() -> None:
    rows = shaken(5.0)
    rows["mu"][wave(rows, 5.0) > 0.0] = 0.15
    assert find_limit_cycle(rows) is None


def test_a_driver_who_pumps_the_pedal_once_a_second_is_none() -> None:
    rows = steady(4000)
    rows["motor_torque_nm"][:, :] += 100.0 * wave(rows, 1.0)[:, None]
    assert find_limit_cycle(rows) is None


def test_a_short_burst_is_none() -> None:
    rows = steady()
    burst = rows[300:450]  # 0.3 s
    burst["motor_torque_nm"][:, 0] += 50.0 * wave(burst, 100.0)
    assert find_limit_cycle(rows) is None


def test_three_periods_are_none() -> None:
    rows = shaken(5.0)
    rows["slip_ratio"][int(3 / 5.0 / 0.002) :, 0] = 0.1
    assert find_limit_cycle(rows) is None


def test_of_two_the_earlier_one_is_reported() -> None:
    rows = shaken(10.0)
    rows["slip_ratio"][:500, 0] = 0.1
    rows["motor_torque_nm"][100:, 1] += 50.0 * wave(rows[100:], 10.0)
    cycle = find_limit_cycle(rows)
    assert cycle is not None
    assert cycle.signal == "motor_torque_nm"


def test_turning_points_alternate_and_skip_what_is_smaller() -> None:
    values = np.array([0.0, 5.0, 4.5, 6.0, 1.0, 1.4, 0.0, 3.0])
    assert turning_points(values, 2.0) == [3, 6]
