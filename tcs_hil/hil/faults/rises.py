"""How fast the limits rose, against how fast they may: from one limit on the bus to the next."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from tcs_hil.hil.faults.record import FloatArray, Record
from tcs_hil.safety_settings import GateSettings, SupervisorSettings
from tcs_hil.signals import TcsState
from tcs_hil.supervisor import DRIVER_CYCLE_S, PERIOD_S

Mask = NDArray[np.bool_]

SETTLED = (TcsState.STANDBY, TcsState.ACTIVE)
RESOLUTION_NM = 0.05
"""One step of the torque limit on the bus."""


def rises_nm(record: Record) -> FloatArray:
    """How far each limit rose since the tick before, (n - 1, 2); -inf where there was none.

    A limit that is lifted rises to the request: that is the torque then in force.
    """
    before, now = record.limit_nm[:-1], record.limit_nm[1:]
    in_force = np.where(np.isposinf(now), record.request_nm[1:], now)
    return np.where(np.isposinf(before), -np.inf, in_force - before)


def allowed_nm(record: Record, gate: GateSettings, patience: SupervisorSettings) -> FloatArray:
    """How far each limit may rise in a tick, (n - 1, 2), by states, ages and wishes alone.

    Not at all while a third cycle of a wheel speed or a request is missing; slowly
    unless all is well, and from there on until a limit has met what the law wants.
    """
    settled = np.isin(record.state, SETTLED)
    slowly = ~settled[:, np.newaxis] | _unmet(record, settled)
    rate_nmps = np.where(slowly, gate.release_rate_nmps, gate.rise_rate_nmps)
    held = (record.state == TcsState.DEGRADED) & _awaited(record, patience)
    allowed: FloatArray = np.where(held[:, np.newaxis], 0.0, rate_nmps * PERIOD_S)
    return allowed[1:]


def beyond_window_nm(record: Record, gate: GateSettings) -> FloatArray:
    """How far each limit that rose is above the lowest of the window before it, beyond what may be.

    (n - 1, 2); -inf where the limit did not rise, or there was none before it.
    """
    ticks = round(gate.window_s / PERIOD_S)
    beyond = np.full(record.limit_nm[1:].shape, -np.inf)
    rose = np.isfinite(record.limit_nm[1:]) & (record.limit_nm[1:] > record.limit_nm[:-1])
    for before, side in np.argwhere(rose):
        recent_nm = record.limit_nm[max(before + 1 - ticks, 0) : before + 1, side]
        now_nm = record.limit_nm[before + 1, side]
        beyond[before, side] = now_nm - _lowest_since_none(recent_nm) - gate.window_rise_nm
    return beyond


def _awaited(record: Record, patience: SupervisorSettings) -> Mask:
    cycles = np.maximum(record.wheel_age_s / PERIOD_S, record.driver_age_s / DRIVER_CYCLE_S)
    return np.asarray(cycles >= patience.bridged_cycles + 1)


def _unmet(record: Record, settled: Mask) -> Mask:
    """Where a law that is trusted again has wanted more than the limit ever since, (n, 2)."""
    in_force = np.minimum(record.limit_nm[:-1], record.request_nm[1:])
    met = record.wanted_nm[1:] <= in_force + RESOLUTION_NM
    unmet = np.zeros(record.limit_nm.shape, np.bool_)
    for now in range(1, len(unmet)):
        unmet[now] = (unmet[now - 1] & ~met[now - 1]) if settled[now] else True
    return unmet


def _lowest_since_none(limit_nm: FloatArray) -> float:
    """The lowest limit after the last tick without one; the newest is a limit."""
    none = np.flatnonzero(np.isposinf(limit_nm))
    return float(limit_nm[none[-1] + 1 :].min() if none.size else limit_nm.min())
