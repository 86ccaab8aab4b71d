"""The baseline: a speed-scheduled PI controller of the slip ratio."""

from __future__ import annotations

from tcs_hil.control.entry import Entry
from tcs_hil.control.protocol import Proposal, WheelState
from tcs_hil.control.screening import clamp, settled
from tcs_hil.control.settings import ControlSettings


class PiController:
    """T = K(v) e + I, I' = K(v) e / T_i, with e = kappa_ref - kappa and T in [0, T_ref].

    The wheel answers torque with a slip rate that falls as 1/v, so the gain
    rises with v.  The law is asleep until the slip nears its reference, starts
    from the driver's torque without a bump, and sleeps again once its integral
    has given all of it back.
    """

    def __init__(self, settings: ControlSettings) -> None:
        self._tuning = settings.pi if settings.preset == "paper" else settings.default.pi
        self._slip_reference = settings.slip_reference
        entry_ratio = self._tuning.entry_ratio * settings.slip_reference
        self._entry = Entry(entry_ratio, self._tuning.entry_slip_mps)
        self._integral_share = settings.period_s / self._tuning.integral_time_s
        self._integral_nm = 0.0
        self._awake = False

    def step(self, wheel: WheelState, torque_ref_nm: float) -> Proposal:
        """Propose the motor torque for the coming period."""
        trivial = settled(wheel, torque_ref_nm)
        if trivial is not None:
            self.reset()
            return trivial
        proportional_nm = self._gain_nm(wheel) * (self._slip_reference - wheel.slip_ratio)
        if not self._awake_after(wheel, proportional_nm, torque_ref_nm):
            return Proposal(torque_ref_nm)
        integral_nm = self._integral_nm + self._integral_share * proportional_nm
        self._integral_nm = clamp(integral_nm, torque_ref_nm)
        return Proposal(clamp(proportional_nm + self._integral_nm, torque_ref_nm))

    def follow(self, wheel: WheelState, torque_nm: float, torque_ref_nm: float) -> None:
        """Take on what another law has proposed, to go on from there without a bump."""
        proportional_nm = self._gain_nm(wheel) * (self._slip_reference - wheel.slip_ratio)
        self._integral_nm = clamp(torque_nm - proportional_nm, torque_ref_nm)
        self._awake = torque_nm < torque_ref_nm

    def reset(self) -> None:
        """Forget the integral and sleep."""
        self._integral_nm = 0.0
        self._awake = False

    def _gain_nm(self, wheel: WheelState) -> float:
        speed_mps = clamp(wheel.vehicle_speed_mps, self._tuning.gain_speed_ceiling_mps)
        return self._tuning.gain_base_nm + self._tuning.gain_slope_nm_per_mps * speed_mps

    def _awake_after(self, wheel: WheelState, proportional_nm: float, torque_ref_nm: float) -> bool:
        near = self._entry.passed(wheel)
        if near and not self._awake:
            self._integral_nm = clamp(torque_ref_nm - proportional_nm, torque_ref_nm)
        self._awake = near or (self._awake and self._integral_nm < torque_ref_nm)
        return self._awake
