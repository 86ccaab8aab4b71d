"""A loop with a driveline and a delay, on one car of the fleet, for the bank's controller."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from tcs_hil.control.protocol import Controller, WheelState
from tcs_hil.model.fleet import BODY, MOTOR, PATCH, TORQUE, WHEEL, Fleet, FleetSettings
from tcs_hil.model.tyre import slip_ratio, tyre_force_n
from tcs_hil.model.vehicle import Vehicle

PERIOD_S, VEHICLE = 0.002, Vehicle()

OverTime = Callable[[float], float]


def nominal(**settings: object) -> FleetSettings:
    """Settings of which every draw is the default car, but for what is given."""
    fixed = {
        "friction_ratio": (0.2999, 0.3001),
        "mass_share": (0.9999, 1.0001),
        "load_share": (0.9999, 1.0001),
        "shaft_stiffness_nmprad": (5999.0, 6001.0),
        "shaft_damping_nmsprad": (24.9, 25.1),
        "motor_lag_s": (0.00499, 0.00501),
        "relaxation_m": (0.1499, 0.1501),
        "arrival_share": (0.0, 0.001),
    }
    return FleetSettings(**(fixed | settings))


@dataclass(frozen=True)
class Loop:
    """One closed-loop run, a row per tick."""

    slip: np.ndarray
    torque_nm: np.ndarray
    proposed_nm: np.ndarray


def drive(  # noqa: PLR0917 - a test names what it varies
    controller: Controller,
    duration_s: float,
    speed_mps: float = 6.0,
    delay: int = 3,
    believed_delay: int = 3,
    fleet: FleetSettings | None = None,
    grip: OverTime = lambda _: 1.0,
    request: OverTime = lambda time_s: 250.0 * min(time_s / 0.2, 1.0),
) -> Loop:
    """Follow a request over time; commands act ``delay`` periods after their measurement.

    ``grip`` is the tyre's force over the believed one.
    """
    car = Fleet.draw(VEHICLE, fleet or nominal(), 1, np.random.default_rng(0))
    whole_grip, x = car.grip.copy(), car.at_slip(np.array([speed_mps]), np.array([0.001]))
    pending, before, rows = deque([0.0] * delay), np.zeros(1), []
    for tick in range(round(duration_s / PERIOD_S)):
        car.grip[:] = whole_grip * grip(tick * PERIOD_S)
        reference = request(tick * PERIOD_S)
        force_n = float(car.grip[0] * tyre_force_n(x[PATCH, 0], VEHICLE))
        wheel = sensed(x[:, 0], force_n, believed_delay * PERIOD_S)
        pending.append(controller.step(wheel, reference).torque_nm)
        rows.append((wheel.slip_ratio, x[TORQUE, 0], pending[-1]))
        acting = np.array([pending.popleft()])
        x = car.step(x, before, acting, PERIOD_S)
        before = acting
    return Loop(*(np.array(column) for column in zip(*rows, strict=True)))


def sensed(x: np.ndarray, force_n: float, loop_delay_s: float) -> WheelState:
    """What a perfect estimator sees."""
    slip_speed = x[WHEEL] * VEHICLE.wheel_radius_m - x[BODY]
    return WheelState(
        slip_speed_mps=slip_speed,
        wheel_speed_radps=x[WHEEL],
        slip_ratio=float(slip_ratio(slip_speed, x[WHEEL], VEHICLE)),
        vehicle_speed_mps=x[BODY],
        motor_speed_radps=x[MOTOR] * VEHICLE.gear_ratio,
        motor_torque_nm=x[TORQUE],
        tyre_force_n=force_n,
        loop_delay_s=loop_delay_s,
    )


def chatter_nm(loop: Loop, after_s: float = 0.6) -> float:
    """Mean step of the motor's torque from tick to tick."""
    return float(np.abs(np.diff(loop.torque_nm[round(after_s / PERIOD_S) :])).mean())
