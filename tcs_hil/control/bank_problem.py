"""The quadratic program of one speed band: the bank's predictor condensed once."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from tcs_hil.control.condense import LinearSystem, condense
from tcs_hil.control.plan import Plan
from tcs_hil.control.qp import OsqpBox
from tcs_hil.control.settings import BankKmpcSettings, ControlSettings
from tcs_hil.model.bank import KoopmanBank
from tcs_hil.model.observables import NZ, Observable

FloatArray = NDArray[np.float64]

INTEGRAL, DISTURBANCE, NX = NZ, NZ + 1, NZ + 2
"""State x = [z, e_int, d]: e_int in seconds, d the wheel speed per period no model explains."""

UNIT_NM = 100.0
"""The solver's unit of torque: its tolerances are absolute and meant for numbers near 1."""


def extend_band(bank: KoopmanBank, band: int, slip_reference: float) -> LinearSystem:
    """One predictor over x, with outputs y = [kappa - kappa_ref, e_int] and the torque in Nm.

    e_int⁺ = e_int + T_s (kappa_ref - kappa).  d is constant and adds to omega,
    to s = omega R - v, and to kappa by its slope over omega at the band's centre
    and the slip reference.
    """
    vehicle = bank.provenance.settings.vehicle
    a, b = np.eye(NX), np.zeros((NX, 1))
    a[:NZ, :NZ], b[:NZ, 0] = bank.a[band], bank.b[band]
    a[INTEGRAL, [Observable.SLIP_RATIO, Observable.ONE]] = (
        -bank.period_s,
        bank.period_s * slip_reference,
    )
    radius_m = vehicle.wheel_radius_m
    slope = (1.0 - slip_reference) ** 2 * radius_m / bank.centre_mps[band]
    a[[Observable.WHEEL_SPEED, Observable.SLIP_SPEED, Observable.SLIP_RATIO], DISTURBANCE] = (
        1.0,
        radius_m,
        slope,
    )
    c = np.zeros((2, NX))
    c[0, [Observable.SLIP_RATIO, Observable.ONE]] = 1.0, -slip_reference
    c[1, INTEGRAL] = 1.0
    return LinearSystem(a, b, c)


TOLERANCE = 5e-6
"""Of the solver, in its unit: plans are then exact to half a bit of the limit on the bus."""


class BandProblem:
    """Quadratic program over the torques U within [0, T_ref], in physical units.

    Minimised is the sum of w_p (kappa - kappa_ref)² + w_i e_int² + w_u (T_ref - u)²
    + w_du (u_k - u_{k-1})²; ``output_weights`` are those at the band's centre.
    """

    def __init__(self, system: LinearSystem, tuning: BankKmpcSettings, centre_mps: float) -> None:
        n = tuning.horizon
        dense = condense(system, n)
        weights = np.tile(output_weights(tuning, centre_mps), n)
        pull = 2.0 * dense.theta.T * weights  # (N, 2 N)
        change = np.eye(n) - np.eye(n, k=-1)
        on_torques = tuning.weight_reduction * np.eye(n) + tuning.weight_change * change.T @ change
        hessian = pull @ dense.theta + 2.0 * on_torques
        self._qp = OsqpBox(hessian * UNIT_NM**2, tolerance=TOLERANCE)
        self._gradient_map = pull @ dense.gamma * UNIT_NM  # (N, NX)
        self._reduction_pull = 2.0 * tuning.weight_reduction * UNIT_NM
        self._change_pull = 2.0 * tuning.weight_change * UNIT_NM

    def solve(
        self,
        state: FloatArray,
        last_torque_nm: float,
        torque_ref_nm: float,
    ) -> Plan:
        """Torques (N,) in Nm from x (NX,) on, warm from the last solution."""
        gradient = self._gradient_map @ state - self._reduction_pull * torque_ref_nm
        gradient[0] -= self._change_pull * last_torque_nm
        plan = self._qp.solve(gradient, 0.0, torque_ref_nm / UNIT_NM)
        return plan._replace(inputs=plan.inputs * UNIT_NM)

    def reset(self) -> None:
        """Forget the last solution."""
        self._qp.reset()


def band_problems(
    bank: KoopmanBank, settings: ControlSettings
) -> tuple[list[LinearSystem], list[BandProblem]]:
    """Extended system and problem of every band; two milliseconds each."""
    tuning = settings.default.kmpc
    systems = [
        extend_band(bank, band, settings.slip_reference) for band in range(len(bank.centre_mps))
    ]
    return systems, [
        BandProblem(system, tuning, centre)
        for system, centre in zip(systems, bank.centre_mps, strict=True)
    ]


def output_weights(tuning: BankKmpcSettings, speed_mps: float) -> tuple[float, float]:
    """Weights (w_p, w_i) on the slip error and its integral at a vehicle speed.

    Both fall with the square of the speed below ``soft_speed_mps``, where slip
    answers torque so fast.  Above ``integral_speed_mps`` slip answers slowly, and
    an integral as quick as at low speed would swing with it: w_i falls again.
    """
    soft = min(1.0, speed_mps / tuning.soft_speed_mps) ** 2
    slow = min(1.0, tuning.integral_speed_mps / speed_mps) ** 2
    return soft * tuning.weight_slip, soft * slow * tuning.weight_integral
