"""From what a DBC counts in to what the service computes with."""

from __future__ import annotations

from collections.abc import Sequence

from cantools.database.can import Signal

from tcs_hil.canbus.codec import SignalSpec
from tcs_hil.canbus.mapping.findings import MapFault
from tcs_hil.canbus.mapping.plan import scaled
from tcs_hil.canbus.mapping.settings import ScaledSettings
from tcs_hil.canbus.mapping.units import Kind, gain, unit_of, units_for
from tcs_hil.model.vehicle import Vehicle

AXLE_MOTORS = 2


def unit_named(settings: ScaledSettings, signal: Signal, kind: Kind, key: str) -> str:
    """Our name of the unit: the map's word, else the DBC's.

    Raises:
        MapFault: Nobody says the unit, or it does not measure ``kind``.
    """
    text = settings.unit if settings.unit is not None else signal.unit or ""
    unit = unit_of(text)
    if unit in units_for(kind):
        return unit
    said = f'"{text}"' if text else "no unit"
    who = "the map" if settings.unit is not None else f"the DBC, for {settings.signal},"
    raise MapFault(key, f"{who} says {said}; give unit as one of {_listed(units_for(kind))}")


def in_si(
    spec: SignalSpec, settings: ScaledSettings, unit: str, kind: Kind, vehicle: Vehicle, axle: bool
) -> SignalSpec:
    """Bits of ``spec`` in the unit of ``kind``; a torque of the axle becomes one motor's half."""
    factor = _gain(settings, unit, kind, vehicle, axle)
    return scaled(spec, settings.factor * factor, settings.offset * factor)


def _gain(settings: ScaledSettings, unit: str, kind: Kind, vehicle: Vehicle, axle: bool) -> float:
    torque_ratio = _torque_ratio(settings, vehicle, axle)
    full_scale_nm = settings.full_scale_nm or vehicle.motor_torque_max_nm * torque_ratio
    factor = gain(kind, unit, vehicle, full_scale_nm)
    if kind is Kind.TORQUE:
        return factor / torque_ratio
    if kind is Kind.MOTOR_SPEED and settings.at == "wheel":
        return factor * vehicle.gear_ratio
    return factor


def _torque_ratio(settings: ScaledSettings, vehicle: Vehicle, axle: bool) -> float:
    """How many times one motor's torque the DBC counts."""
    return (vehicle.gear_ratio if settings.at == "wheel" else 1.0) * (AXLE_MOTORS if axle else 1)


def _listed(units: Sequence[str]) -> str:
    return ", ".join(units)
