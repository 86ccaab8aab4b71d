"""What a map that fits its DBC still costs: coarse steps, narrow ranges, frames nobody checks."""

from __future__ import annotations

import re

from cantools.database.can import Database as CanDatabase

from tcs_hil.canbus.mapping.findings import Findings
from tcs_hil.canbus.mapping.lookup import find_message, find_signal
from tcs_hil.canbus.mapping.plan import (
    AXLE_INPUT,
    DRIVER_INPUTS,
    WHEEL_INPUTS,
    Plan,
)
from tcs_hil.canbus.mapping.profiles import Profile1, Profile2
from tcs_hil.canbus.mapping.settings import MessageSettings, ScaledSettings, SignalMap
from tcs_hil.canbus.mapping.units import unit_of
from tcs_hil.model.vehicle import Vehicle

COARSE_SLIP_RATIO = 0.01
"""Steps of the slip beyond this are felt by a law that holds a tenth."""
CRAWL_MPS = 2.0
"""Below this speed every wheel sensor is coarse."""
COUNTING = re.compile(r"alive|count|cnt|sqc|_bz$", re.IGNORECASE)
CHECKING = re.compile(r"crc|chk|chks|check_?sum|_cs$", re.IGNORECASE)
"""How counters and checksums are called."""


def look_over(
    plan: Plan, dbc: CanDatabase, settings: SignalMap, vehicle: Vehicle, findings: Findings
) -> None:
    """Find what the car would drive worse with than it could."""
    _check_steps(plan, vehicle, findings)
    _check_requests(plan, vehicle, findings)
    _check_ceilings(plan, vehicle, findings)
    _check_units(plan, dbc, settings, findings)
    _check_protection(plan, dbc, settings, findings)


def _check_steps(plan: Plan, vehicle: Vehicle, findings: Findings) -> None:
    """One bit of a wheel's speed, against the speed itself, is slip that is not there."""
    for name in WHEEL_INPUTS:
        if name not in plan.inputs:
            continue
        step_radps = abs(plan.inputs[name].value.scale)
        coarse_mps = step_radps * vehicle.wheel_radius_m / COARSE_SLIP_RATIO
        if coarse_mps > CRAWL_MPS:
            findings.warn(
                f"inputs.{name}",
                f"has steps of {step_radps:.3g} rad/s: below {coarse_mps:.1f} m/s one step is more "
                f"than {COARSE_SLIP_RATIO:.0%} of slip",
            )


def _check_requests(plan: Plan, vehicle: Vehicle, findings: Findings) -> None:
    for name in (*DRIVER_INPUTS, AXLE_INPUT):
        if name in plan.inputs:
            highest_nm = plan.inputs[name].value.maximum
            if highest_nm < vehicle.motor_torque_max_nm:
                findings.warn(
                    f"inputs.{name}",
                    f"can ask {highest_nm:.4g} Nm of a motor, which has "
                    f"{vehicle.motor_torque_max_nm:g} Nm; limits stop there as well",
                )


def _check_ceilings(plan: Plan, vehicle: Vehicle, findings: Findings) -> None:
    """A ceiling that cannot be lifted off the motor would hold the driver back for ever."""
    for name, code in plan.ceilings.items():
        key = f"limits.{name}"
        if code.smallest_nm > 0.0:
            findings.warn(key, f"can hold a motor down to {code.smallest_nm:.4g} Nm only")
        if code.no_limit_nm == code.largest_nm < vehicle.motor_torque_max_nm:
            findings.error(
                key,
                f"can say {code.largest_nm:.4g} Nm at most, less than the motor's "
                f"{vehicle.motor_torque_max_nm:g} Nm: without no_limit_raw the driver would never "
                "get all of it",
            )


def _check_units(plan: Plan, dbc: CanDatabase, settings: SignalMap, findings: Findings) -> None:
    for name in plan.inputs:
        _check_unit(dbc, f"inputs.{name}", getattr(settings.inputs, name), findings)
    for name in plan.ceilings:
        _check_unit(dbc, f"limits.{name}", getattr(settings.limits, name), findings)


def _check_unit(dbc: CanDatabase, key: str, settings: ScaledSettings, findings: Findings) -> None:
    message, _, name = settings.signal.partition(".")
    in_dbc = find_signal(find_message(dbc, message, key), name, key).unit
    if settings.unit is None or not in_dbc or unit_of(settings.unit) == unit_of(in_dbc):
        return
    findings.warn(
        f"{key}.unit",
        f'says {settings.unit} and the DBC says "{in_dbc}" of {settings.signal}; the map is taken',
    )


def _check_protection(
    plan: Plan, dbc: CanDatabase, settings: SignalMap, findings: Findings
) -> None:
    for message in (*plan.messages.values(), *(output.message for output in plan.outputs)):
        key = f"messages.{message.name}"
        named = _named(settings.messages.get(message.name, MessageSettings()))
        signals = find_message(dbc, message.name, key).signals
        suspects = (s.name for s in signals if COUNTING.search(s.name) or CHECKING.search(s.name))
        unused = [name for name in suspects if name not in named]
        if unused and not isinstance(message.protection, Profile1 | Profile2):
            findings.warn(
                key,
                f"by name, {' and '.join(unused)} would be a counter or a checksum; not used",
            )
        elif message.protection is None:
            findings.note(key, "nothing protects it: damaged and repeated frames go unnoticed")


def _named(settings: MessageSettings) -> set[str]:
    names = {*settings.fixed}
    names |= set() if settings.counter is None else set(settings.counter.signals)
    return names | (set() if settings.checksum is None else {settings.checksum.signal})
