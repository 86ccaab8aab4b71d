"""One tick of the service from measurement to command; no socket, clock, file or log."""

from __future__ import annotations

import math
from dataclasses import dataclass

from tcs_hil.control.protocol import Controller, Proposal, SolveStatus
from tcs_hil.estimator import Estimate, Estimates
from tcs_hil.gate import Gate, Permission
from tcs_hil.signals import (
    NO_LIMIT,
    Command,
    ControllerKind,
    Measurement,
    Pair,
    TorqueLimits,
)
from tcs_hil.supervisor import Supervisor, Verdict

UNSOLVED = (SolveStatus.FAILED, SolveStatus.BAD_INPUT)
NO_PROPOSAL = Proposal(math.nan)


@dataclass(frozen=True, slots=True)
class Law:
    """The control law in charge: one controller per driven wheel, left and right."""

    kind: ControllerKind
    slip_reference: float
    controllers: tuple[Controller, Controller]


@dataclass(frozen=True, slots=True)
class Trace:
    """What the newest tick thought, for the flight recorder."""

    estimate: Estimate
    proposals: tuple[Proposal, Proposal]
    verdict: Verdict


class Pipeline:
    """Estimate, supervise, control, gate: the service between bytes and bytes."""

    def __init__(
        self, estimator: Estimates, supervisor: Supervisor, law: Law, gates: tuple[Gate, Gate]
    ) -> None:
        self._estimator = estimator
        self._supervisor = supervisor
        self._law = law
        self._gates = gates
        self.trace: Trace | None = None

    def step(self, measurement: Measurement) -> Command:
        """Turn the newest measurement into the command for the coming period."""
        estimate = self._estimator.update(measurement)
        verdict = self._supervisor.judge(measurement)
        proposals = self._propose(estimate, measurement.driver_torque_nm, verdict.permission)
        unsolved = any(proposal.status in UNSOLVED for proposal in proposals)
        # Where inputs are late already, that is the reason, and a law without them no news.
        if unsolved and verdict.permission is Permission.FOLLOW:
            verdict = self._supervisor.controller_failed()
        limits = self._gate(proposals, measurement.driver_torque_nm, verdict.permission)
        return self._command(limits, verdict, estimate, proposals)

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
        if permission is Permission.RELEASE:
            # Inputs that are not trusted must not wind up an integrator.
            left.reset()
            right.reset()
            return NO_PROPOSAL, NO_PROPOSAL
        return (
            left.step(estimate.wheels[0], request_nm[0]),
            right.step(estimate.wheels[1], request_nm[1]),
        )

    def _gate(
        self, proposals: tuple[Proposal, Proposal], request_nm: Pair, permission: Permission
    ) -> TorqueLimits:
        left, right = (
            gate.limit(proposal.torque_nm, request, permission)
            for gate, proposal, request in zip(self._gates, proposals, request_nm, strict=True)
        )
        allowed_nm = (min(left, request_nm[0]), min(right, request_nm[1]))
        self._estimator.sent(allowed_nm, request_nm)
        return TorqueLimits(left, right)

    def _command(
        self,
        limits: TorqueLimits,
        verdict: Verdict,
        estimate: Estimate,
        proposals: tuple[Proposal, Proposal],
    ) -> Command:
        active = (limits.left_nm < NO_LIMIT, limits.right_nm < NO_LIMIT)
        if any(active):
            verdict = self._supervisor.limiting()
        self.trace = Trace(estimate, proposals, verdict)
        return Command(
            limits=limits,
            active=active,
            state=verdict.state,
            fault_code=verdict.fault_code,
            controller=self._law.kind,
            slip_ratio=(estimate.wheels[0].slip_ratio, estimate.wheels[1].slip_ratio),
            slip_reference=self._law.slip_reference,
            road=estimate.road,
        )
