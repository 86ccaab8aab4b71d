"""What a longer horizon and a richer lifting cost the published laws."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Literal, NamedTuple

import msgspec
from msgspec.structs import replace

from tcs_hil.control.backend import Backend
from tcs_hil.control.factory import make_controller
from tcs_hil.control.settings import ControlSettings
from tcs_hil.hil.bench.candidates import PAPER, PREDICTIVE, backends
from tcs_hil.hil.bench.controllers import drive_of, replay
from tcs_hil.hil.bench.effort import Effort, Progress
from tcs_hil.hil.bench.statistics import Cost, Stopwatch, quiet_collector
from tcs_hil.model.edmd import IdentificationSettings, identify
from tcs_hil.model.predictor import KoopmanPredictor, default_model_path
from tcs_hil.model.vehicle import Vehicle
from tcs_hil.signals import ControllerKind

MANOEUVRE = "manoeuvre-1"
Axis = Literal["horizon", "order"]


class ScalingRow(msgspec.Struct, frozen=True):
    """A published law with one thing changed, replayed along the drive of the unchanged one."""

    law: str
    code: str
    axis: Axis
    value: int
    cost: Cost


class _Variation(NamedTuple):
    kind: ControllerKind
    backend: Backend
    axis: Axis
    value: int


def measure_scaling(effort: Effort, progress: Progress) -> list[ScalingRow]:
    """Vary the horizon of both laws and the order of the Koopman predictor's monomials."""
    work = list(_variations(effort))
    published = KoopmanPredictor.load(default_model_path(), PAPER.period_s)
    predictors = {order: identify(IdentificationSettings(order=order)) for order in effort.orders}
    rows = []
    for done, variation in enumerate(work):
        kind, backend, axis, value = variation
        progress(done / len(work), f"{kind.name} {backend}, {axis} {value}")
        predictor = predictors[value] if axis == "order" else published
        rows.append(
            ScalingRow(kind.name, backend, axis, value, _cost(variation, predictor, effort))
        )
    return rows


def _variations(effort: Effort) -> Iterator[_Variation]:
    for kind in PREDICTIVE:
        for backend in backends(kind, "paper"):
            for horizon in effort.horizons:
                yield _Variation(kind, backend, "horizon", horizon)
            if kind is ControllerKind.KMPC:
                for order in effort.orders:
                    yield _Variation(kind, backend, "order", order)


def _cost(variation: _Variation, predictor: KoopmanPredictor, effort: Effort) -> Cost:
    kind, backend, axis, value = variation
    settings = ControlSettings(preset="paper", backend=backend)
    if axis == "horizon":
        kmpc, nmpc = replace(settings.kmpc, horizon=value), replace(settings.nmpc, horizon=value)
        settings = replace(settings, kmpc=kmpc, nmpc=nmpc)
    questions = drive_of(MANOEUVRE, kind.name, "paper").questions[: effort.questions]
    watch = Stopwatch()
    controller = make_controller(kind, settings, Vehicle(), predictor)
    with quiet_collector():
        replay(controller, questions, watch)
    return watch.cost
