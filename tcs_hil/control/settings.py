"""Settings of the control laws; the defaults are the paper's (Table II), the preset ``paper``."""

from __future__ import annotations

from typing import Annotated

import msgspec

Weight = Annotated[float, msgspec.Meta(ge=0.0)]
PositiveWeight = Annotated[float, msgspec.Meta(gt=0.0)]
Horizon = Annotated[int, msgspec.Meta(ge=1, le=40)]


class PiSettings(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Speed-scheduled PI: gain = base + slope · min(v, ceiling), in Nm per unit slip."""

    gain_base_nm: PositiveWeight = 20.0
    gain_slope_nm_per_mps: Weight = 80.0
    gain_speed_ceiling_mps: PositiveWeight = 15.0
    integral_time_s: PositiveWeight = 0.05
    entry_ratio: Annotated[float, msgspec.Meta(gt=0.0, le=1.0)] = 0.8
    """Share of the slip reference at which the law takes over from the driver."""


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


class ControlSettings(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """What all laws share, once, and the tuning of each."""

    period_s: Annotated[float, msgspec.Meta(gt=0.0, le=0.02)] = 0.002
    slip_reference: Annotated[float, msgspec.Meta(gt=0.0, le=0.5)] = 0.1
    pi: PiSettings = PiSettings()
    kmpc: KmpcSettings = KmpcSettings()
    nmpc: NmpcSettings = NmpcSettings()
