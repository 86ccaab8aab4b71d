"""What the newest tick thought, for the flight recorder."""

from __future__ import annotations

import msgspec

from tcs_hil.control.protocol import Proposal
from tcs_hil.estimator import Estimate
from tcs_hil.judgement import Verdict


class Trace(msgspec.Struct, frozen=True):
    """Belief, wishes and verdict of one tick."""

    estimate: Estimate
    proposals: tuple[Proposal, Proposal]
    verdict: Verdict
    suspects: int = 0  # bits of Suspect
