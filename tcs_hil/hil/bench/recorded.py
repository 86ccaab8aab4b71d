"""A drive to be replayed: what the laws were asked in every tick, and the frames of the bus."""

from __future__ import annotations

from itertools import groupby
from typing import NamedTuple

from plant_emulator.scenario import load_scenario
from tcs_hil.canbus.frame import Frame
from tcs_hil.control.protocol import Controller, Proposal, WheelState
from tcs_hil.control.settings import PresetName
from tcs_hil.hil.simulation import simulate
from tcs_hil.runtime.clock import MonotonicClock
from tcs_hil.runtime.stopwatch import TimedController
from tcs_hil.service.settings import ServiceConfig
from tcs_hil.service.wiring import build_laws

VARIANTS = {"paper": "quarter-car", "default": "vehicle"}
"""The car each preset was made for."""


class Question(NamedTuple):
    """What a law is asked for one wheel in one tick."""

    wheel: WheelState
    torque_ref_nm: float


class Drive(NamedTuple):
    """The left wheel's questions since its law was last reset, and the frames of every tick."""

    questions: list[Question]
    ticks: list[list[Frame]]


class Witness:
    """A controller that remembers what the one it wraps was asked."""

    def __init__(self, controller: Controller) -> None:
        self._controller = controller
        self.questions: list[Question] = []

    def step(self, wheel: WheelState, torque_ref_nm: float) -> Proposal:
        """Pass the question on."""
        self.questions.append(Question(wheel, torque_ref_nm))
        return self._controller.step(wheel, torque_ref_nm)

    def reset(self) -> None:
        """Forget with the law."""
        self.questions.clear()
        self._controller.reset()


def record_drive(manoeuvre: str, config: ServiceConfig) -> Drive:
    """Simulate a shipped scenario with the car that the configuration's preset was made for."""
    preset: PresetName = config.control.preset
    scenario = load_scenario(manoeuvre).with_variant(VARIANTS[preset])  # type: ignore[arg-type]
    clock, frames = MonotonicClock(), list[Frame]()
    left, right = (Witness(law) for law in build_laws(config, clock))
    laws = TimedController(left, clock), TimedController(right, clock)
    simulate(scenario, config, laws, frames.append)
    ticks = [list(tick) for _, tick in groupby(frames, key=lambda frame: frame.stamp_ns)]
    return Drive(left.questions, ticks)
