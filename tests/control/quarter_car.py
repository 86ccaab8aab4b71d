"""The paper's quarter car as a plant: own equations, fine steps, and the two manoeuvres.

Nothing here comes from ``tcs_hil.model``: the belief is judged against it.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from tcs_hil.control.protocol import Controller, WheelState

MASS_KG, RADIUS_M, INERTIA_KGM2, GEAR = 1400.0, 0.318, 1.22, 3.0
TYRE_D, TYRE_C, TYRE_B = 1.2005, 1.4010, 17.1571
LOAD_N = MASS_KG * 9.81 / 4.0
PERIOD_S, SUBSTEPS = 0.002, 10
START_MPS = 2.0 / 3.6

FrictionAt = Callable[[float], float]


def constant_friction(_distance_m: float) -> float:
    """Manoeuvre 1."""
    return 0.3


def varying_friction(distance_m: float) -> float:
    """Manoeuvre 2."""
    patches = ((10.0, 0.3), (20.0, 0.15), (30.0, 0.6), (math.inf, 0.3))
    return next(mu for end_m, mu in patches if distance_m < end_m)


def driver_ramp(time_s: float) -> float:
    """The paper's request: 0 to 250 Nm from 0.1 s to 0.6 s, then held."""
    return 250.0 * min(max((time_s - 0.1) / 0.5, 0.0), 1.0)


def slip(speed_mps: float, wheel_radps: float) -> float:
    """Modified slip ratio, Eq. (slip_mod)."""
    rim = wheel_radps * RADIUS_M
    return (rim - speed_mps) * rim / (rim * rim + 0.1)


def tyre_force(kappa: float, friction: float) -> float:
    """Longitudinal force in N, Eq. (tire_model)."""
    return friction * LOAD_N * TYRE_D * math.sin(TYRE_C * math.atan(TYRE_B * kappa))


def reachable(torque_ref_nm: float, friction: float, reference: float = 0.1) -> bool:
    """Can the driver's torque hold the reference?  It must carry the tyre and spin the wheel up."""
    force = tyre_force(reference, friction)
    spin_up = 4.0 * force / MASS_KG / (RADIUS_M * (1.0 - reference))
    return GEAR * torque_ref_nm >= force * RADIUS_M + INERTIA_KGM2 * spin_up


@dataclass
class QuarterCar:
    """One driven wheel and a quarter of the mass, classical RK4 at 0.2 ms."""

    friction_at: FrictionAt
    speed_mps: float = START_MPS
    wheel_radps: float = START_MPS / RADIUS_M
    distance_m: float = 0.0

    @property
    def slip_ratio(self) -> float:
        return slip(self.speed_mps, self.wheel_radps)

    def step(self, torque_nm: float) -> None:
        friction, h = self.friction_at(self.distance_m), PERIOD_S / SUBSTEPS

        def rate(v: float, w: float) -> tuple[float, float]:
            force = tyre_force(slip(v, w), friction)
            return 4.0 * force / MASS_KG, (GEAR * torque_nm - force * RADIUS_M) / INERTIA_KGM2

        for _ in range(SUBSTEPS):
            v, w = self.speed_mps, self.wheel_radps
            k1 = rate(v, w)
            k2 = rate(v + h / 2 * k1[0], w + h / 2 * k1[1])
            k3 = rate(v + h / 2 * k2[0], w + h / 2 * k2[1])
            k4 = rate(v + h * k3[0], w + h * k3[1])
            self.distance_m += h * v
            self.speed_mps += h / 6 * (k1[0] + 2 * k2[0] + 2 * k3[0] + k4[0])
            self.wheel_radps += h / 6 * (k1[1] + 2 * k2[1] + 2 * k3[1] + k4[1])

    def sensed(self, torque_nm: float) -> WheelState:
        """What a perfect estimator sees."""
        return WheelState(
            slip_speed_mps=self.wheel_radps * RADIUS_M - self.speed_mps,
            wheel_speed_radps=self.wheel_radps,
            slip_ratio=self.slip_ratio,
            vehicle_speed_mps=self.speed_mps,
            motor_speed_radps=self.wheel_radps * GEAR,
            motor_torque_nm=torque_nm,
        )


@dataclass(frozen=True)
class Run:
    """One closed-loop run, a row per tick."""

    time_s: np.ndarray  # (n,)
    slip: np.ndarray  # (n,)
    speed_mps: np.ndarray  # (n,)
    torque_nm: np.ndarray  # (n,)
    reachable: np.ndarray  # (n,) bool: the driver's torque can hold the reference

    def tracking_rmse(self, *, after_s: float = 0.6, below_mps: float = math.inf) -> float:
        """Slip RMSE over the samples in which the reference can be reached."""
        judged = (self.time_s >= after_s) & self.reachable & (self.speed_mps <= below_mps)
        return float(np.sqrt(np.mean((self.slip[judged] - 0.1) ** 2)))


def drive(
    controller: Controller,
    friction_at: FrictionAt,
    duration_s: float,
    distance_m: float = math.inf,
) -> Run:
    """Close the loop without delay: the torque acts in the period it was proposed for."""
    car, torque, rows = QuarterCar(friction_at), 0.0, []
    for tick in range(round(duration_s / PERIOD_S)):
        if car.distance_m >= distance_m:
            break
        time_s = tick * PERIOD_S
        reference = driver_ramp(time_s)
        torque = controller.step(car.sensed(torque), reference).torque_nm
        can_reach = reachable(reference, friction_at(car.distance_m))
        rows.append((time_s, car.slip_ratio, car.speed_mps, torque, can_reach))
        car.step(torque)
    time, kappa, speed, torques, held = (np.array(column) for column in zip(*rows, strict=True))
    return Run(time, kappa, speed, torques, held.astype(bool))


def manoeuvre_1(controller: Controller) -> Run:
    """Constant friction 0.3 for 3 s."""
    return drive(controller, constant_friction, 3.0)


def manoeuvre_2(controller: Controller) -> Run:
    """Friction by distance, until 50 m or 8 s."""
    return drive(controller, varying_friction, 8.0, 50.0)
