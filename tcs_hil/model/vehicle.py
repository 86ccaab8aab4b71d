"""Parameters of the car as the controllers believe it to be (the paper's Table I)."""

from __future__ import annotations

from typing import Annotated

import msgspec

Positive = Annotated[float, msgspec.Meta(ge=1e-6, le=1e6)]
"""Of any quantity of a car in SI units; what lies outside is a slip of the pen."""

GRAVITY_MPS2 = 9.81


class Vehicle(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """The paper's quarter car: one driven wheel with its own motor.

    ``mass_kg`` is the whole car's; every equation uses a quarter of it.
    ``motor_torque_max_nm`` is per driven wheel, on the motor side of the gear.
    """

    mass_kg: Positive = 1400.0
    wheel_radius_m: Positive = 0.318
    wheel_inertia_kgm2: Positive = 1.22
    gear_ratio: Positive = 3.0
    motor_torque_max_nm: Positive = 250.0
    tyre_d: Positive = 1.2005
    tyre_c: Positive = 1.4010
    tyre_b: Positive = 17.1571
    friction_ratio: Positive = 0.3
    slip_epsilon_m2ps2: Positive = 0.1

    @property
    def wheel_load_n(self) -> float:
        """Vertical load on one wheel, F_z = m g / 4."""
        return self.mass_kg * GRAVITY_MPS2 / 4.0
