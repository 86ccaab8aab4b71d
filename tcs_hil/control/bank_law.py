"""The default Koopman MPC put together: bank, delay, integral, and a PI where data end."""

from __future__ import annotations

from tcs_hil.control.bank_kmpc import BankOptimiser
from tcs_hil.control.break_away import BreakAway
from tcs_hil.control.compensated import CompensatedController, DelayedOptimiser
from tcs_hil.control.grip_update import GripOptimiser
from tcs_hil.control.guarded import GuardedController
from tcs_hil.control.integrator import BoundedIntegral
from tcs_hil.control.pi import PiController
from tcs_hil.control.protocol import Controller
from tcs_hil.control.settings import ControlSettings
from tcs_hil.control.swing_guard import SwingGuard
from tcs_hil.errors import ConfigError
from tcs_hil.model.bank import KoopmanBank, slippery_bank_path


def bank_mpc(settings: ControlSettings, bank: KoopmanBank) -> Controller:
    """One wheel's default KMPC.

    Raises ConfigError for a bank made for another period, and ModelError if the
    online update is on and the shipped bank for ice cannot be used.
    """
    if bank.period_s != settings.period_s:
        raise ConfigError(f"period_s is {settings.period_s}, but the bank is for {bank.period_s}")
    integral = BoundedIntegral(
        settings.slip_reference, settings.period_s, settings.default.integral_limit_s
    )
    vehicle = bank.provenance.settings.vehicle
    break_away = BreakAway(settings.slip_reference, vehicle, settings.period_s)
    guard = SwingGuard(settings.slip_reference, vehicle, settings.period_s)
    optimiser = _optimiser(settings, bank)
    law = CompensatedController(optimiser, integral, guard, settings.period_s, break_away)
    speed_mps = bank.validity.speed_mps
    return GuardedController(law, PiController(settings), speed_mps, settings.period_s)


def _optimiser(settings: ControlSettings, bank: KoopmanBank) -> DelayedOptimiser:
    if not settings.default.kmpc.online_update:
        return BankOptimiser(settings, bank)
    slippery = KoopmanBank.load(slippery_bank_path(), settings.period_s)
    return GripOptimiser(settings, (bank, slippery))
