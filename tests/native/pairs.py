"""Every law that has a native step, in C and in Python, and what both are asked."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, field

import numpy as np
from msgspec.structs import replace

from tcs_hil.control.factory import make_controller
from tcs_hil.control.protocol import Controller, Proposal, SolveStatus, WheelState
from tcs_hil.control.settings import ControlSettings
from tcs_hil.model.bank import KoopmanBank, default_bank_path
from tcs_hil.model.predictor import KoopmanPredictor, default_model_path
from tcs_hil.model.vehicle import Vehicle
from tcs_hil.signals import ControllerKind
from tests.control.recorder import wheel_at

PAPER = ControlSettings(preset="paper")
DEFAULT = ControlSettings()
PREDICTOR = KoopmanPredictor.load(default_model_path(), PAPER.period_s)
BANK = KoopmanBank.load(default_bank_path(), DEFAULT.period_s)


def both(
    kind: ControllerKind,
    settings: ControlSettings = PAPER,
    predictor: KoopmanPredictor | KoopmanBank | None = None,
    vehicle: Vehicle | None = None,
) -> tuple[Controller, Controller]:
    """The law in C and the law in Python."""
    model = predictor or (PREDICTOR if settings.preset == "paper" else BANK)
    native, python = (
        make_controller(kind, replace(settings, backend=name), vehicle or Vehicle(), model)
        for name in ("native", "python")
    )
    return native, python


@dataclass
class SideBySide:
    """The law in Python closes the loop; the one in C is asked the same."""

    laws: tuple[Controller, Controller]
    answers: list[tuple[Proposal, Proposal]] = field(default_factory=list)

    def step(self, wheel: WheelState, torque_ref_nm: float) -> Proposal:
        native, python = (law.step(wheel, torque_ref_nm) for law in self.laws)
        self.answers.append((native, python))
        return python

    def reset(self) -> None:
        for law in self.laws:
            law.reset()

    def worst_nm(self, beyond: SolveStatus = SolveStatus.FAILED) -> float:
        """Largest difference of their torques, those for the period after included.

        Answers whose status is ``beyond`` or worse are left out.
        """
        judged = [answer for answer in self.answers if answer[1].status < beyond]
        torques = np.array([_torques_nm(*answer) for answer in judged])  # (n, 2, 2)
        return float(np.nanmax(np.abs(torques[:, 0] - torques[:, 1])))


def _torques_nm(*proposals: Proposal) -> list[tuple[float, float]]:
    return [(proposal.torque_nm, proposal.next_nm) for proposal in proposals]


def random_questions(seed: int, count: int) -> Iterator[tuple[WheelState, float]]:
    """Wheels and requests from all over, one after the other without any sense."""
    rng = np.random.default_rng(seed)
    for _ in range(count):
        torque_nm = rng.uniform(0.0, 250.0)  # without it the PI decides
        wheel = wheel_at(rng.uniform(0.0, 40.0), rng.uniform(-0.1, 0.9), torque_nm)
        seen = replace(
            wheel,
            shaft_twist_rad=rng.choice((math.nan, rng.uniform(-0.1, 0.1))),
            tyre_force_n=rng.choice((math.nan, rng.uniform(-500.0, 2000.0))),
            vehicle_accel_mps2=rng.choice((math.nan, rng.uniform(-3.0, 6.0))),
            sent_nm=rng.choice((math.nan, rng.uniform(0.0, 250.0))),
            loop_delay_s=rng.uniform(0.0, 0.02),
        )
        yield seen, rng.uniform(0.0, 250.0)
