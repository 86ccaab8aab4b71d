"""A law whose solver fails for 0.3 s of a launch on snow: the loop hardly notices."""

from collections import Counter
from collections.abc import Callable

import numpy as np
import pytest

from plant_emulator.scenario import load_scenario
from tcs_hil.control.bank_kmpc import BankOptimiser
from tcs_hil.control.plan import Plan
from tcs_hil.control.protocol import SolveStatus
from tcs_hil.fault_codes import FaultCode
from tcs_hil.hil.simulation import simulate
from tcs_hil.safety_settings import GateSettings
from tcs_hil.service.settings import ServiceConfig
from tcs_hil.signals import TcsState

FIRST, LAST = 500, 649


def failing(plan: Callable[..., Plan]) -> Callable[..., Plan]:
    """The solver, but for some of each wheel's ticks."""
    asked: Counter[BankOptimiser] = Counter()

    def planned(optimiser: BankOptimiser, *arguments: float) -> Plan:
        asked[optimiser] += 1
        found = plan(optimiser, *arguments)
        failed = FIRST <= asked[optimiser] <= LAST
        return Plan(found.inputs, SolveStatus.FAILED, found.iterations) if failed else found

    return planned


def test_a_solver_that_fails_in_the_loop_costs_no_bump(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(BankOptimiser, "plan", failing(BankOptimiser.plan))
    simulation = simulate(load_scenario("launch-mu-030"), ServiceConfig())
    replaced = [
        tick
        for tick, command in enumerate(simulation.commands)
        if command.fault_code is FaultCode.CONTROLLER_REPLACED
    ]
    assert len(replaced) == LAST - FIRST + 10  # and the way back
    assert {simulation.commands[tick].state for tick in replaced} == {TcsState.DEGRADED}
    during = slice(replaced[0] - 1, replaced[-1] + 1)
    limits_nm = np.array([command.limits for command in simulation.commands[during]])
    steps_nm = np.diff(limits_nm, axis=0)
    assert np.isfinite(limits_nm).all()
    assert steps_nm.max() <= GateSettings().release_rate_nmps * 0.002 + 1e-9
    assert steps_nm.min() > -5.0
    assert simulation.truth["slip_ratio"][during, :2].max() < 0.2
