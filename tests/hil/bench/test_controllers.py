"""Every law and peer along the same questions: no times asserted, but answers."""

from __future__ import annotations

import signal
from contextlib import suppress

import pytest
from msgspec.structs import replace

from tcs_hil.control.protocol import Proposal, SolveStatus, WheelState
from tcs_hil.hil.bench import controllers
from tcs_hil.hil.bench.candidates import Candidate, candidates
from tcs_hil.hil.bench.controllers import ControllerRow, measure_controllers, replay
from tcs_hil.hil.bench.effort import QUICK
from tcs_hil.hil.bench.recorded import Question
from tcs_hil.hil.bench.statistics import Stopwatch
from tcs_hil.signals import ControllerKind

FEW = QUICK._replace(questions=80)
PEERS = {"IPOPT", "do-mpc", "OSQP", "daqp"}


@pytest.fixture(scope="module")
def rows() -> list[ControllerRow]:
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(controllers, "MANOEUVRES", ("manoeuvre-1",))
        return measure_controllers(FEW, lambda _share, _what: None)


def test_everybody_is_there_beside_the_paper(rows: list[ControllerRow]) -> None:
    published = [row for row in rows if row.preset == "paper"]
    assert {row.code for row in published} >= PEERS | {"python"}
    assert all(row.paper is not None for row in published)
    assert {row.law for row in rows if row.preset == "default"} == {"KMPC", "NMPC"}


def test_on_the_published_problems_all_agree(rows: list[ControllerRow]) -> None:
    deviations = {(r.law, r.code): r.deviation_nm for r in rows if r.preset == "paper" and r.cost}
    # OSQP stops at a tolerance; what is not installed says nothing.
    assert all(nm < (1e-2 if code == "OSQP" else 1e-5) for (_, code), nm in deviations.items())


def test_who_is_not_installed_is_named() -> None:
    absent = Candidate(ControllerKind.NMPC, "paper", "do-mpc", None, ours=False)
    cost, answers = controllers._asked(absent, [], 1)
    row = controllers._row(absent, "manoeuvre-1", cost, controllers._deviation_nm(answers, None))
    assert (row.code, row.cost, row.deviation_nm) == ("do-mpc", None, None)


def test_the_exact_solver_comes_before_those_it_judges() -> None:
    published = [c for c in candidates() if c.preset == "paper"]
    for kind in (ControllerKind.KMPC, ControllerKind.NMPC):
        assert next(c for c in published if c.kind is kind).is_exact


class Echo:
    """Answers with the request."""

    def step(self, wheel: WheelState, torque_ref_nm: float) -> Proposal:
        return Proposal(torque_ref_nm, SolveStatus.OK)

    def reset(self) -> None:
        raise NotImplementedError


class Deaf(Echo):
    """Takes an interrupt for a failed step, as CasADi's solvers do, and goes on."""

    def step(self, wheel: WheelState, torque_ref_nm: float) -> Proposal:
        with suppress(KeyboardInterrupt):
            signal.raise_signal(signal.SIGINT)
        return super().step(wheel, torque_ref_nm)


def test_ctrl_c_reaches_the_bench_through_a_solver_that_swallows_it() -> None:
    peer = Candidate(ControllerKind.NMPC, "paper", "IPOPT", Deaf, ours=False)
    with pytest.raises(KeyboardInterrupt):
        controllers._asked(peer, [Question(WheelState.at_rest(), 5.0)], 1)


def test_steps_without_a_request_are_answered_but_not_timed() -> None:
    wheel = replace(WheelState.at_rest(), wheel_speed_radps=3.0)
    watch = Stopwatch()
    answers = replay(Echo(), [Question(wheel, nm) for nm in (0.0, 5.0, 7.0)], watch)
    assert answers.tolist() == [0.0, 5.0, 7.0]
    assert watch.cost.wall.samples == 2
