"""From a controller's kind to a controller: the only place that knows them all."""

from __future__ import annotations

from tcs_hil.control.backend import Backend, chosen_backend
from tcs_hil.control.off import OffController
from tcs_hil.control.pi import PiController
from tcs_hil.control.protocol import Controller
from tcs_hil.control.settings import ControlSettings
from tcs_hil.errors import ConfigError
from tcs_hil.model.bank import KoopmanBank
from tcs_hil.model.predictor import KoopmanPredictor
from tcs_hil.model.vehicle import Vehicle
from tcs_hil.signals import ControllerKind


def make_controller(
    kind: ControllerKind,
    settings: ControlSettings,
    vehicle: Vehicle,
    predictor: KoopmanPredictor | KoopmanBank | None = None,
) -> Controller:
    """One wheel's controller; only the Koopman MPC needs the predictor.

    The preset ``paper`` takes a single one, ``default`` a bank.

    Solvers are imported where they are used: a service that runs the PI, or a
    native step, loads neither OSQP nor CasADi.  Raises ConfigError for a predictor
    that is missing or made for another period, and for a native step that is asked
    for and does not exist.
    """
    backend = chosen_backend(kind, settings)
    if kind is ControllerKind.OFF:
        return OffController()
    if kind is ControllerKind.PI:
        return PiController(settings)
    if kind is ControllerKind.NMPC:
        return _nonlinear(settings, vehicle, backend)
    return _koopman(settings, predictor, backend)


def _nonlinear(settings: ControlSettings, vehicle: Vehicle, backend: Backend) -> Controller:
    if settings.preset == "default":
        from tcs_hil.control.driveline_nmpc import driveline_mpc  # noqa: PLC0415

        return driveline_mpc(settings, vehicle)
    if backend == "native":
        from tcs_hil.control.native_nmpc import native_nonlinear_mpc  # noqa: PLC0415

        return native_nonlinear_mpc(settings, vehicle)
    from tcs_hil.control.nmpc import nonlinear_mpc  # noqa: PLC0415

    return nonlinear_mpc(settings, vehicle)


def _koopman(
    settings: ControlSettings,
    predictor: KoopmanPredictor | KoopmanBank | None,
    backend: Backend,
) -> Controller:
    if predictor is None:
        raise ConfigError("controller KMPC needs a model file")
    if settings.preset == "default" and isinstance(predictor, KoopmanBank):
        from tcs_hil.control.bank_law import bank_mpc  # noqa: PLC0415

        return bank_mpc(settings, predictor)
    if settings.preset == "paper" and isinstance(predictor, KoopmanPredictor):
        if backend == "native":
            from tcs_hil.control.native_kmpc import native_koopman_mpc  # noqa: PLC0415

            return native_koopman_mpc(settings, predictor)
        from tcs_hil.control.kmpc import koopman_mpc  # noqa: PLC0415

        return koopman_mpc(settings, predictor)
    raise ConfigError(f"the model file is not of the kind that preset {settings.preset} needs")
