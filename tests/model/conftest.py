"""The paper's predictor, read once, and one identified from scratch."""

from __future__ import annotations

import pytest

from tcs_hil.model.edmd import IdentificationSettings, identify
from tcs_hil.model.predictor import KoopmanPredictor, default_model_path


@pytest.fixture(scope="session")
def paper() -> KoopmanPredictor:
    return KoopmanPredictor.load(default_model_path(), 0.002)


@pytest.fixture(scope="session")
def identified() -> KoopmanPredictor:
    return identify(IdentificationSettings())
