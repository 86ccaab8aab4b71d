"""Outside its validity a law hands over to the PI, and takes over again, without a bump."""

from __future__ import annotations

import math
from dataclasses import dataclass

import pytest
from msgspec.structs import replace

from tcs_hil.control.guarded import HAND_OVER_S, GuardedController
from tcs_hil.control.pi import PiController
from tcs_hil.control.protocol import Proposal, SolveStatus, WheelState
from tcs_hil.control.settings import ControlSettings
from tests.control.recorder import wheel_at

PERIOD_S = 0.002
VALID_MPS = (1.0, 10.0)
INSIDE, OUTSIDE = wheel_at(5.0, 0.12, 100.0), wheel_at(11.0, 0.12, 100.0)
BLIND = replace(INSIDE, motor_torque_nm=math.nan)


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


def guarded(law: Fixed | None = None) -> GuardedController:
    pi = PiController(ControlSettings())
    return GuardedController(law or Fixed(100.0), pi, VALID_MPS, PERIOD_S)


def torques(controller: GuardedController, wheel: WheelState, ticks: int) -> list[float]:
    return [controller.step(wheel, 200.0).torque_nm for _ in range(ticks)]


def test_inside_its_validity_the_law_decides() -> None:
    assert torques(guarded(), INSIDE, 3) == [100.0] * 3


@pytest.mark.parametrize("wheel", [OUTSIDE, BLIND], ids=["too fast", "no motor on the bus"])
def test_outside_the_pi_goes_on_from_the_laws_last_torque(wheel: WheelState) -> None:
    controller = guarded()
    torques(controller, INSIDE, 1)
    handed = torques(controller, wheel, 100)
    assert handed[0] == pytest.approx(100.0, abs=3.0)
    assert handed[-1] < 95.0  # slip is above its reference, and the law would stay at 100


def test_back_inside_the_law_takes_over_within_the_time_to_hand_over() -> None:
    controller, ticks = guarded(), round(HAND_OVER_S / PERIOD_S)
    torques(controller, INSIDE, 1)
    last_nm = torques(controller, OUTSIDE, 100)[-1]
    back = torques(controller, INSIDE, ticks + 1)
    steps = [after - before for before, after in zip([last_nm, *back], back, strict=False)]
    assert max(steps) < 3.0 * (100.0 - last_nm) / ticks
    assert back[-1] == 100.0


def test_straying_over_the_border_for_one_tick_hardly_matters() -> None:
    controller = guarded()
    torques(controller, INSIDE, 1)
    assert torques(controller, OUTSIDE, 1)[0] > 97.0
    assert torques(controller, INSIDE, 1)[0] > 97.0


def test_a_failure_counts_while_the_failing_law_has_more_say() -> None:
    controller = guarded(Fixed(100.0, SolveStatus.FAILED))
    torques(controller, OUTSIDE, 1)
    proposals = [controller.step(INSIDE, 200.0) for _ in range(20)]
    assert proposals[0].status is SolveStatus.OK
    assert proposals[-1].status is SolveStatus.FAILED
    assert max(proposal.torque_nm for proposal in proposals) < 201.0


def test_a_law_that_fails_on_the_way_back_does_not_pull_towards_the_request() -> None:
    law = Fixed(100.0)
    controller = guarded(law)
    torques(controller, INSIDE, 1)
    torques(controller, OUTSIDE, 20)
    law.torque_nm, law.status = 200.0, SolveStatus.FAILED
    assert max(torques(controller, INSIDE, 20)) < 100.0


def test_a_motor_that_is_lost_again_while_the_law_comes_back_makes_no_step() -> None:
    controller = guarded()
    torques(controller, INSIDE, 1)
    torques(controller, BLIND, 100)
    back_nm = torques(controller, INSIDE, 20)[-1]
    assert torques(controller, BLIND, 1)[0] == pytest.approx(back_nm, abs=2.0)


def test_the_pi_takes_on_nothing_from_a_law_that_has_not_decided() -> None:
    law = Fixed(100.0)
    controller = guarded(law)
    torques(controller, INSIDE, 1)
    law.torque_nm, law.status = 200.0, SolveStatus.FAILED
    torques(controller, INSIDE, 1)
    assert torques(controller, OUTSIDE, 1)[0] < 101.0


def test_a_reset_reaches_both_and_trusts_the_law_again() -> None:
    law = Fixed(100.0)
    controller = guarded(law)
    torques(controller, OUTSIDE, 40)
    controller.reset()
    assert law.resets == 1
    assert torques(controller, wheel_at(11.0, 0.01, 100.0), 1) == [200.0]  # the PI sleeps
    controller.reset()
    assert torques(controller, INSIDE, 1) == [100.0]
