"""Many believed cars at once: motor lag, half-shaft and a tyre that lags, as arrays.

The data for the Koopman bank are simulated with these; one column of every
array is one driven wheel with its share of the car.
"""

from __future__ import annotations

from dataclasses import dataclass

import msgspec
import numpy as np
from numpy.typing import NDArray

from tcs_hil.model.ranges import Range, check_rising
from tcs_hil.model.tyre import tyre_force_n
from tcs_hil.model.vehicle import Positive, Vehicle
from tcs_hil.model.wheel import rk4

FloatArray = NDArray[np.float64]

BODY, WHEEL, MOTOR, TWIST, TORQUE, PATCH = range(6)
"""Rows of a state (6, n): v m/s, omega rad/s, motor speed rad/s on the wheel side,
shaft twist rad, motor torque Nm, slip ratio of the contact patch."""

SUBSTEPS_PER_HALF = 1
"""RK4 steps per half period: the fastest pole (a patch at 60 m/s) is then 0.6 of a step."""


class FleetSettings(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Bounds between which every car of the fleet is drawn; inertias as seen from the wheel.

    ``friction_ratio`` is narrow on purpose: what another road changes is left to
    the disturbance estimate, and a predictor of the mean of many roads is worse
    on each of them.  ``arrival_share`` is the share of a period by which a
    command arrives late, on top of the delay in whole periods that the
    controller compensates.
    """

    friction_ratio: Range = (0.29, 0.31)
    mass_share: Range = (0.85, 1.15)
    load_share: Range = (0.9, 1.05)
    shaft_stiffness_nmprad: Range = (3000.0, 10_000.0)
    shaft_damping_nmsprad: Range = (8.0, 30.0)
    motor_lag_s: Range = (0.004, 0.010)
    relaxation_m: Range = (0.1, 0.25)
    arrival_share: Range = (0.0, 1.0)
    wheel_inertia_kgm2: Positive = 0.95
    motor_inertia_kgm2: Positive = 0.27

    def __post_init__(self) -> None:
        check_rising(self)


@dataclass(frozen=True, eq=False, slots=True)
class Fleet:
    """Parameters of n cars, each (n,); inertias are common to all."""

    vehicle: Vehicle
    wheel_inertia_kgm2: float
    motor_inertia_kgm2: float
    wheel_mass_kg: FloatArray  # what one driven wheel moves: half a car
    grip: FloatArray  # tyre force over the believed one
    stiffness: FloatArray
    damping: FloatArray
    lag_s: FloatArray
    relaxation_m: FloatArray
    arrival_share: FloatArray

    @classmethod
    def draw(
        cls, vehicle: Vehicle, settings: FleetSettings, cars: int, rng: np.random.Generator
    ) -> Fleet:
        """Draw ``cars`` cars, every parameter uniform between its bounds."""

        def uniform(bounds: Range) -> FloatArray:
            return rng.uniform(*bounds, cars)

        friction = uniform(settings.friction_ratio) / vehicle.friction_ratio
        return cls(
            vehicle=vehicle,
            wheel_inertia_kgm2=settings.wheel_inertia_kgm2,
            motor_inertia_kgm2=settings.motor_inertia_kgm2,
            wheel_mass_kg=vehicle.mass_kg / 2.0 * uniform(settings.mass_share),
            grip=friction * uniform(settings.load_share),
            stiffness=uniform(settings.shaft_stiffness_nmprad),
            damping=uniform(settings.shaft_damping_nmsprad),
            lag_s=uniform(settings.motor_lag_s),
            relaxation_m=uniform(settings.relaxation_m),
            arrival_share=uniform(settings.arrival_share),
        )

    def holding_torque_nm(self, kappa: FloatArray) -> FloatArray:
        """Motor torque (n,) that carries the tyre's force at a slip ratio (n,)."""
        force_n = self.grip * tyre_force_n(kappa, self.vehicle)
        return np.asarray(force_n * self.vehicle.wheel_radius_m / self.vehicle.gear_ratio)

    def at_slip(self, speed_mps: FloatArray, kappa: FloatArray) -> FloatArray:
        """State (6, n) in which every car holds a slip ratio at a speed."""
        omega = speed_mps / (1.0 - kappa) / self.vehicle.wheel_radius_m
        torque_nm = self.holding_torque_nm(kappa)
        twist = self.vehicle.gear_ratio * torque_nm / self.stiffness
        return np.stack((speed_mps, omega, omega, twist, torque_nm, kappa))

    def step(
        self, x: FloatArray, before_nm: FloatArray, torque_nm: FloatArray, period_s: float
    ) -> FloatArray:
        """State (6, n) one period later; the new command replaces the old as it arrives.

        Each half of the period takes the torque that acts for most of it.
        """
        for middle in (0.25, 0.75):
            acting_nm = np.where(self.arrival_share > middle, before_nm, torque_nm)
            x = self._half(x, acting_nm, period_s / 2.0)
        return x

    def _half(self, x: FloatArray, acting_nm: FloatArray, duration_s: float) -> FloatArray:
        advanced: FloatArray = rk4(
            lambda state: self._rate(state, acting_nm), x, duration_s, SUBSTEPS_PER_HALF
        )
        return advanced

    def _rate(self, x: FloatArray, command_nm: FloatArray) -> FloatArray:
        speed, omega, motor, twist, torque, patch = x
        rim = omega * self.vehicle.wheel_radius_m
        force = self.grip * tyre_force_n(patch, self.vehicle)
        shaft = self.stiffness * twist + self.damping * (motor - omega)
        # The patch tends to the slip ratio s / |omega R|, kept finite at standstill.
        rolling = np.sqrt(rim * rim + self.vehicle.slip_epsilon_m2ps2)
        return np.stack(
            (
                force / self.wheel_mass_kg,
                (shaft - force * self.vehicle.wheel_radius_m) / self.wheel_inertia_kgm2,
                (self.vehicle.gear_ratio * torque - shaft) / self.motor_inertia_kgm2,
                motor - omega,
                (command_nm - torque) / self.lag_s,
                (rim - speed - patch * rolling) / self.relaxation_m,
            )
        )
