"""Outside its validity a law hands over to its fallback, and takes over again, smoothly."""

from __future__ import annotations

from dataclasses import dataclass

from tcs_hil.control.guarded import HAND_OVER_S, GuardedController
from tcs_hil.control.protocol import Proposal, SolveStatus, WheelState
from tcs_hil.model.provenance import Validity
from tests.control.recorder import wheel_at

PERIOD_S = 0.002
VALID = Validity(speed_mps=(1.0, 10.0), slip_ratio=(0.0, 0.3), torque_nm=(0.0, 250.0))
INSIDE, OUTSIDE = wheel_at(5.0, 0.1), wheel_at(11.0, 0.1)


@dataclass
class Fixed:
    """A law of one opinion."""

    torque_nm: float
    status: SolveStatus = SolveStatus.OK
    resets: int = 0

    def step(self, wheel: WheelState, torque_ref_nm: float) -> Proposal:
        return Proposal(self.torque_nm, self.status)

    def reset(self) -> None:
        self.resets += 1


def guarded(law: Fixed | None = None, fallback: Fixed | None = None) -> GuardedController:
    return GuardedController(law or Fixed(100.0), fallback or Fixed(60.0), VALID, PERIOD_S)


def torques(controller: GuardedController, wheel: WheelState, ticks: int) -> list[float]:
    return [controller.step(wheel, 200.0).torque_nm for _ in range(ticks)]


def test_inside_its_validity_the_law_decides() -> None:
    assert torques(guarded(), INSIDE, 3) == [100.0] * 3


def test_outside_the_fallback_takes_over_without_a_bump() -> None:
    ticks = round(HAND_OVER_S / PERIOD_S)
    handed = torques(guarded(), OUTSIDE, ticks + 2)
    steps = [before - after for before, after in zip([100.0, *handed], handed, strict=False)]
    assert max(steps) <= 40.0 / ticks + 1e-9
    assert handed[-1] == 60.0


def test_back_inside_the_law_takes_over_again_as_smoothly() -> None:
    controller = guarded()
    torques(controller, OUTSIDE, 40)
    back = torques(controller, INSIDE, 40)
    assert back[0] < 62.0
    assert back[-1] == 100.0


def test_straying_over_the_border_for_one_tick_hardly_matters() -> None:
    controller = guarded()
    assert torques(controller, OUTSIDE, 1)[0] > 98.0
    assert torques(controller, INSIDE, 1)[0] == 100.0


def test_a_failure_counts_while_the_failing_law_has_more_say() -> None:
    controller = guarded(law=Fixed(100.0, SolveStatus.FAILED))
    statuses = [controller.step(OUTSIDE, 200.0).status for _ in range(30)]
    assert statuses[0] is SolveStatus.FAILED
    assert statuses[-1] is SolveStatus.OK


def test_a_reset_reaches_both_and_trusts_the_law_again() -> None:
    law, fallback = Fixed(100.0), Fixed(60.0)
    controller = guarded(law, fallback)
    torques(controller, OUTSIDE, 40)
    controller.reset()
    assert (law.resets, fallback.resets) == (1, 1)
    assert torques(controller, INSIDE, 1) == [100.0]
