"""Random quadratic programs over boxes, and the native solver on a whole batch of them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tcs_hil.native import core, doubles


@dataclass(frozen=True)
class Batch:
    """Problems that share a Hessian of unit norm, a row each."""

    hessian: np.ndarray  # (n, n)
    gradient: np.ndarray  # (m, n)
    lower: np.ndarray  # (m, n)
    upper: np.ndarray  # (m, n)


def random_batch(rng: np.random.Generator, n: int, condition: float, count: int) -> Batch:
    """Boxes of every kind: wide, narrow, in part or wholly of one point, beside the minimum.

    The gradients are those of unconstrained minima around the box: some inside,
    some far away, some exactly on a corner, where multipliers are zero.
    """
    basis, _ = np.linalg.qr(rng.normal(size=(n, n)))
    hessian = (basis * np.geomspace(1.0 / condition, 1.0, n)) @ basis.T
    hessian = (hessian + hessian.T) / 2.0
    lower = rng.normal(size=(count, n)) * rng.choice((0.0, 1.0), (count, 1))
    width = rng.uniform(0.0, 3.0, (count, n)) * rng.choice((0.0, 1e-9, 0.1, 1.0), (count, 1))
    width *= rng.uniform(size=(count, n)) > rng.choice((0.0, 0.3), (count, 1))
    upper = lower + width
    minimum = lower + width * rng.choice((0.0, 0.5, 1.0), (count, n))
    minimum += rng.normal(size=(count, n)) * rng.choice((0.0, 0.1, 1.0, 30.0), (count, 1))
    return Batch(hessian, -minimum @ hessian, lower, upper)


class NativeBox:
    """The native solver, set up for one Hessian."""

    def __init__(self, hessian: np.ndarray) -> None:
        self._ffi, self._lib = core().ffi, core().lib
        self._n = len(hessian)
        self.struct = self._ffi.new("box_qp *")
        self.set_up_status = self._lib.box_qp_setup(self.struct, self._n, doubles(hessian))

    def solve(self, gradient: np.ndarray, lower: np.ndarray, upper: np.ndarray) -> np.ndarray:
        """Solution (n,)."""
        status = self._lib.box_qp_solve(self.struct, *map(doubles, (gradient, lower, upper)))
        assert status == self._lib.SOLVE_OK
        return np.array(self._ffi.unpack(self.struct.x, self._n))

    def solve_all(self, batch: Batch) -> np.ndarray:
        """Solutions (m, n), each warm from the one before."""
        x, n, struct, solve = np.empty_like(batch.gradient), self._n, self.struct, self._lib
        pointers = [doubles(array) for array in (batch.gradient, batch.lower, batch.upper)]
        for row in range(len(x)):
            offset = row * n
            status = solve.box_qp_solve(struct, *(pointer + offset for pointer in pointers))
            assert status == solve.SOLVE_OK
            x[row] = self._ffi.unpack(struct.x, n)
        return x

    def reset(self) -> None:
        """Forget the last solution."""
        self._lib.box_qp_reset(self.struct)
