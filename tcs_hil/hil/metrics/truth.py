"""What every metric reads."""

from __future__ import annotations

from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

Truth: TypeAlias = NDArray[np.void]
"""Rows of ``plant_emulator.truth.TRUTH_DTYPE``, one per tick."""

FRONT = slice(0, 2)
"""The driven ones of the four wheels."""
