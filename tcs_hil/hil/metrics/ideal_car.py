"""A scenario's car reduced to its longitudinal balance, whichever variant it is."""

from __future__ import annotations

import math
from dataclasses import dataclass

from plant_emulator.body import GRAVITY_MPS2
from plant_emulator.quarter_car import QuarterCar
from plant_emulator.scenario import VehicleTable
from plant_emulator.whole_car import WholeCar


@dataclass(frozen=True, slots=True, kw_only=True)
class IdealCar:
    """What moves the car and what stands against it.

    ``load_n`` is on one front wheel at rest, ``shed_kg`` what that wheel loses
    per m/s² of acceleration, ``spin_kg`` the inertia of the wheels that are not
    driven.  The tyre's peak factor is ``peak`` at ``peak_load_n`` and changes by
    ``peak_slope`` per relative load.
    """

    mass_kg: float
    load_n: float
    wheel_radius_m: float
    driven_inertia_kgm2: float
    gear_ratio: float
    peak: float
    peak_load_n: float
    peak_slope: float = 0.0
    shed_kg: float = 0.0
    spin_kg: float = 0.0
    drag_kgpm: float = 0.0
    rolling_ratio: float = 0.0
    torque_max_nm: float = math.inf
    power_max_w: float = math.inf

    def peak_force_n(self, load_n: float, mu: float) -> float:
        """Most that one tyre can push; a Magic Formula with C above 1 reaches its D."""
        relative = load_n / self.peak_load_n - 1.0
        return mu * load_n * (self.peak + self.peak_slope * relative)

    def torque_force_n(self, request_nm: float, speed_mps: float, accel_mps2: float) -> float:
        """Force one tyre gets of the driver's torque while the wheel keeps up with the car."""
        motor_radps = max(self.gear_ratio * speed_mps / self.wheel_radius_m, 1.0)
        motor_nm = min(request_nm, self.torque_max_nm, self.power_max_w / motor_radps)
        spin_up_nm = self.driven_inertia_kgm2 * accel_mps2 / self.wheel_radius_m
        return (self.gear_ratio * motor_nm - spin_up_nm) / self.wheel_radius_m


def ideal_car(vehicle: VehicleTable) -> IdealCar:
    """Reduce the car that ``vehicle`` selects."""
    if vehicle.variant == "quarter-car":
        return _quarter_car(vehicle.quarter_car)
    return _whole_car(vehicle.whole)


def _quarter_car(car: QuarterCar) -> IdealCar:
    """Two driven wheels, each of which moves a quarter of the mass."""
    load_n = car.mass_kg * GRAVITY_MPS2 / 4.0
    return IdealCar(
        mass_kg=car.mass_kg / 2.0,
        load_n=load_n,
        wheel_radius_m=car.wheel_radius_m,
        driven_inertia_kgm2=car.wheel_inertia_kgm2,
        gear_ratio=car.gear_ratio,
        peak=car.tyre_d,
        peak_load_n=load_n,
    )


def _whole_car(car: WholeCar) -> IdealCar:
    body, tyre, line = car.body, car.tyre, car.driveline
    front_share = 1.0 - body.cg_behind_front_axle_m / body.wheelbase_m
    height_ratio = body.cg_height_m / body.wheelbase_m if body.load_transfer else 0.0
    return IdealCar(
        mass_kg=body.mass_kg,
        load_n=0.5 * body.mass_kg * GRAVITY_MPS2 * front_share,
        wheel_radius_m=body.wheel_radius_m,
        driven_inertia_kgm2=body.wheel_inertia_kgm2 + line.gear_ratio**2 * line.motor_inertia_kgm2,
        gear_ratio=line.gear_ratio,
        peak=tyre.pdx1,
        peak_load_n=tyre.fnomin,
        peak_slope=tyre.pdx2,
        shed_kg=0.5 * body.mass_kg * height_ratio,
        spin_kg=2.0 * body.wheel_inertia_kgm2 / body.wheel_radius_m**2,
        drag_kgpm=0.5 * body.air_density_kgpm3 * body.drag_area_m2,
        rolling_ratio=tyre.qsy1,
        torque_max_nm=line.motor_torque_max_nm,
        power_max_w=line.motor_power_max_w,
    )
