"""A law whose solver fails for 0.3 s of a launch on snow: the loop hardly notices."""

import numpy as np
import pytest

from plant_emulator.scenario import load_scenario
from tcs_hil.control.protocol import Controller, Proposal, SolveStatus, WheelState
from tcs_hil.fault_codes import FaultCode
from tcs_hil.hil.simulation import simulate
from tcs_hil.safety_settings import GateSettings
from tcs_hil.service import wiring
from tcs_hil.service.settings import ServiceConfig
from tcs_hil.signals import TcsState

FIRST, LAST = 500, 649


class Failing:
    """The law, but for some ticks."""

    def __init__(self, law: Controller) -> None:
        self._law = law
        self._steps = 0

    def step(self, wheel: WheelState, torque_ref_nm: float) -> Proposal:
        self._steps += 1
        proposal = self._law.step(wheel, torque_ref_nm)
        failed = FIRST <= self._steps <= LAST
        return Proposal(torque_ref_nm, SolveStatus.FAILED) if failed else proposal

    def reset(self) -> None:
        self._law.reset()


def test_a_solver_that_fails_in_the_loop_costs_no_bump(monkeypatch: pytest.MonkeyPatch) -> None:
    make = wiring.make_controller
    monkeypatch.setattr(wiring, "make_controller", lambda *args: Failing(make(*args)))
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
