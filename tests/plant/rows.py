"""What a plant did, as its truth tells it."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from plant_emulator.plant import Plant
from plant_emulator.truth import TRUTH_DTYPE


def rows(plant: Plant, duration_s: float, dt_s: float = 0.002) -> NDArray[np.void]:
    """Drive with nothing limited; (1 + duration / dt,) rows of the truth, the start among them."""
    recorded = [plant.row]
    for _ in range(round(duration_s / dt_s)):
        plant.step(None, dt_s)
        recorded.append(plant.row)
    return np.array(recorded).view(TRUTH_DTYPE)[:, 0]
