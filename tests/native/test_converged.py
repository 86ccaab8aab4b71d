"""The native nonlinear MPC hands out what IPOPT converges to."""

from __future__ import annotations

from tcs_hil.control.factory import make_controller
from tcs_hil.control.integrator import SlipErrorIntegral
from tcs_hil.control.protocol import Proposal, WheelState
from tcs_hil.control.settings import ControlSettings
from tcs_hil.model.vehicle import Vehicle
from tcs_hil.signals import ControllerKind
from tests.control.quarter_car import PERIOD_S, manoeuvre_2
from tests.control.test_nmpc import REFERENCE, ipopt_reference

AGREEMENT_NM = 1e-5
EVERY = 40  # IPOPT takes its time


class Witness:
    """Remembers what the law was asked, e_int included, and what it answered."""

    def __init__(self) -> None:
        settings = ControlSettings(preset="paper", backend="native")
        self._law = make_controller(ControllerKind.NMPC, settings, Vehicle())
        self._integral = SlipErrorIntegral(REFERENCE, PERIOD_S)
        self.seen: list[tuple[WheelState, float, float, Proposal]] = []

    def step(self, wheel: WheelState, torque_ref_nm: float) -> Proposal:
        proposal = self._law.step(wheel, torque_ref_nm)
        self.seen.append((wheel, self._integral.value_s, torque_ref_nm, proposal))
        self._integral.advance(wheel.slip_ratio, proposal.torque_nm, torque_ref_nm)
        return proposal

    def reset(self) -> None:
        raise NotImplementedError


def test_along_the_varying_road_it_is_converged() -> None:
    witness, solve = Witness(), ipopt_reference(1e-8)
    manoeuvre_2(witness)
    for wheel, integral_s, torque_ref_nm, proposal in witness.seen[60::EVERY]:
        x0 = (wheel.slip_speed_mps, wheel.wheel_speed_radps, integral_s)
        expected = solve(x0, torque_ref_nm)
        assert abs(proposal.torque_nm - expected[0]) < AGREEMENT_NM
        assert abs(proposal.next_nm - expected[1]) < AGREEMENT_NM
