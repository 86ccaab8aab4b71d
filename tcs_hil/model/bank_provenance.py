"""Where a Koopman bank comes from and where it holds: settings and metadata of its file."""

from __future__ import annotations

from typing import Annotated, Literal

import msgspec
import numpy as np
from numpy.typing import NDArray

from tcs_hil.model.excitation import ExcitationSettings
from tcs_hil.model.fleet import FleetSettings
from tcs_hil.model.provenance import LAYOUT_VERSION, Source, Validity
from tcs_hil.model.ranges import Period, Range, check_rising
from tcs_hil.model.vehicle import Vehicle

FloatArray = NDArray[np.float64]


STANDSTILL_MPS = 0.02
"""What counts as the beginning of motion."""


class BandSettings(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Where the bands lie: centres in geometric progression, data from around each.

    ``overlap`` is how far the start speeds reach to both sides of a centre, as a
    factor; ``slip_ratio`` bounds the transitions a predictor is fitted to.
    """

    count: Annotated[int, msgspec.Meta(ge=1, le=40)] = 10
    centre_mps: Range = (0.35, 60.0)
    overlap: Annotated[float, msgspec.Meta(gt=1.0, le=4.0)] = 1.6
    slip_ratio: Range = (-0.05, 0.3)

    def __post_init__(self) -> None:
        check_rising(self)
        if self.centre_mps[0] <= 0.0:
            raise ValueError("centre_mps must be above 0")

    def centres_mps(self) -> FloatArray:
        """Centre of each band (count,)."""
        return np.geomspace(*self.centre_mps, self.count)

    def reach_mps(self, band: int) -> Range:
        """Start speeds of the data of one band; the lowest reaches down to standstill."""
        centre = float(self.centres_mps()[band])
        return (STANDSTILL_MPS if band == 0 else centre / self.overlap), centre * self.overlap


class BankSettings(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """What to identify from what."""

    period_s: Period = 0.002
    vehicle: Vehicle = Vehicle()
    bands: BandSettings = BandSettings()
    fleet: FleetSettings = FleetSettings()
    excitation: ExcitationSettings = ExcitationSettings()


class BandFit(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """One band: its data, and the one-step error of the slip ratio on the data it saw."""

    source: Source
    samples: int
    speed_mps: Range
    slip_residual_rms: float


class BankProvenance(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Everything a bank is, apart from its matrices: the model file's metadata."""

    layout_version: int = LAYOUT_VERSION
    kind: Literal["bank"] = "bank"
    source: Source
    settings: BankSettings
    validity: Validity
    fits: tuple[BandFit, ...]
    seed: int

    @property
    def period_s(self) -> float:
        """Sampling time in seconds."""
        return self.settings.period_s
