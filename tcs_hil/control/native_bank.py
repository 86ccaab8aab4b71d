"""The core of the default Koopman MPC in C: the bank's matrices are copied into its structs."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tcs_hil.control.bank_problem import NX, UNIT_NM, Band, bands_of
from tcs_hil.control.native_law import unpack_outcome
from tcs_hil.control.plan import Plan
from tcs_hil.control.settings import ControlSettings
from tcs_hil.errors import ConfigError
from tcs_hil.model.bank import KoopmanBank, Share
from tcs_hil.model.observables import NZ, Observable
from tcs_hil.native import array_of, core, doubles

FloatArray = NDArray[np.float64]


class NativeBank:
    """State and plan live in the memory of the C struct."""

    def __init__(self, settings: ControlSettings, bank: KoopmanBank) -> None:
        self._lib, self._struct = core().lib, core().ffi.new("bank *")
        bands = bands_of(bank, settings)
        self._bands = [_struct_of(band) for band in bands]
        self._struct.nx, self._struct.unit_nm = NX, UNIT_NM
        self._struct.reduction_pull = bands[0].cost.reduction_pull
        self._struct.change_pull = bands[0].cost.change_pull
        self._x = array_of(self._struct.x)[:NX]
        self._plan = array_of(self._struct.plan)[: settings.default.kmpc.horizon]  # (N,), Nm
        a = array_of(self._struct.a)[: NX * NX].reshape(NX, NX)
        self._wheel_speed_row = a[Observable.WHEEL_SPEED, :NZ]

    def settle(self, shares: Sequence[Share]) -> None:
        """From now on these one or two bands predict and plan, mixed by weight."""
        first, weight = shares[0]
        second, rest = shares[1] if len(shares) == 2 else (first, 0.0)
        self._lib.bank_settle(self._struct, self._bands[first], weight, self._bands[second], rest)

    def wheel_speed_after(self, state: FloatArray) -> float:
        """Wheel speed in rad/s one period after a state (NX,), without torque or disturbance."""
        return float(self._wheel_speed_row.dot(state[:NZ]))

    def after(self, state: FloatArray, torque_nm: float, periods: float) -> FloatArray:
        """State (NX,) after ``periods`` in (0, 1] periods; valid until the next call."""
        self._x[:] = state
        self._lib.bank_advance(self._struct, torque_nm, periods)
        return self._x

    def plan(self, state: FloatArray, last_torque_nm: float, torque_ref_nm: float) -> Plan:
        """Best torques (N,) in Nm within [0, torque_ref_nm]; valid until the next call."""
        self._x[:] = state
        outcome = self._lib.bank_plan(self._struct, last_torque_nm, torque_ref_nm)
        return Plan(self._plan, *unpack_outcome(outcome))

    def reset(self) -> None:
        """Forget the last plans."""
        for band in self._bands:
            self._lib.box_qp_reset(core().ffi.addressof(band, "qp"))


def _struct_of(band: Band) -> Any:
    struct, cost = core().ffi.new("band *"), band.cost
    arrays = (band.system.a, band.system.b, cost.hessian, cost.gradient_map)
    if core().lib.band_setup(struct, NX, len(cost.hessian), *map(doubles, arrays)):
        raise ConfigError("the weights of kmpc make its problem singular: raise weight_reduction")
    return struct
