"""Figures of merit of one run, from the plant's truth."""

from tcs_hil.hil.metrics.ideal import ideal_speed_gained_mps
from tcs_hil.hil.metrics.limit_cycle import LimitCycle, find_limit_cycle
from tcs_hil.hil.metrics.score import Score, score
from tcs_hil.hil.metrics.slip import SlipMetrics, longest_spin_s, reachable, slip_metrics
from tcs_hil.hil.metrics.truth import Truth

__all__ = [
    "LimitCycle",
    "Score",
    "SlipMetrics",
    "Truth",
    "find_limit_cycle",
    "ideal_speed_gained_mps",
    "longest_spin_s",
    "reachable",
    "score",
    "slip_metrics",
]
