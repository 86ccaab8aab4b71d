"""Extended dynamic mode decomposition: the predictor that fits a data set best in one step."""

from __future__ import annotations

from typing import NamedTuple

import msgspec
import numpy as np
from numpy.typing import NDArray

from tcs_hil.errors import ModelError
from tcs_hil.model.dataset import Dataset, DatasetSettings, Progress, generate
from tcs_hil.model.lifting import Dictionary, Monomials, fit_scaling, lift, scale_state
from tcs_hil.model.predictor import FitQuality, KoopmanPredictor, Validity, lift_states
from tcs_hil.model.vehicle import Vehicle
