"""Good values to start a test from."""

from typing import Any

from msgspec.structs import replace

from tcs_hil.signals import (
    NO_LIMIT,
    Command,
    ControllerKind,
    Measurement,
    TcsState,
    TorqueLimits,
)

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


def command(left_nm: float, right_nm: float, **changes: Any) -> Command:
    """The NMPC holds each motor that has a limit."""
    good = Command(
        limits=TorqueLimits(left_nm, right_nm),
        active=(left_nm < NO_LIMIT, right_nm < NO_LIMIT),
        state=TcsState.ACTIVE,
        fault_code=0,
        controller=ControllerKind.NMPC,
        slip_ratio=(0.1, 0.1),
        slip_reference=0.1,
    )
    return replace(good, **changes)
