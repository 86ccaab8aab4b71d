"""The pure part of the service put together: laws and pipeline."""

from __future__ import annotations

from pathlib import Path

from tcs_hil.control.factory import make_controller
from tcs_hil.estimator import Estimator
from tcs_hil.gate import Gate
from tcs_hil.model.predictor import KoopmanPredictor, default_model_path
from tcs_hil.pipeline import Law, Pipeline
from tcs_hil.runtime.clock import Clock
from tcs_hil.runtime.stopwatch import TimedController
from tcs_hil.service.settings import ServiceConfig
from tcs_hil.signals import ControllerKind
from tcs_hil.supervisor import Supervisor

Laws = tuple[TimedController, TimedController]


def build_laws(config: ServiceConfig, clock: Clock) -> Laws:
    """One controller per driven wheel, left and right.

    Raises:
        ModelError: the Koopman predictor cannot be used.
    """
    predictor = None
    if config.kind is ControllerKind.KMPC:
        path = default_model_path() if config.model is None else Path(config.model)
        predictor = KoopmanPredictor.load(path, config.control.period_s)
    left, right = (
        TimedController(
            make_controller(config.kind, config.control, config.vehicle, predictor), clock
        )
        for _ in range(2)
    )
    return left, right


def build_pipeline(config: ServiceConfig, laws: Laws) -> Pipeline:
    """The code between measurement and command around the two laws."""
    period_s = config.control.period_s
    return Pipeline(
        Estimator(config.vehicle),
        Supervisor(config.supervisor),
        Law(config.kind, config.control.slip_reference, laws),
        (Gate(config.gate, period_s), Gate(config.gate, period_s)),
    )
