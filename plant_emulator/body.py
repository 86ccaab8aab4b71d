"""The body: longitudinal motion, heave and pitch on two axles, air drag, grade and parking hold.

The sprung mass stands on one spring and damper per axle; wheels follow the road
(the tyre is stiff vertically, wheel hop is left out).  Suspension links are level
with the hubs, so tyre forces reach the body at hub height and the motors, which
hang on it, react there: in a steady state the load transfer is m a h / L exactly.
"""

from __future__ import annotations

from typing import Annotated, NamedTuple

from msgspec import Meta

from plant_emulator.bounds import NonNegative, Positive, Table
from plant_emulator.compiled import compiled
from tcs_hil.signals import Pair

GRAVITY_MPS2 = 9.81


class Body(Table, frozen=True):
    """Masses, geometry and suspension; the paper's CarMaker car where it gives figures.

    ``unsprung_mass_kg`` is one wheel assembly with its carrier (32 + 15.5 kg), the
    same on all four corners.  ``load_transfer`` false freezes pitch and heave and
    keeps the static loads.
    """

    mass_kg: Positive = 1400.0
    unsprung_mass_kg: Positive = 47.5
    wheelbase_m: Positive = 2.62
    cg_behind_front_axle_m: Positive = 1.29
    cg_height_m: Positive = 0.526
    wheel_radius_m: Positive = 0.318
    wheel_inertia_kgm2: Annotated[float, Meta(ge=0.2)] = 0.95
    pitch_inertia_kgm2: Positive = 1900.0
    front_stiffness_npm: Positive = 40_000.0  # both springs of the axle
    rear_stiffness_npm: Positive = 42_000.0
    front_damping_nspm: NonNegative = 3500.0
    rear_damping_nspm: NonNegative = 3500.0
    drag_area_m2: NonNegative = 0.65  # c_d A
    air_density_kgpm3: NonNegative = 1.2
    hold_torque_nm: NonNegative = 1500.0  # per wheel
    hold_stiffness_nmprad: Positive = 50_000.0
    hold_damping_nmsprad: NonNegative = 1500.0
    load_transfer: bool = True

    def __post_init__(self) -> None:
        """Refuse a car lighter than its wheels, or one that would tip over standing still."""
        if self.mass_kg <= 4.0 * self.unsprung_mass_kg:
            raise ValueError("`mass_kg` must be greater than four times `unsprung_mass_kg`")
        if self.cg_behind_front_axle_m >= self.wheelbase_m:
            raise ValueError("`cg_behind_front_axle_m` must be less than `wheelbase_m`")


class Sprung(NamedTuple):
    """The sprung mass and where its centre of gravity is."""

    mass_kg: float
    behind_front_axle_m: float
    before_rear_axle_m: float
    above_hubs_m: float


@compiled
def sprung(body: Body) -> Sprung:
    """Take the wheels away from the whole car: mass and moments of the rest."""
    axle_kg = 2.0 * body.unsprung_mass_kg
    mass_kg = body.mass_kg - 2.0 * axle_kg
    behind_m = (body.mass_kg * body.cg_behind_front_axle_m - axle_kg * body.wheelbase_m) / mass_kg
    height_m = (body.mass_kg * body.cg_height_m - 2.0 * axle_kg * body.wheel_radius_m) / mass_kg
    return Sprung(mass_kg, behind_m, body.wheelbase_m - behind_m, height_m - body.wheel_radius_m)


@compiled
def suspension(body: Body, part: Sprung, heave: Pair, pitch: Pair) -> Pair:
    """Force of the front and the rear axle's springs and dampers beyond the static one, N, up.

    ``heave`` is (m, m/s) up, ``pitch`` (rad, rad/s) nose up, both from the level
    static position.
    """
    front_m = heave[0] + part.behind_front_axle_m * pitch[0]
    front_mps = heave[1] + part.behind_front_axle_m * pitch[1]
    rear_m = heave[0] - part.before_rear_axle_m * pitch[0]
    rear_mps = heave[1] - part.before_rear_axle_m * pitch[1]
    return (
        -body.front_stiffness_npm * front_m - body.front_damping_nspm * front_mps,
        -body.rear_stiffness_npm * rear_m - body.rear_damping_nspm * rear_mps,
    )


@compiled
def wheel_loads(body: Body, front_n: float, rear_n: float, grade_cos: float) -> Pair:
    """Load on one front and one rear wheel, N, given the axles' forces beyond the static ones.

    Never negative: a wheel does not pull at the road.
    """
    weight_n = body.mass_kg * GRAVITY_MPS2 * grade_cos
    rear_share = body.cg_behind_front_axle_m / body.wheelbase_m
    return (
        max(0.5 * (weight_n * (1.0 - rear_share) + front_n), 0.0),
        max(0.5 * (weight_n * rear_share + rear_n), 0.0),
    )


@compiled
def drag(body: Body, speed_mps: float) -> float:
    """Air drag, N, at the height of the centre of gravity."""
    return 0.5 * body.air_density_kgpm3 * body.drag_area_m2 * speed_mps * abs(speed_mps)


@compiled
def pitch_moment(part: Sprung, push_n: float, reaction_nm: float) -> float:
    """Moment on the sprung mass, Nm, nose up.

    The links push it at hub height; motors and brakes turn it with the reaction
    to their torque on the wheels.
    """
    return push_n * part.above_hubs_m + reaction_nm


@compiled
def hold_torque(body: Body, angle_rad: float, omega_radps: float) -> float:
    """Torque of a closed brake on a wheel turned by ``angle_rad`` since it closed, Nm."""
    torque_nm = -body.hold_stiffness_nmprad * angle_rad - body.hold_damping_nmsprad * omega_radps
    return min(max(torque_nm, -body.hold_torque_nm), body.hold_torque_nm)
