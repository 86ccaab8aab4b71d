"""Whose step is timed: our laws, native and in Python, and what others offer for the same task."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import cache, partial
from importlib.util import find_spec
from typing import NamedTuple

from tcs_hil.control.backend import Backend, chosen_backend
from tcs_hil.control.factory import make_controller
from tcs_hil.control.integrator import SlipErrorIntegral
from tcs_hil.control.predictive import Optimiser, PredictiveController
from tcs_hil.control.protocol import Controller
from tcs_hil.control.settings import ControlSettings, PresetName
from tcs_hil.model.bank import KoopmanBank, default_bank_path
from tcs_hil.model.predictor import KoopmanPredictor, default_model_path
from tcs_hil.model.vehicle import Vehicle
from tcs_hil.signals import ControllerKind

PAPER = ControlSettings(preset="paper")
PREDICTIVE = (ControllerKind.KMPC, ControllerKind.NMPC)
PRESETS: tuple[PresetName, ...] = ("paper", "default")
EXACT = {ControllerKind.KMPC: "daqp", ControllerKind.NMPC: "IPOPT"}
"""Whose answers to the published problems count as the right ones."""


class Candidate(NamedTuple):
    """A law of a preset, who computes it, and how one is made; None where it is not installed."""

    kind: ControllerKind
    preset: PresetName
    code: str
    make: Callable[[], Controller] | None
    ours: bool

    @property
    def is_exact(self) -> bool:
        """Whether the others are compared with this one."""
        return self.code == EXACT[self.kind]


def candidates() -> list[Candidate]:
    """Everybody, each law's exact solver first among those of its problem."""
    everybody = [*_peers(), *_ours()]
    return sorted(everybody, key=lambda c: (c.preset != "paper", c.kind, not c.is_exact))


def backends(kind: ControllerKind, preset: PresetName) -> tuple[Backend, ...]:
    """Native where that was built, and Python."""
    best = chosen_backend(kind, ControlSettings(preset=preset))
    return ("native", "python") if best == "native" else ("python",)


@cache
def model(preset: PresetName) -> KoopmanPredictor | KoopmanBank:
    """The shipped model file that a preset needs."""
    if preset == "paper":
        return KoopmanPredictor.load(default_model_path(), PAPER.period_s)
    return KoopmanBank.load(default_bank_path(), PAPER.period_s)


def _ours() -> Iterator[Candidate]:
    for preset in PRESETS:
        for kind in PREDICTIVE:
            for backend in backends(kind, preset):
                settings = ControlSettings(preset=preset, backend=backend)
                make = partial(make_controller, kind, settings, Vehicle(), model(preset))
                yield Candidate(kind, preset, backend, make, ours=True)


def _peers() -> Iterator[Candidate]:
    """Solvers we need ourselves, and do-mpc, which only a comparison needs."""
    do_mpc = _do_mpc if find_spec("do_mpc") is not None else None
    for kind, code, make in (
        (ControllerKind.KMPC, "daqp", _daqp),
        (ControllerKind.KMPC, "OSQP", _osqp),
        (ControllerKind.NMPC, "IPOPT", _ipopt),
        (ControllerKind.NMPC, "do-mpc", do_mpc),
    ):
        yield Candidate(kind, "paper", code, make, ours=False)


def _receding(optimiser: Optimiser) -> Controller:
    return PredictiveController(optimiser, SlipErrorIntegral(PAPER.slip_reference, PAPER.period_s))


# What follows imports only what it makes: each of these libraries takes its time.


def _daqp() -> Controller:
    from tcs_hil.hil.bench.koopman_peers import DaqpModel, optimiser  # noqa: PLC0415

    return _receding(optimiser(PAPER, DaqpModel))


def _osqp() -> Controller:
    from tcs_hil.hil.bench.koopman_peers import OsqpPublic, optimiser  # noqa: PLC0415

    return _receding(optimiser(PAPER, OsqpPublic))


def _ipopt() -> Controller:
    from tcs_hil.hil.bench.ipopt_peer import Ipopt  # noqa: PLC0415

    return _receding(Ipopt(PAPER, Vehicle()))


def _do_mpc() -> Controller:
    from tcs_hil.hil.bench.do_mpc_peer import DoMpc  # noqa: PLC0415

    return _receding(DoMpc(PAPER, Vehicle()))
