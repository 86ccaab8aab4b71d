import pytest

from tcs_hil.canbus.bench_control import AS_IN_SCENARIO, BenchControl, BenchFault
from tcs_hil.hil.monitor.hand import press


def pressed(*keys: str, request_nm: float = 0.0) -> BenchControl:
    control = AS_IN_SCENARIO
    for key in keys:
        control = press(control, key, request_nm)
    return control


def test_the_first_press_goes_on_from_what_the_driver_asks_for() -> None:
    assert pressed("up", request_nm=103.0).throttle_nm == 110.0
    assert pressed("down", request_nm=103.0).throttle_nm == 90.0


@pytest.mark.parametrize(("key", "end_nm"), [("up", 500.0), ("down", 0.0)])
def test_the_throttle_ends_where_the_drivers_does(key: str, end_nm: float) -> None:
    assert pressed(*[key] * 60, request_nm=250.0).throttle_nm == end_nm


def test_the_road_becomes_snow_and_then_better_or_worse() -> None:
    assert pressed("left").mu_ratio == 0.3
    assert pressed("left", "left").mu_ratio == 0.25
    assert pressed("left", "right", "right").mu_ratio == 0.4
    assert pressed(*["left"] * 20).mu_ratio == 0.05


def test_a_number_toggles_its_fault_and_ends_another() -> None:
    assert pressed("1").fault is BenchFault.WHEEL_SPEED_FL_STUCK
    assert pressed("1", "8").fault is BenchFault.VEHICLE_BROWN_OUT
    assert pressed("8", "8").fault is BenchFault.NONE


def test_space_gives_everything_back() -> None:
    assert pressed("up", "left", "3", "space") == AS_IN_SCENARIO
