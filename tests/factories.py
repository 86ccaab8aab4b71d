"""Good values to start a test from."""

from typing import Any

from msgspec.structs import replace

from tcs_hil.signals import Measurement

ROLLING_RADPS = 20.0


def measurement(**changes: Any) -> Measurement:
    """A car rolling freely at 20 rad/s with the driver asking for 100 Nm a motor."""
    good = Measurement(
        wheel_speed_radps=(ROLLING_RADPS,) * 4,
        wheel_speed_valid=(True,) * 4,
        motor_speed_radps=(3.0 * ROLLING_RADPS,) * 2,
        motor_torque_nm=(0.0, 0.0),
        driver_torque_nm=(100.0, 100.0),
        accel_x_mps2=0.0,
        front_speed_age_s=0.001,
        rear_speed_age_s=0.001,
        motor_age_s=0.001,
        driver_age_s=0.004,
    )
    return replace(good, **changes)
