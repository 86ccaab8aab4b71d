"""The core of the default Koopman MPC in C: the bank's matrices are copied into its structs."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from tcs_hil.control.bank_problem import UNIT_NM, Band, bands_of
from tcs_hil.control.native_law import plan_of
from tcs_hil.control.plan import Plan
from tcs_hil.control.protocol import WheelState
from tcs_hil.control.settings import ControlSettings
from tcs_hil.errors import ConfigError
from tcs_hil.model.bank import KoopmanBank
from tcs_hil.native import array_of, core, doubles


class NativeBank:
    """State and plan live in the memory of the C struct."""

    def __init__(self, settings: ControlSettings, bank: KoopmanBank) -> None:
        self._lib, self._struct = core().lib, core().ffi.new("bank *")
        bands = bands_of(bank, settings)
        self._bands = core().ffi.new("band[]", len(bands))
        for index, (centre_mps, band) in enumerate(zip(bank.centre_mps, bands, strict=True)):
            self._bands[index].centre_mps = centre_mps
            _set_up(self._bands + index, band)
        self._describe(bank, bands[0])
        self.x = array_of(self._struct.x)
        self._plan = array_of(self._struct.plan)[: settings.default.kmpc.horizon]  # (N,), Nm

    def observe(
        self, wheel: WheelState, torque_nm: float, integral_s: float, disturbance_radps: float
    ) -> float:
        """Set x to what is seen now; returns the wheel speed expected one period later."""
        expected_radps: float = self._lib.bank_observe(
            self._struct,
            wheel.vehicle_speed_mps,
            wheel.slip_speed_mps,
            wheel.wheel_speed_radps,
            wheel.motor_speed_radps / self._gear_ratio,
            torque_nm,
            integral_s,
            disturbance_radps,
        )
        return expected_radps

    def roll_forward(self, torques_nm: Sequence[float], first_periods: float) -> None:
        """Carry x through torques, the first for a part of a period; linear within a period."""
        self._lib.bank_roll_forward(self._struct, torques_nm, len(torques_nm), first_periods)

    def plan(self, last_torque_nm: float, torque_ref_nm: float) -> Plan:
        """Best torques (N,) in Nm within [0, torque_ref_nm] from x on; valid until the next."""
        outcome = self._lib.bank_plan(self._struct, last_torque_nm, torque_ref_nm)
        return plan_of(self._plan, outcome)

    def reset(self) -> None:
        """Forget the last sample and the last plans."""
        self._lib.bank_reset(self._struct)

    def _describe(self, bank: KoopmanBank, band: Band) -> None:
        struct, car = self._struct, bank.provenance.settings.vehicle
        self._gear_ratio = car.gear_ratio
        struct.bands, struct.band_count = self._bands, len(self._bands)
        struct.unit_nm = UNIT_NM
        struct.reduction_pull = band.cost.reduction_pull
        struct.change_pull = band.cost.change_pull
        struct.car = (car.wheel_radius_m, car.slip_epsilon_m2ps2, car.tyre_b, car.tyre_c)


def _set_up(struct: Any, band: Band) -> None:
    cost = band.cost
    arrays = (band.system.a, band.system.b, cost.hessian, cost.gradient_map)
    if core().lib.band_setup(struct, len(cost.hessian), *map(doubles, arrays)):
        raise ConfigError("the weights of kmpc make its problem singular: raise weight_reduction")
