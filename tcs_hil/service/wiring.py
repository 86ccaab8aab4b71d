"""The pure part of the service put together: laws and pipeline."""

from __future__ import annotations

from pathlib import Path

from tcs_hil.control.backend import Backend, chosen_backend
from tcs_hil.control.factory import make_controller
from tcs_hil.control.fallback import FallbackController
from tcs_hil.control.pi import PiController
from tcs_hil.control.protocol import Controller
from tcs_hil.estimator import Estimates, Estimator
from tcs_hil.estimator.fused import FusedEstimator
from tcs_hil.gate import Gate
from tcs_hil.model.bank import KoopmanBank, default_bank_path
from tcs_hil.model.predictor import KoopmanPredictor, default_model_path
from tcs_hil.pipeline import Law, Pipeline
from tcs_hil.plausibility import Plausibility
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
    predictor = _predictor(config) if config.kind is ControllerKind.KMPC else None
    left, right = (TimedController(_with_stand_in(config, predictor), clock) for _ in range(2))
    return left, right


def _with_stand_in(
    config: ServiceConfig, predictor: KoopmanPredictor | KoopmanBank | None
) -> Controller:
    """The configured law; one whose solver may fail gets a PI behind it."""
    law = make_controller(config.kind, config.control, config.vehicle, predictor)
    if config.kind in (ControllerKind.OFF, ControllerKind.PI):
        return law
    return FallbackController(law, PiController(config.control))


def backend_of(config: ServiceConfig) -> Backend:
    """What runs the laws: the native step, or Python.

    Raises:
        ConfigError: a native step is asked for that does not exist.
    """
    return chosen_backend(config.kind, config.control)


def _predictor(config: ServiceConfig) -> KoopmanPredictor | KoopmanBank:
    """The model file that the preset needs: the configured one, or the one shipped for it."""
    period_s = config.control.period_s
    if config.control.preset == "paper":
        return KoopmanPredictor.load(Path(config.model or default_model_path()), period_s)
    return KoopmanBank.load(Path(config.model or default_bank_path()), period_s)


def build_pipeline(config: ServiceConfig, laws: Laws) -> Pipeline:
    """The code between measurement and command around the two laws."""
    period_s = config.control.period_s
    return Pipeline(
        Plausibility(config.vehicle, period_s),
        _estimator(config),
        Supervisor(config.supervisor),
        Law(config.kind, config.control.slip_reference, laws),
        (Gate(config.gate, period_s), Gate(config.gate, period_s)),
    )


def _estimator(config: ServiceConfig) -> Estimates:
    if config.control.preset == "paper":
        return Estimator(config.vehicle)
    return FusedEstimator(config.control, config.vehicle)
