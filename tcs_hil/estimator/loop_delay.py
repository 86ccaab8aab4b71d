"""How long a command takes to come back: limits sent against the motors' torque on the bus."""

from __future__ import annotations

import math

from tcs_hil.control.sent import MAX_DELAY_PERIODS
from tcs_hil.control.settings import DelaySettings
from tcs_hil.signals import Pair

CANDIDATES = int(MAX_DELAY_PERIODS) + 1
WINDOW_TICKS = 60.0
TELLING_NM = 5.0
"""Travel of the torque, over the candidates' time, that outweighs the noise of its measurement."""
SLEW = 0.06
"""The estimate moves by at most so many seconds per second."""
SETTLED_TICKS = 25
"""A motor must have been held so long that what the driver asked before is forgotten."""


class LoopDelay:
    """From the instant of a measurement to the first effect of its command, in seconds.

    The torques sent, put through the motor's lag, are compared with the echoed
    torque once for every whole number of periods of delay; the parabola through
    the smallest mean square and its neighbours gives the fraction.  Only while a
    motor is held below the driver's request, and only as far as its torque
    moves, is anything learnt.  A motor slower than believed shows as a longer
    delay, which is the better error to make.
    """

    def __init__(self, settings: DelaySettings, motor_lag_s: float, period_s: float) -> None:
        self._settings = settings
        self._period_s = period_s
        self._lag_gain = 1.0 - math.exp(-period_s / motor_lag_s)
        self._lagged_nm = [[0.0] * CANDIDATES for _ in range(2)]  # newest first
        self._mean_square = [0.0] * CANDIDATES
        self._held_ticks = [0, 0]
        self.value_s = settings.delay_s

    def sent(self, torque_nm: Pair, request_nm: Pair) -> None:
        """Hear what each motor was allowed at the end of a tick."""
        for side, (torque, request) in enumerate(zip(torque_nm, request_nm, strict=True)):
            history = self._lagged_nm[side]
            history.insert(0, history[0] + self._lag_gain * (torque - history[0]))
            history.pop()
            self._held_ticks[side] = self._held_ticks[side] + 1 if torque < request else 0

    def heard(self, echoed_nm: Pair) -> float:
        """Learn from the torques on the bus at the beginning of a tick; the delay now, s."""
        if not self._settings.measured:
            return self.value_s
        learnt = [self._learn(side, echoed_nm[side]) for side in range(2)]
        if any(learnt):
            step_s = SLEW * self._period_s
            surplus_s = self._best_s() - self.value_s
            self.value_s += min(max(surplus_s, -step_s), step_s)
        return self.value_s

    def _learn(self, side: int, echoed_nm: float) -> bool:
        history = self._lagged_nm[side]
        if self._held_ticks[side] < SETTLED_TICKS or max(history) - min(history) < TELLING_NM:
            return False
        self._mean_square = [
            mean + ((torque - echoed_nm) ** 2 - mean) / WINDOW_TICKS
            for mean, torque in zip(self._mean_square, history, strict=True)
        ]
        return True

    def _best_s(self) -> float:
        """Vertex of the parabola around the best candidate; the candidate itself at an end."""
        best = self._mean_square.index(min(self._mean_square))
        if not 0 < best < CANDIDATES - 1:
            return best * self._period_s
        before, at, after = self._mean_square[best - 1 : best + 2]
        bend = before - 2.0 * at + after
        fraction = 0.5 * (before - after) / bend if bend > 0.0 else 0.0
        return (best + fraction) * self._period_s
