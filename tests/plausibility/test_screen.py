import math
from typing import Any

import pytest
from factories import measurement
from hypothesis import given
from hypothesis import strategies as st
from msgspec.structs import replace

from tcs_hil.model.vehicle import Vehicle
from tcs_hil.plausibility import Plausibility, screened
from tcs_hil.signals import InputState, Measurement, Suspect

PERIOD_S = 0.002
ALL = [Suspect.WHEEL_FL, Suspect.WHEEL_FR, Suspect.WHEEL_RL, Suspect.WHEEL_RR]


@pytest.fixture
def plausibility() -> Plausibility:
    judge = Plausibility(Vehicle(), PERIOD_S)
    feed(judge, 100)
    return judge


def feed(judge: Plausibility, ticks: int, **changes: Any) -> int:
    suspects = 0
    for _ in range(ticks):
        suspects = judge.suspects(measurement(**changes))
    return suspects


def test_a_good_measurement_is_believed(plausibility: Plausibility) -> None:
    assert feed(plausibility, 500) == 0


@pytest.mark.parametrize("wheel", range(4))
def test_each_wheel_has_its_bit(plausibility: Plausibility, wheel: int) -> None:
    speeds = tuple(60.0 if i == wheel else 20.0 for i in range(4))
    assert feed(plausibility, 30, wheel_speed_radps=speeds) == ALL[wheel]


@pytest.mark.parametrize("motor", range(2))
def test_each_motor_has_its_bit_by_its_speed(plausibility: Plausibility, motor: int) -> None:
    speeds = tuple(180.0 if i == motor else 60.0 for i in range(2))
    bit = (Suspect.MOTOR_LEFT, Suspect.MOTOR_RIGHT)[motor]
    assert feed(plausibility, 30, motor_speed_radps=speeds) == bit


@pytest.mark.parametrize("motor", range(2))
def test_each_motor_has_its_bit_by_its_torque(plausibility: Plausibility, motor: int) -> None:
    plausibility.sent((100.0, 0.0) if motor == 0 else (0.0, 100.0))
    bit = (Suspect.MOTOR_LEFT, Suspect.MOTOR_RIGHT)[motor]
    assert feed(plausibility, 60) == bit


def test_the_accelerometer_has_its_bit(plausibility: Plausibility) -> None:
    assert feed(plausibility, 1, accel_x_mps2=50.0) == Suspect.ACCELEROMETER


@pytest.mark.parametrize("given_nm", [(121.0, 0.0), (0.0, 121.0)])
def test_a_motor_that_gives_more_than_is_asked_accuses_the_request_after_100_ms(
    plausibility: Plausibility, given_nm: tuple[float, float]
) -> None:
    assert feed(plausibility, 49, motor_torque_nm=given_nm) == 0
    assert feed(plausibility, 1, motor_torque_nm=given_nm) == Suspect.DRIVER


def test_a_motor_that_brakes_less_than_it_is_asked_is_no_excess(
    plausibility: Plausibility,
) -> None:
    braking = {"motor_torque_nm": (-5.0, -5.0), "driver_torque_nm": (-60.0, -60.0)}
    assert feed(plausibility, 99, **braking) == 0


def test_a_little_more_than_is_asked_is_noise(plausibility: Plausibility) -> None:
    assert feed(plausibility, 99, motor_torque_nm=(119.0, 119.0)) == 0


@pytest.mark.parametrize("asked_nm", [(313.0, 0.0), (0.0, 313.0)])
def test_a_request_beyond_every_motor_is_suspected(
    plausibility: Plausibility, asked_nm: tuple[float, float]
) -> None:
    assert feed(plausibility, 1, driver_torque_nm=asked_nm) == Suspect.DRIVER
    assert feed(plausibility, 1, driver_torque_nm=(312.0, 312.0)) == 0


def test_what_is_invalid_is_not_suspected_too(plausibility: Plausibility) -> None:
    off = {"wheel_speed_radps": (0.0,) * 4, "wheel_speed_valid": (False,) * 4}
    assert feed(plausibility, 100, **off) == 0


@pytest.mark.parametrize(
    "stale",
    [
        {"front_speed_age_s": 0.006},
        {"motor_age_s": 0.006},
        {"motor_state": InputState.INVALID},
        {"motor_state": InputState.ABSENT},
    ],
)
def test_what_is_stale_contradicts_nothing(
    plausibility: Plausibility, stale: dict[str, Any]
) -> None:
    # Front wheels and motors have parted, but one of the two is old.
    assert feed(plausibility, 100, motor_speed_radps=(180.0, 180.0), **stale) == 0


