"""All inputs of a tick judged together, and the measurement without those that cannot be true."""

from __future__ import annotations

import math
from typing import Final

from msgspec.structs import replace

from tcs_hil.model.vehicle import Vehicle
from tcs_hil.plausibility.driven import DrivenWheel, MotorTorque
from tcs_hil.plausibility.rolling import RollingAxle
from tcs_hil.plausibility.trace import Duration
from tcs_hil.signals import FourWheels, InputState, Measurement, Pair, Suspect

REQUEST_MAX_SHARE: Final = 1.25  # of what a motor can give
EXCESS_RATIO: Final = 0.05
EXCESS_NM: Final = 15.0
EXCESS_S: Final = 0.1
PATIENCE_S: Final = 0.005  # two cycles: what is older says nothing of the present

VALID: Final = InputState.VALID
MOTORS: Final = Suspect.MOTOR_LEFT | Suspect.MOTOR_RIGHT
UNKNOWN = (math.nan, math.nan)


class Plausibility:
    """Judges the inputs of every tick by physics and by each other."""

    def __init__(self, vehicle: Vehicle, period_s: float) -> None:
        self._radius_m = vehicle.wheel_radius_m
        self._rim_m = vehicle.wheel_radius_m / vehicle.gear_ratio  # of a motor's rotation
        self._most_nm = REQUEST_MAX_SHARE * vehicle.motor_torque_max_nm
        self._axle = RollingAxle(period_s)
        self._left, self._right = DrivenWheel(period_s), DrivenWheel(period_s)
        self._torques = MotorTorque(period_s), MotorTorque(period_s)
        self._allowed_nm = (0.0, 0.0)
        self._excess = Duration(EXCESS_S, period_s)

    def suspects(self, m: Measurement) -> int:
        """Bits (of ``Suspect``) of what cannot be true; called once a tick."""
        fl, fr, rl, rr = self._rims(m)
        (left_mps, right_mps), given_nm = self._motors(m)
        axle = self._axle
        axle.take(rl, rr, m.accel_x_mps2)
        left_mps = self._left.take(fl, left_mps, axle.speed_mps)
        right_mps = self._right.take(fr, right_mps, axle.speed_mps)
        # The sum is unknown unless both are.
        known = not math.isnan(left_mps + right_mps)
        axle.compare(max(left_mps, right_mps) if known else math.nan, given_nm)
        self._torques[0].take(given_nm[0], self._allowed_nm[0])
        self._torques[1].take(given_nm[1], self._allowed_nm[1])
        return self._bits(self._denied(given_nm, m.driver_torque_nm))

    def sent(self, allowed_nm: Pair) -> None:
        """Hear, at the tick's end, what each motor may give."""
        self._allowed_nm = allowed_nm

    def _rims(self, m: Measurement) -> FourWheels:
        """Speeds of the rims as far as they are valid and fresh."""
        fl, fr, rl, rr = m.wheel_speed_radps
        left, right, rear_left, rear_right = m.wheel_speed_valid
        front_m = self._radius_m if m.front_speed_age_s <= PATIENCE_S else math.nan
        rear_m = self._radius_m if m.rear_speed_age_s <= PATIENCE_S else math.nan
        return (
            fl * front_m if left else math.nan,
            fr * front_m if right else math.nan,
            rl * rear_m if rear_left else math.nan,
            rr * rear_m if rear_right else math.nan,
        )

    def _motors(self, m: Measurement) -> tuple[Pair, Pair]:
        """Speeds that the rims have if they turn with their motors, and the motors' torques."""
        if m.motor_age_s > PATIENCE_S or m.motor_state is not VALID:
            return UNKNOWN, UNKNOWN
        left_radps, right_radps = m.motor_speed_radps
        return (abs(left_radps) * self._rim_m, abs(right_radps) * self._rim_m), m.motor_torque_nm

    def _denied(self, given_nm: Pair, asked_nm: Pair) -> bool:
        """Whether the driver is said to ask for less than a motor gives, or for too much."""
        (given_left, given_right), (left, right) = given_nm, asked_nm
        share = 1.0 + EXCESS_RATIO
        excess = self._excess.reached(
            given_left > share * max(left, 0.0) + EXCESS_NM
            or given_right > share * max(right, 0.0) + EXCESS_NM
        )
        return excess or max(left, right) > self._most_nm

    def _bits(self, denied: bool) -> int:
        left, right, axle = self._left, self._right, self._axle
        doubtful = (
            left.wheel_suspected,
            right.wheel_suspected,
            axle.left.suspected,
            axle.right.suspected,
            left.motor_suspected or self._torques[0].suspected,
            right.motor_suspected or self._torques[1].suspected,
            axle.accel_suspected,
            denied,
        )
        if True not in doubtful:
            return 0
        return sum(bit for bit, doubt in zip(Suspect, doubtful, strict=True) if doubt)


def screened(m: Measurement, suspects: int) -> Measurement:
    """The measurement without what ``suspects`` (bits of ``Suspect``) says is not true."""
    fl, fr, rl, rr = m.wheel_speed_valid
    return replace(
        m,
        wheel_speed_valid=(
            fl and not suspects & Suspect.WHEEL_FL,
            fr and not suspects & Suspect.WHEEL_FR,
            rl and not suspects & Suspect.WHEEL_RL,
            rr and not suspects & Suspect.WHEEL_RR,
        ),
        motor_age_s=math.inf if suspects & MOTORS else m.motor_age_s,
        accel_x_mps2=math.nan if suspects & Suspect.ACCELEROMETER else m.accel_x_mps2,
    )
