"""The dense form of the extended Koopman system, Eq. (dense): Y = Gamma xi_0 + Theta U."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from tcs_hil.model.predictor import KoopmanPredictor

FloatArray = NDArray[np.float64]


class LinearSystem(NamedTuple):
    """x⁺ = A x + B u, y = C x with one input."""

    a: FloatArray  # (nx, nx)
    b: FloatArray  # (nx, 1)
    c: FloatArray  # (ny, nx)


class DenseForm(NamedTuple):
    """Outputs y_1..y_N, stacked, from the first state and the inputs u_0..u_{N-1}."""

    gamma: FloatArray  # (N * ny, nx)
    theta: FloatArray  # (N * ny, N)


def extend(predictor: KoopmanPredictor) -> LinearSystem:
    """The predictor with xi = [z, e_int, kappa_ref] and y = [kappa, e_int, kappa_ref].

    e_int⁺ = e_int + T_s (kappa_ref - kappa), in seconds; kappa_ref⁺ = kappa_ref
    keeps the system free of an affine term.
    """
    nz, slip = predictor.nz, predictor.slip_index
    e_int, reference = nz, nz + 1
    a = np.eye(nz + 2)
    a[:nz, :nz] = predictor.a
    a[e_int, slip] = -predictor.period_s
    a[e_int, reference] = predictor.period_s
    b = np.vstack((predictor.b, np.zeros((2, 1))))
    return LinearSystem(a, b, np.eye(nz + 2)[[slip, e_int, reference]])


def condense(system: LinearSystem, horizon: int) -> DenseForm:
    """Eliminate the states: block row k of Gamma is C A^(k+1), Theta holds C A^(k-j) B."""
    ny, nx = system.c.shape
    gamma = np.empty((horizon, ny, nx))
    theta = np.zeros((horizon, ny, horizon))
    response = system.c  # C A^k
    for k in range(horizon):
        pulse = (response @ system.b)[:, 0]
        for row in range(k, horizon):
            theta[row, :, row - k] = pulse
        response = response @ system.a
        gamma[k] = response
    return DenseForm(gamma.reshape(-1, nx), theta.reshape(-1, horizon))
