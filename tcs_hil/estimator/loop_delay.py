"""How long a command takes to come back: limits sent against the motors' torque on the bus."""

from __future__ import annotations

import math
from typing import Final

from tcs_hil.control.sent import MAX_DELAY_PERIODS
from tcs_hil.control.settings import DelaySettings
from tcs_hil.signals import Pair

CANDIDATES: Final = int(MAX_DELAY_PERIODS) + 1
WINDOW_TICKS: Final = 60.0
TELLING_NM: Final = 5.0
"""Travel of the torque, over the candidates' time, that outweighs the noise of its measurement."""
SLEW: Final = 0.06
"""The estimate moves by at most so many seconds per second."""
SETTLED_TICKS: Final = 25
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
        for side in (0, 1):
            history = self._lagged_nm[side]
            history.insert(0, history[0] + self._lag_gain * (torque_nm[side] - history[0]))
            history.pop()
            held = torque_nm[side] < request_nm[side]
            self._held_ticks[side] = self._held_ticks[side] + 1 if held else 0

    def heard(self, echoed_nm: Pair) -> float:
        """Learn from the torques on the bus at the beginning of a tick; the delay now, s."""
        if not self._settings.measured:
            return self.value_s
        # Both learn, whether or not the first of them does.
        if self._learn(0, echoed_nm[0]) | self._learn(1, echoed_nm[1]):
            step_s = SLEW * self._period_s
            surplus_s = self._best_s() - self.value_s
            self.value_s += min(max(surplus_s, -step_s), step_s)
        return self.value_s

    def _learn(self, side: int, echoed_nm: float) -> bool:
        history = self._lagged_nm[side]
        if self._held_ticks[side] < SETTLED_TICKS or _travel_nm(history) < TELLING_NM:
            return False
        mean_square = self._mean_square
        for delay in range(CANDIDATES):
            miss_nm, mean = history[delay] - echoed_nm, mean_square[delay]
            mean_square[delay] = mean + (miss_nm * miss_nm - mean) / WINDOW_TICKS
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


def _travel_nm(history_nm: list[float]) -> float:
    """From its lowest to its highest, in one pass."""
    lowest_nm = highest_nm = history_nm[0]
    for torque_nm in history_nm:
        lowest_nm, highest_nm = min(lowest_nm, torque_nm), max(highest_nm, torque_nm)
    return highest_nm - lowest_nm
