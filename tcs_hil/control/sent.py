"""The torques on their way to the wheel."""

from __future__ import annotations

from typing import Final

MAX_DELAY_PERIODS: Final = 10.0
"""Beyond it (20 ms) prediction is no remedy any more."""

_REMEMBERED: Final = int(MAX_DELAY_PERIODS) + 1


class SentTorques:
    """What was sent to one wheel's motor lately, newest last.

    A state that is ``d`` periods older than the first effect of the next
    command will still see ``d`` periods of earlier ones.
    """

    def __init__(self) -> None:
        self.reset()

    @property
    def newest_nm(self) -> float:
        """The command before the one to be decided; 0 at the start."""
        return self._sent[-1]

    def push(self, torque_nm: float) -> None:
        """Remember what a tick has sent."""
        self._sent.append(torque_nm)
        del self._sent[0]

    def pending(self, delay_periods: float) -> tuple[list[float], float]:
        """Torques in Nm that act within the delay, oldest first, and the periods of the first.

        The others act for one period each; together that is the delay.  Of a
        fractional delay the fraction comes first: the oldest command has acted
        for the rest of its period already.
        """
        delay_periods = min(max(delay_periods, 0.0), MAX_DELAY_PERIODS)
        whole = int(delay_periods)
        if delay_periods > whole:
            return self._sent[_REMEMBERED - whole - 1 :], delay_periods - whole
        return self._sent[_REMEMBERED - whole :], 1.0

    def reset(self) -> None:
        """As at start-up: no torque was ever sent."""
        self._sent = [0.0] * _REMEMBERED
