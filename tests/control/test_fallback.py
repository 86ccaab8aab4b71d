import math

import pytest

from tcs_hil.control.fallback import FallbackController
from tcs_hil.control.pi import PiController
from tcs_hil.control.protocol import Proposal, SolveStatus, Source, WheelState
from tcs_hil.control.screening import decided
from tcs_hil.control.settings import ControlSettings

FAILED, BAD_INPUT = SolveStatus.FAILED, SolveStatus.BAD_INPUT
REQUEST_NM = 200.0
AT_REFERENCE = WheelState(0.5, 17.0, 0.1, 5.0, 51.0, 40.0)
BEYOND_IT = WheelState(1.0, 18.0, 0.2, 5.0, 54.0, 40.0)


class Scripted:
    """A law that gives its answers one by one, the last again and again."""

    def __init__(self, *answers: Proposal) -> None:
        self.answers = list(answers)
        self.resets = 0

    def step(self, wheel: WheelState, torque_ref_nm: float) -> Proposal:
        return self.answers.pop(0) if len(self.answers) > 1 else self.answers[0]

    def reset(self) -> None:
        self.resets += 1


def backed(*answers: Proposal) -> FallbackController:
    return FallbackController(Scripted(*answers), PiController(ControlSettings()))


def steps(controller: FallbackController, n: int, wheel: WheelState = AT_REFERENCE) -> list[float]:
    return [controller.step(wheel, REQUEST_NM).torque_nm for _ in range(n)]


def test_a_law_that_decides_is_passed_on() -> None:
    answer = Proposal(80.0, SolveStatus.MAX_ITERATIONS, 7, 81.0)
    assert backed(answer).step(AT_REFERENCE, REQUEST_NM) is answer


@pytest.mark.parametrize(
    "failure", [Proposal(REQUEST_NM, FAILED, 9), Proposal(math.nan, iterations=9)]
)
def test_a_failed_solve_is_bridged_by_the_last_plan_once_and_then_by_the_pi(
    failure: Proposal,
) -> None:
    controller = backed(Proposal(80.0, next_nm=82.0), failure)
    controller.step(AT_REFERENCE, REQUEST_NM)
    answers = [controller.step(AT_REFERENCE, REQUEST_NM) for _ in range(3)]
    assert [a.source for a in answers] == [Source.LAST_PLAN, Source.FALLBACK, Source.FALLBACK]
    assert {(a.status, a.iterations) for a in answers} == {(FAILED, 9)}
    assert not any(decided(answer) for answer in answers)


def test_the_pi_goes_on_from_the_last_torque_without_a_bump() -> None:
    controller = backed(Proposal(80.0, next_nm=82.0), Proposal(REQUEST_NM, FAILED))
    assert steps(controller, 4) == [80.0, 82.0, 82.0, 82.0]


def test_the_pi_does_control() -> None:
    controller = backed(Proposal(80.0), Proposal(REQUEST_NM, FAILED))
    controller.step(BEYOND_IT, REQUEST_NM)
    torques = steps(controller, 5, BEYOND_IT)
    assert torques == sorted(torques, reverse=True)
    assert torques[0] < 80.0


def test_a_plan_serves_once_per_solve() -> None:
    controller = backed(
        Proposal(80.0, next_nm=82.0),
        Proposal(REQUEST_NM, FAILED),
        Proposal(70.0, next_nm=71.0),
        Proposal(REQUEST_NM, FAILED),
        Proposal(REQUEST_NM, FAILED),
    )
    assert steps(controller, 5) == [80.0, 82.0, 70.0, 71.0, 71.0]


def test_a_law_without_a_plan_is_followed_by_the_pi_at_once() -> None:
    controller = backed(Proposal(80.0), Proposal(REQUEST_NM, FAILED))
    assert controller.step(AT_REFERENCE, REQUEST_NM).torque_nm == 80.0
    stand_in = controller.step(AT_REFERENCE, REQUEST_NM)
    assert (stand_in.torque_nm, stand_in.source) == (80.0, Source.FALLBACK)


def test_a_failed_solve_announces_no_plan() -> None:
    failed = Proposal(REQUEST_NM, FAILED, next_nm=5.0)
    controller = backed(Proposal(80.0, next_nm=82.0), failed)
    assert steps(controller, 3) == [80.0, 82.0, 82.0]


def test_the_last_plan_stays_within_what_the_driver_asks_now() -> None:
    controller = backed(Proposal(80.0, next_nm=82.0), Proposal(30.0, FAILED))
    controller.step(AT_REFERENCE, REQUEST_NM)
    assert controller.step(AT_REFERENCE, 30.0).torque_nm == 30.0


def test_against_bad_input_nothing_stands_in() -> None:
    bad = Proposal(REQUEST_NM, BAD_INPUT)
    controller = backed(Proposal(80.0, next_nm=82.0), bad)
    controller.step(AT_REFERENCE, REQUEST_NM)
    assert controller.step(AT_REFERENCE, REQUEST_NM) is bad


def test_a_law_that_did_not_reduce_leaves_the_pi_asleep() -> None:
    controller = backed(Proposal(REQUEST_NM), Proposal(REQUEST_NM, FAILED))
    rolling = WheelState(0.0, 16.0, 0.0, 5.0, 48.0, 40.0)
    assert steps(controller, 3, rolling) == [REQUEST_NM] * 3


def test_a_reset_forgets_law_plan_and_pi() -> None:
    law = Scripted(Proposal(80.0, next_nm=82.0), Proposal(REQUEST_NM, FAILED))
    controller = FallbackController(law, PiController(ControlSettings()))
    controller.step(AT_REFERENCE, REQUEST_NM)
    controller.reset()
    assert law.resets == 1
    rolling = WheelState(0.0, 16.0, 0.0, 5.0, 48.0, 40.0)
    stand_in = controller.step(rolling, REQUEST_NM)
    assert (stand_in.torque_nm, stand_in.source) == (REQUEST_NM, Source.FALLBACK)
