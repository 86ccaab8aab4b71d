"""What both default laws do around their optimiser."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from msgspec.structs import replace

from tcs_hil.control.break_away import BreakAway
from tcs_hil.control.compensated import CompensatedController
from tcs_hil.control.entry import Entry
from tcs_hil.control.integrator import BoundedIntegral
from tcs_hil.control.plan import Plan
from tcs_hil.control.protocol import Proposal, SolveStatus, WheelState
from tcs_hil.control.swing_guard import SwingGuard
from tcs_hil.model.vehicle import Vehicle
from tests.control.recorder import wheel_at

SPINNING = wheel_at(5.0, 0.3)


class Scripted:
    """An optimiser whose state is what it was rolled forward through; it plans from a list."""

    def __init__(self, *torques_nm: float) -> None:
        self._torques_nm = list(torques_nm)
        self.state: tuple[list[float], float] = ([], 1.0)
        self.asked: list[tuple[tuple[list[float], float], float, float]] = []
        self.integrals: list[float] = []
        self.status = SolveStatus.OK
        self.resets = 0

    def observe(self, wheel: WheelState, integral_s: float) -> None:
        self.integrals.append(integral_s)

    def roll_forward(self, torques_nm: Sequence[float], first_periods: float) -> None:
        self.state = list(torques_nm), first_periods

    def plan(self, last_torque_nm: float, torque_ref_nm: float) -> Plan:
        self.asked.append((self.state, last_torque_nm, torque_ref_nm))
        return Plan(np.array([self._torques_nm.pop(0), 0.0]), self.status, 2)

    def reset(self) -> None:
        self.resets += 1


def control(optimiser: Scripted, entry: Entry | None = None) -> CompensatedController:
    integral = BoundedIntegral(0.1, 0.002, 0.02)
    guard = SwingGuard(0.1, Vehicle(), 0.002)
    return CompensatedController(optimiser, integral, guard, 0.002, entry=entry)


def test_it_plans_from_the_state_behind_the_torques_under_way() -> None:
    optimiser = Scripted(80.0, 70.0, 60.0)
    controller = control(optimiser)
    late = replace(SPINNING, loop_delay_s=0.003)
    for _ in range(3):
        controller.step(late, 200.0)
    assert optimiser.asked[2] == (([80.0, 70.0], 0.5), 70.0, 200.0)


def test_the_first_torque_of_the_plan_is_proposed_within_the_request() -> None:
    controller = control(Scripted(80.0, 200.0 + 1e-7))
    assert controller.step(SPINNING, 200.0) == Proposal(80.0, iterations=2, next_nm=0.0)
    assert controller.step(SPINNING, 200.0).torque_nm == 200.0


def test_a_failed_solve_leaves_the_request_and_is_remembered_as_sent() -> None:
    optimiser = Scripted(np.nan, 80.0)
    optimiser.status = SolveStatus.FAILED
    controller = control(optimiser)
    assert controller.step(SPINNING, 200.0) == Proposal(200.0, SolveStatus.FAILED, 2)
    assert optimiser.resets == 1
    controller.step(SPINNING, 200.0)
    assert optimiser.asked[1][1] == 200.0


def test_what_was_granted_is_carried_on_whoever_decided_it() -> None:
    optimiser = Scripted(80.0, 70.0)
    controller = control(optimiser)
    controller.step(SPINNING, 200.0)
    controller.step(replace(SPINNING, sent_nm=95.0), 200.0)
    assert optimiser.asked[1][1] == 95.0


def test_a_law_that_begins_does_so_from_no_torque() -> None:
    optimiser = Scripted(80.0)
    control(optimiser).step(replace(SPINNING, sent_nm=250.0), 250.0)
    assert optimiser.asked[0][1] == 0.0


def test_what_needs_no_solve_is_remembered_as_sent_too() -> None:
    optimiser = Scripted(80.0, 80.0)
    controller = control(optimiser)
    controller.step(SPINNING, 200.0)
    assert controller.step(SPINNING, 0.0) == Proposal(0.0)
    controller.step(SPINNING, 200.0)
    assert optimiser.asked[1][1] == 0.0


def test_the_integral_reaches_the_next_solve_and_reset_clears_everything() -> None:
    optimiser = Scripted(80.0, 80.0, 80.0)
    controller = control(optimiser)
    controller.step(SPINNING, 200.0)
    controller.step(SPINNING, 200.0)
    controller.reset()
    controller.step(SPINNING, 200.0)
    assert optimiser.integrals == [0.0, 0.002 * (0.1 - SPINNING.slip_ratio), 0.0]
    assert optimiser.asked[2][1] == 0.0


def test_before_the_entry_slip_the_driver_decides_and_after_it_the_law_until_all_is_back() -> None:
    controller = control(Scripted(80.0, 80.0, 80.0, 200.0, 80.0), Entry(0.03, 0.0))
    slips = [0.02, 0.04, 0.02, 0.02, 0.02]
    torques = [controller.step(wheel_at(5.0, slip), 200.0).torque_nm for slip in slips]
    assert torques == [200.0, 80.0, 80.0, 200.0, 200.0]


def test_a_long_delay_takes_weight_off_the_integral() -> None:
    optimiser = Scripted(80.0, 80.0, 80.0)
    controller = control(optimiser)
    for delay_s in (0.0, 0.007, 0.014):
        controller.step(replace(SPINNING, loop_delay_s=delay_s), 200.0)
    _, short, long = optimiser.integrals
    assert short == 0.002 * (0.1 - SPINNING.slip_ratio)
    assert long == 0.25 * 2.0 * short


def test_a_slip_ratio_made_of_a_slow_wheels_noise_is_no_entry() -> None:
    controller = control(Scripted(80.0, 80.0), Entry(0.03, 0.06))
    assert controller.step(wheel_at(0.3, 0.1), 200.0).torque_nm == 200.0
    assert controller.step(wheel_at(1.0, 0.1), 200.0).torque_nm == 80.0


def test_a_wheel_that_breaks_away_is_planned_for_under_its_ceiling() -> None:
    optimiser = Scripted(80.0, 200.0)
    integral, break_away = BoundedIntegral(0.1, 0.002, 0.02), BreakAway(0.1, Vehicle(), 0.002)
    guard = SwingGuard(0.1, Vehicle(), 0.002)
    controller = CompensatedController(optimiser, integral, guard, 0.002, break_away)
    controller.step(wheel_at(2.0, 0.05), 200.0)
    controller.step(wheel_at(2.0, 0.4), 200.0)
    assert optimiser.asked[1][2] == 0.7 * 80.0


def test_a_law_that_swings_is_taken_out_of_the_loop_for_a_while() -> None:
    torques_nm = [140.0 if tick // 25 % 2 else 60.0 for tick in range(300)]
    controller = control(Scripted(*torques_nm))
    blind = replace(wheel_at(5.0, 0.05), motor_torque_nm=np.nan)
    sent_nm = [controller.step(blind, 200.0).torque_nm for _ in torques_nm]
    assert max(abs(np.diff(sent_nm[:100]))) == 80.0
    assert min(np.ptp(sent_nm[start : start + 50]) for start in range(100, 250)) < 40.0
