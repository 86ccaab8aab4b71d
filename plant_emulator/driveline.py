"""From torque command to wheel: electric motor, gear and half-shaft, once per front wheel."""

from __future__ import annotations

from typing import Annotated

from msgspec import Meta

from plant_emulator.bounds import NonNegative, Positive, Table
from plant_emulator.compiled import compiled

SPEED_FADE_RATIO = 0.05


class Driveline(Table, frozen=True):
    """One motor and its half-shaft.

    Wheel and motor together make the paper's 1.22 kg m2:
    0.95 + gear^2 x 0.03.  ``motor_lag_s`` 0 is a motor without lag,
    ``shaft_stiffness_nmprad`` 0 a rigid shaft.  Motor quantities are on the motor
    side of the gear, shaft quantities on the wheel side.  ``shaft_lash_rad`` is
    the whole play.
    """

    gear_ratio: Positive = 3.0
    motor_inertia_kgm2: Annotated[float, Meta(ge=0.005)] = 0.03
    motor_lag_s: Annotated[float, Meta(ge=0.0, le=0.05)] = 0.005
    motor_torque_max_nm: Positive = 250.0
    motor_power_max_w: Positive = 80_000.0
    motor_speed_max_radps: Positive = 1500.0
    motor_torque_rate_nmps: Positive = 8000.0
    shaft_stiffness_nmprad: Annotated[float, Meta(ge=0.0, le=50_000.0)] = 6000.0
    shaft_damping_nmsprad: Annotated[float, Meta(ge=0.0, le=200.0)] = 25.0
    shaft_lash_rad: NonNegative = 0.0


@compiled
def attainable(driveline: Driveline, asked_nm: float, speed_radps: float) -> float:
    """Torque the inverter aims at: the asked one within torque, power and speed limits."""
    driven = max(speed_radps, 1.0)
    most = min(driveline.motor_torque_max_nm, driveline.motor_power_max_w / driven)
    room = driveline.motor_speed_max_radps - speed_radps
    fade = SPEED_FADE_RATIO * driveline.motor_speed_max_radps
    if room < fade:
        most *= max(room / fade, 0.0)
    return min(max(asked_nm, -most), most)


@compiled
def torque_rate(driveline: Driveline, aim_nm: float, torque_nm: float) -> float:
    """Rate of the air-gap torque, Nm/s: first-order lag under a rate limit."""
    rate = (aim_nm - torque_nm) / driveline.motor_lag_s
    most = driveline.motor_torque_rate_nmps
    return min(max(rate, -most), most)


@compiled
def shaft_torque(driveline: Driveline, twist_rad: float, twist_rate_radps: float) -> float:
    """Torque on the wheel, Nm: spring and damper, but only when the lash is taken up."""
    play = 0.5 * driveline.shaft_lash_rad
    damping_nm = driveline.shaft_damping_nmsprad * twist_rate_radps
    if play == 0.0:
        return driveline.shaft_stiffness_nmprad * twist_rad + damping_nm
    # Teeth in contact push and never pull, however fast they part.
    if twist_rad > play:
        return max(driveline.shaft_stiffness_nmprad * (twist_rad - play) + damping_nm, 0.0)
    if twist_rad < -play:
        return min(driveline.shaft_stiffness_nmprad * (twist_rad + play) + damping_nm, 0.0)
    return 0.0
