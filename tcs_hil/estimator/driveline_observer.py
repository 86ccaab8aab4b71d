"""Wheel speed, shaft twist and tyre torque of one side, seen through its motor."""

from __future__ import annotations

import functools
from typing import Final

import numpy as np
from numpy.typing import NDArray
from scipy import linalg

from tcs_hil.control.driveline import Driveline

FloatArray = NDArray[np.float64]

PROCESS_STD = (0.1, 0.1, 2e-5, 20.0)
"""Per tick: wheel and motor speed rad/s, twist rad, tyre torque Nm (a random walk)."""
MOTOR_SPEED_STD_RADPS: Final = 0.05
"""On the wheel side of the gear: noise, resolution and what the shaft does besides the model."""


class DrivelineObserver:
    """Steady-state Kalman filter of x = [omega, omega_motor, twist, F_x R].

    The motor's speed is fine and fresh at any speed where a toothed wheel says
    something every 37 ms, and over the shaft it knows what the wheel does.  Its
    input is the motor's measured torque, its one measurement the motor's speed.
    """

    def __init__(self, driveline: Driveline, period_s: float) -> None:
        self._rows = _rows_of(driveline, period_s)
        self._stiffness_nmprad = driveline.shaft_stiffness_nmprad
        self._x = [0.0, 0.0, 0.0, 0.0]
        self._input_nm = 0.0
        self._known = False

    def update(self, shaft_input_nm: float, motor_radps: float) -> list[float]:
        """State [omega, omega_motor, twist, F_x R] from motor torque and speed at the wheel."""
        if not self._known:
            # From no twist on, the wheel would seem to slow down for 50 ms, and a law to be free.
            twist_rad = shaft_input_nm / self._stiffness_nmprad
            self._x = [motor_radps, motor_radps, twist_rad, shaft_input_nm]
            self._known, self._input_nm = True, shaft_input_nm
            return self._x
        # A torque under control moves by tens of Nm a period: its mean is what turned the motor.
        mean_nm = 0.5 * (self._input_nm + shaft_input_nm)
        self._input_nm = shaft_input_nm
        x0, x1, x2, x3 = self._x
        self._x = [
            a0 * x0 + a1 * x1 + a2 * x2 + a3 * x3 + b * mean_nm + k * motor_radps
            for a0, a1, a2, a3, b, k in self._rows
        ]
        return self._x

    def reset(self) -> None:
        """Nothing is known: the wheel turns like its motor, and the tyre takes all its torque."""
        self._known = False


@functools.cache
def _rows_of(driveline: Driveline, period_s: float) -> tuple[tuple[float, ...], ...]:
    """The filter of a driveline: one side's is the other's, and that of a campaign's next run."""
    return filter_rows(*discretised(driveline, period_s))


def discretised(line: Driveline, period_s: float) -> tuple[FloatArray, FloatArray]:
    """Transition matrix (4, 4) over one period and the held input's column (4,)."""
    wheel, motor = line.wheel_inertia_kgm2, line.motor_inertia_kgm2
    k, d = line.shaft_stiffness_nmprad, line.shaft_damping_nmsprad
    rates = np.zeros((5, 5))
    rates[0, :4] = -d / wheel, d / wheel, k / wheel, -1.0 / wheel
    rates[1, :3] = d / motor, -d / motor, -k / motor
    rates[1, 4] = 1.0 / motor
    rates[2, :2] = -1.0, 1.0
    transition = linalg.expm(rates * period_s)
    return transition[:4, :4], transition[:4, 4]


def filter_rows(transition: FloatArray, column: FloatArray) -> tuple[tuple[float, ...], ...]:
    """Prediction and correction in one step: x⁺ = [A - k a_1, b - k b_1, k] [x, input, speed].

    Plain floats: at this size a product by numpy costs more than the numbers.
    """
    gain = kalman_gain(transition)
    closed = transition - np.outer(gain, transition[1])
    rows = np.column_stack((closed, column - gain * column[1], gain))
    return tuple(tuple(row) for row in rows.tolist())


def kalman_gain(transition: FloatArray) -> FloatArray:
    """Steady-state gain (4,) on the motor speed's surprise."""
    output = np.array([[0.0, 1.0, 0.0, 0.0]])
    process = np.diag(np.square(PROCESS_STD))
    noise = np.array([[MOTOR_SPEED_STD_RADPS**2]])
    covariance = linalg.solve_discrete_are(transition.T, output.T, process, noise)
    return np.asarray(covariance @ output.T / (output @ covariance @ output.T + noise))[:, 0]