def test_stale_rear_speeds_do_not_jump(plausibility: Plausibility) -> None:
    wheels = (20.0, 20.0, 60.0, 60.0)
    assert feed(plausibility, 9, wheel_speed_radps=wheels, rear_speed_age_s=0.006) == 0


def test_stale_torques_accuse_nobody(plausibility: Plausibility) -> None:
    plausibility.sent((100.0, 100.0))
    assert feed(plausibility, 99, motor_age_s=0.006) == 0
    assert feed(plausibility, 99, motor_torque_nm=(200.0, 200.0), motor_age_s=0.006) == 0


def test_a_motor_that_turns_backwards_turns_with_its_wheel(plausibility: Plausibility) -> None:
    assert feed(plausibility, 99, motor_speed_radps=(-60.0, -60.0)) == 0


def test_rear_wheels_are_compared_with_the_faster_driven_one(plausibility: Plausibility) -> None:
    half = {
        "wheel_speed_radps": (10.0, 20.0, 20.0, 20.0),
        "motor_speed_radps": (30.0, 60.0),
        "motor_torque_nm": (50.0, 50.0),
    }
    assert feed(Plausibility(Vehicle(), PERIOD_S), 200, **half) == 0
    slow = half | {"wheel_speed_radps": (10.0, 10.0, 20.0, 20.0), "motor_speed_radps": (30.0, 30.0)}
    rears = Suspect.WHEEL_RL | Suspect.WHEEL_RR
    assert feed(Plausibility(Vehicle(), PERIOD_S), 200, **slow) == rears


@pytest.mark.parametrize("side", range(2))
def test_without_one_of_the_driven_wheels_the_rear_ones_are_not_compared(side: int) -> None:
    judge = Plausibility(Vehicle(), PERIOD_S)
    blind = {
        "wheel_speed_radps": (10.0, 10.0, 20.0, 20.0),
        "wheel_speed_valid": tuple(i != side for i in range(4)),
        "motor_speed_radps": tuple(math.nan if i == side else 30.0 for i in range(2)),
        "motor_torque_nm": (50.0, 50.0),
    }
    assert feed(judge, 200, **blind) == 0


GOOD = measurement()


def test_nothing_suspected_is_nothing_screened() -> None:
    assert screened(GOOD, 0) == GOOD


@pytest.mark.parametrize("wheel", range(4))
def test_a_suspected_wheel_is_screened_as_invalid(wheel: int) -> None:
    valid = tuple(i != wheel for i in range(4))
    assert screened(GOOD, ALL[wheel]) == replace(GOOD, wheel_speed_valid=valid)


@pytest.mark.parametrize("suspect", [Suspect.MOTOR_LEFT, Suspect.MOTOR_RIGHT])
def test_a_suspected_motor_is_screened_as_one_that_never_came(suspect: Suspect) -> None:
    assert screened(GOOD, suspect) == replace(GOOD, motor_age_s=math.inf)


def test_a_suspected_accelerometer_is_screened_as_none() -> None:
    without = screened(GOOD, Suspect.ACCELEROMETER)
    assert math.isnan(without.accel_x_mps2)
    assert replace(without, accel_x_mps2=0.0) == GOOD


def test_a_suspected_request_leaves_the_measurement() -> None:
    assert screened(GOOD, Suspect.DRIVER) == GOOD


ANY = st.floats(allow_nan=True, allow_infinity=True, allow_subnormal=True)
MEASUREMENTS = st.builds(
    measurement,
    wheel_speed_radps=st.tuples(*[ANY] * 4),
    wheel_speed_valid=st.tuples(*[st.booleans()] * 4),
    motor_speed_radps=st.tuples(ANY, ANY),
    motor_torque_nm=st.tuples(ANY, ANY),
    driver_torque_nm=st.tuples(ANY, ANY),
    accel_x_mps2=ANY,
    front_speed_age_s=ANY,
    rear_speed_age_s=ANY,
    motor_age_s=ANY,
)


@given(st.lists(MEASUREMENTS, max_size=20))
def test_any_input_gives_a_byte_of_suspects(measurements: list[Measurement]) -> None:
    judge = Plausibility(Vehicle(), PERIOD_S)
    for m in measurements:
        assert 0 <= judge.suspects(m) < 256
