"""One tick of the service from measurement to command; no socket, clock, file or log."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final

from tcs_hil.control.protocol import Controller, Proposal
from tcs_hil.estimator import Estimate, Estimates
from tcs_hil.gate import RELEASE, Gate, Permission
from tcs_hil.judgement import Verdict
from tcs_hil.plausibility import Plausibility, screened
from tcs_hil.signals import (
    NO_LIMIT,
    Command,
    ControllerKind,
    Measurement,
    Pair,
    TorqueLimits,
)
from tcs_hil.supervisor import Supervisor
from tcs_hil.trace import Trace

NO_PROPOSAL: Final = Proposal(math.nan)


@dataclass(frozen=True, slots=True)
class Law:
    """The control law in charge: one controller per driven wheel, left and right."""

    kind: ControllerKind
    slip_reference: float
    controllers: tuple[Controller, Controller]


class Pipeline:
    """Screen, estimate, supervise, control, gate: the service between bytes and bytes."""

    def __init__(
        self,
        plausibility: Plausibility,
        estimator: Estimates,
        supervisor: Supervisor,
        law: Law,
        gates: tuple[Gate, Gate],
    ) -> None:
        self._plausibility = plausibility
        self._estimator = estimator
        self._supervisor = supervisor
        self._law = law
        self._gates = gates
        self._suspects = 0
        self.trace: Trace | None = None

    def step(self, measurement: Measurement) -> Command:
        """Turn the newest measurement into the command for the coming period."""
        self._suspects = self._plausibility.suspects(measurement)
        # The supervisor hears of what is not believed; the estimator does not hear it at all.
        believed = screened(measurement, self._suspects) if self._suspects else measurement
        estimate = self._estimator.update(believed)
        verdict = self._supervisor.judge(measurement, self._suspects)
        proposals = self._propose(estimate, measurement.driver_torque_nm, verdict.permission)
        if verdict.permission is not RELEASE:
            verdict = self._supervisor.heard(proposals)
        limits = self._gate(proposals, measurement.driver_torque_nm, verdict.permission)
        return self._command(limits, verdict, estimate, proposals)

    def sent(self, overran: bool) -> None:
        """Hear, after the tick, whether its limits went out after the deadline."""
        self._supervisor.sent(overran)

    def abandon(self, measurement: Measurement) -> Command:
        """Command after ``step`` raised: FAULT, and the torque goes back to the driver."""
        verdict = self._supervisor.internal_error()
        nothing = (NO_PROPOSAL, NO_PROPOSAL)
        limits = self._gate(nothing, measurement.driver_torque_nm, verdict.permission)
        return self._command(limits, verdict, self._estimator.newest, nothing)

    def _propose(
        self, estimate: Estimate, request_nm: Pair, permission: Permission
    ) -> tuple[Proposal, Proposal]:
        left, right = self._law.controllers
        if permission is RELEASE:
            # Inputs that are not trusted must not wind up an integrator.
            left.reset()
            right.reset()
            return NO_PROPOSAL, NO_PROPOSAL
        # A motor that is asked to brake has no torque to be limited.
        return (
            left.step(estimate.wheels[0], max(request_nm[0], 0.0)),
            right.step(estimate.wheels[1], max(request_nm[1], 0.0)),
        )

    def _gate(
        self, proposals: tuple[Proposal, Proposal], request_nm: Pair, permission: Permission
    ) -> TorqueLimits:
        left_gate, right_gate = self._gates
        left = left_gate.limit(proposals[0].torque_nm, request_nm[0], permission)
        right = right_gate.limit(proposals[1].torque_nm, request_nm[1], permission)
        allowed_nm = (min(left, request_nm[0]), min(right, request_nm[1]))
        self._estimator.sent(allowed_nm, request_nm)
        self._plausibility.sent(allowed_nm)
        return TorqueLimits(left, right)

    def _command(
        self,
        limits: TorqueLimits,
        verdict: Verdict,
        estimate: Estimate,
        proposals: tuple[Proposal, Proposal],
    ) -> Command:
        left, right = limits.left_nm < NO_LIMIT, limits.right_nm < NO_LIMIT
        if left or right:
            verdict = self._supervisor.limiting()
        self.trace = Trace(estimate, proposals, verdict, self._suspects)
        return Command(
            limits=limits,
            active=(left, right),
            state=verdict.state,
            fault_code=verdict.fault_code,
            controller=self._law.kind,
            slip_ratio=(estimate.wheels[0].slip_ratio, estimate.wheels[1].slip_ratio),
            slip_reference=self._law.slip_reference,
            road=estimate.road,
        )
