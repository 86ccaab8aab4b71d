"""What the tests of the control laws share: the shipped predictor and every law by name."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from tcs_hil.control.factory import make_controller
from tcs_hil.control.protocol import Controller
from tcs_hil.control.settings import ControlSettings
from tcs_hil.model.predictor import KoopmanPredictor, default_model_path
from tcs_hil.model.vehicle import Vehicle
from tcs_hil.signals import ControllerKind


@pytest.fixture(scope="session")
def predictor() -> KoopmanPredictor:
    return KoopmanPredictor.load(default_model_path(), ControlSettings().period_s)


@pytest.fixture(scope="session")
def make(predictor: KoopmanPredictor) -> Callable[[ControllerKind], Controller]:
    """A new controller of a kind, with the paper's settings."""
    return lambda kind: make_controller(kind, ControlSettings(preset="paper"), Vehicle(), predictor)
