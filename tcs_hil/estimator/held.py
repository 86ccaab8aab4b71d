"""Wheel speeds of the sensors that vouch for themselves; the others keep their last good one."""

from __future__ import annotations

from tcs_hil.signals import FourWheels, Measurement


def held(m: Measurement, last_radps: FourWheels) -> FourWheels:
    """Newest speeds where they are valid, else those of ``last_radps``, in rad/s."""
    fl, fr, rl, rr = m.wheel_speed_radps
    fl_valid, fr_valid, rl_valid, rr_valid = m.wheel_speed_valid
    last_fl, last_fr, last_rl, last_rr = last_radps
    return (
        fl if fl_valid else last_fl,
        fr if fr_valid else last_fr,
        rl if rl_valid else last_rl,
        rr if rr_valid else last_rr,
    )
