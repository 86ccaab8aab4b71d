"""Settings of the control laws: as published (``paper``, Table II), and to be run (``default``)."""

from __future__ import annotations

from typing import Annotated, ClassVar, Literal

import msgspec

from tcs_hil.control.driveline import Driveline

# Every bound is finite: TOML can say `inf`, and no law can follow it there.
Weight = Annotated[float, msgspec.Meta(ge=0.0, le=1e12)]
PositiveWeight = Annotated[float, msgspec.Meta(gt=0.0, le=1e12)]
TimeConstant = Annotated[float, msgspec.Meta(gt=0.0, le=10.0)]
Speed = Annotated[float, msgspec.Meta(gt=0.0, le=100.0)]
PresetName = Literal["paper", "default"]
BackendName = Literal["auto", "native", "python"]
BlockPeriods = Annotated[int, msgspec.Meta(ge=1, le=2)]  # at most 4 ms: one Runge-Kutta step
Horizon = Annotated[int, msgspec.Meta(ge=1, le=40)]


class PiSettings(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Speed-scheduled PI: gain = base + slope · min(v, ceiling), in Nm per unit slip."""

    gain_base_nm: PositiveWeight = 20.0
    gain_slope_nm_per_mps: Weight = 80.0
    gain_speed_ceiling_mps: Speed = 15.0
    integral_time_s: TimeConstant = 0.05
    entry_ratio: Annotated[float, msgspec.Meta(gt=0.0, le=1.0)] = 0.8
    """Share of the slip reference at which the law takes over from the driver."""
    entry_slip_mps: Weight = 0.0
    """Least slip speed to take over at: near standstill a ratio is made of noise."""


class KmpcSettings(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Koopman MPC, weighted in the predictor's units.

    Those are physical for kappa and e_int, and standard deviations of the data
    set for the torque.
    """

    horizon: Horizon = 5
    weight_slip: Weight = 0.75
    weight_integral: Weight = 500.0
    weight_reduction: PositiveWeight = 1e-6  # positive: it makes the QP strictly convex


class NmpcSettings(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Nonlinear MPC, weighted in physical units: kappa, seconds and Nm."""

    horizon: Horizon = 5
    weight_slip: Weight = 1e3
    weight_integral: Weight = 1e5
    weight_reduction: PositiveWeight = 1.6e-7  # positive: it makes every QP strictly convex
    substeps: Annotated[int, msgspec.Meta(ge=4, le=40)] = 4  # fewer diverge at standstill
    max_iterations: Annotated[int, msgspec.Meta(ge=1, le=100)] = 20
    leftover_nm: ClassVar[float] = 0.0  # every tick is solved to convergence


class DrivelineNmpcSettings(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Nonlinear MPC with the driveline in its model; weights in physical units.

    ``blocks`` are the periods each torque of the plan is held for: fine where it
    will be sent, coarse where it only has to be foreseen.
    """

    blocks: Annotated[tuple[BlockPeriods, ...], msgspec.Meta(min_length=2, max_length=40)] = (
        *(1, 1, 1, 1, 2, 2),
        *(2, 2, 2, 2),
    )
    weight_slip: Weight = 1e3
    weight_integral: Weight = 0.0
    weight_reduction: PositiveWeight = 1.2e-5
    weight_change: PositiveWeight = 3.7e-2  # on (u_k - u_{k-1})²
    max_iterations: Annotated[int, msgspec.Meta(ge=1, le=100)] = 2
    leftover_nm: ClassVar[float] = 1e-3
    """What a tick may leave to the next one: a fiftieth of what the bus can say of a torque."""
    observer_time_s: TimeConstant = 0.016  # of the force disturbance
    entry_ratio: Annotated[float, msgspec.Meta(ge=0.0, le=1.0)] = 0.3
    """Share of the slip reference at which the law takes over from the driver."""
    entry_slip_mps: Weight = 0.06
    """Least slip speed to take over at: near standstill a ratio is made of noise."""
    soft_speed_mps: Speed = 2.5
    """Below it slip answers torque so fast that its weights shrink with the speed squared."""


class BankKmpcSettings(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Koopman MPC on a bank of predictors; weights in physical units."""

    horizon: Horizon = 16
    weight_slip: Weight = 1e3
    weight_integral: Weight = 2e6
    weight_reduction: PositiveWeight = 5e-5
    weight_change: PositiveWeight = 5e-2  # on (u_k - u_{k-1})²
    observer_time_s: TimeConstant = 0.045  # of the speed disturbance
    online_update: bool = False  # of the predictor, by the grip observed
    weights_speed_mps: Speed = 5.3
    """Where the weights of slip and integral are as given; they go with the speed squared."""


class DelaySettings(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """From the instant of a measurement to the first effect of its command, on the bus's clock.

    ``delay_s`` is believed as it is, or, if ``measured``, only until the service
    has seen its limits come back in the motors' torque.
    """

    delay_s: Annotated[float, msgspec.Meta(ge=0.0, le=0.02)] = 0.006
    measured: bool = True


class DefaultSettings(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """What the preset ``default`` runs: every law, and what they share."""

    driveline: Driveline = Driveline()
    delay: DelaySettings = DelaySettings()
    integral_limit_s: Annotated[float, msgspec.Meta(gt=0.0, le=1.0)] = 0.02
    pi: PiSettings = PiSettings(
        gain_base_nm=2.0,
        gain_slope_nm_per_mps=16.0,
        integral_time_s=0.03,
        entry_ratio=1.0,
        entry_slip_mps=0.15,
    )
    kmpc: BankKmpcSettings = BankKmpcSettings()
    nmpc: DrivelineNmpcSettings = DrivelineNmpcSettings()


class ControlSettings(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """What all laws share, once, and the tuning of each.

    ``pi``, ``kmpc`` and ``nmpc`` belong to the preset ``paper``, ``default`` to
    the other.  ``backend`` is the code that runs them: with ``auto`` the native
    step wherever it was built.
    """

    preset: PresetName = "default"
    backend: BackendName = "auto"
    period_s: Annotated[float, msgspec.Meta(ge=1e-4, le=0.02)] = 0.002
    slip_reference: Annotated[float, msgspec.Meta(gt=0.0, le=0.5)] = 0.1
    pi: PiSettings = PiSettings()
    kmpc: KmpcSettings = KmpcSettings()
    nmpc: NmpcSettings = NmpcSettings()
    default: DefaultSettings = DefaultSettings()
