"""The driveline as the default laws believe it to be: motor lag, gear and half-shaft, tyre lag."""

from __future__ import annotations

from typing import Annotated, Final

import msgspec

from tcs_hil.model.vehicle import Positive

CREEP_MPS: Final = 1.5
"""Joins a tyre's rolling speed by their squares: a law that believes in a slow tyre near standstill
rings there."""


class Driveline(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """One motor, its gear and its half-shaft, seen from the wheel.

    ``motor_inertia_kgm2`` is the motor's 0.03 times the gear ratio squared; both
    inertias together are the 1.22 of the paper's rigid wheel.  ``motor_lag_s`` is
    the time constant from commanded to air-gap torque.  ``tyre_relaxation_m`` is
    the way a tyre rolls until its force has followed its slip, where it hardly
    slips, a little shorter than most: a law that believes in a quicker tyre feeds
    its swings at walking pace.  With slip it falls, as the secant of the tyre's
    curve does, to ``tyre_sliding_m``.
    ``shaft_damping_nmsprad`` is less than most shafts': who believes in little
    damping excites no shaft that has no more.
    """

    wheel_inertia_kgm2: Positive = 0.95
    motor_inertia_kgm2: Positive = 0.27
    shaft_stiffness_nmprad: Positive = 6000.0
    shaft_damping_nmsprad: Annotated[float, msgspec.Meta(ge=0.0, le=1e6)] = 25.0
    motor_lag_s: Annotated[float, msgspec.Meta(ge=0.001, le=1.0)] = 0.005
    tyre_relaxation_m: Annotated[float, msgspec.Meta(ge=0.05, le=10.0)] = 0.12
    tyre_sliding_m: Annotated[float, msgspec.Meta(ge=0.05, le=10.0)] = 0.07
