"""The signal map as it is written in TOML: ``[map]`` of the configuration.

A signal is named ``Message.Signal``, as in the DBC.  Everything is optional
here: what the service cannot do without is for ``resolve`` to say, all at once.
"""

from __future__ import annotations

from typing import Annotated, Literal

import msgspec
from msgspec import Meta

SignalPath = Annotated[str, Meta(pattern=r"^\w+\.\w+$")]
SignalName = Annotated[str, Meta(pattern=r"^\w+$")]
Byte = Annotated[int, Meta(ge=0, le=0xFF)]
Place = Literal["motor", "wheel"]


class FlagSettings(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """A signal of the same message, and the raw values with which it vouches for another."""

    signal: SignalName
    equals: Annotated[tuple[int, ...], Meta(min_length=1)] = (1,)


class ScaledSettings(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """A signal and what its values mean.

    The DBC's physical value times ``factor`` plus ``offset`` is in ``unit``, by
    default the DBC's own.  A torque or a motor's speed may be counted ``at`` the
    wheel side of the gear.  ``full_scale_nm`` is what 100 % stands for, on the
    side and for the motor or axle concerned.
    """

    signal: SignalPath
    unit: str | None = None
    factor: float = 1.0
    offset: float = 0.0
    at: Place = "motor"
    full_scale_nm: Annotated[float, Meta(gt=0.0)] | None = None


class InputSettings(ScaledSettings, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """A value to be read, and when it is to be believed.

    ``valid_range`` is in the DBC's physical values, both ends included.
    """

    valid_when: FlagSettings | None = None
    invalid_raw: tuple[int, ...] = ()
    valid_range: tuple[float, float] | None = None


class LimitSettings(ScaledSettings, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """A torque ceiling to be written; ``no_limit_raw`` is the raw value that holds nothing.

    Without it the highest torque the signal can say stands for "no limit".
    """

    no_limit_raw: int | None = None


class ActiveSettings(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """A flag to be written: raw value while a motor is held below the request, and else."""

    signal: SignalPath
    active_raw: int = 1
    inactive_raw: int = 0


class InputMap(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Where each quantity of a measurement comes from; a torque of the axle is for two motors."""

    wheel_speed_fl: InputSettings | None = None
    wheel_speed_fr: InputSettings | None = None
    wheel_speed_rl: InputSettings | None = None
    wheel_speed_rr: InputSettings | None = None
    motor_speed_left: InputSettings | None = None
    motor_speed_right: InputSettings | None = None
    motor_torque_left: InputSettings | None = None
    motor_torque_right: InputSettings | None = None
    driver_torque_left: InputSettings | None = None
    driver_torque_right: InputSettings | None = None
    driver_torque_axle: InputSettings | None = None
    accel_x: InputSettings | None = None


class LimitMap(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Where the ceilings go: one for each motor, or one for the axle (twice the lower one)."""

    left: LimitSettings | None = None
    right: LimitSettings | None = None
    axle: LimitSettings | None = None
    active_left: ActiveSettings | None = None
    active_right: ActiveSettings | None = None
    active: ActiveSettings | None = None


class CounterSettings(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """A counter that grows by one with each frame, from 0 to ``highest`` (all ones by default).

    Where it is split, its signals are listed lowest bits first.  Up to
    ``max_step - 1`` frames may be lost before one is refused.
    """

    signals: Annotated[tuple[SignalName, ...], Meta(min_length=1)]
    highest: Annotated[int, Meta(ge=1)] | None = None
    max_step: Annotated[int, Meta(ge=1)] = 3


class ChecksumSettings(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """One byte over all others of the frame, in their order, and over ``data_id``.

    ``initial`` and ``final_xor`` are 0 for ``xor``, ``sum`` and ``sum-complement``
    (which makes the sum of all bytes 0), and 0xFF for the CRCs: ``crc8-j1850`` of
    polynomial 0x1D, ``crc8-h2f`` of 0x2F.
    """

    signal: SignalName
    kind: Literal["xor", "sum", "sum-complement", "crc8-j1850", "crc8-h2f"]
    initial: Byte | None = None
    final_xor: Byte | None = None
    data_id: tuple[Byte, ...] = ()
    data_id_place: Literal["before", "after"] = "after"


class Profile1Settings(
    msgspec.Struct,
    frozen=True,
    kw_only=True,
    forbid_unknown_fields=True,
    tag_field="profile",
    tag="P01",
):
    """AUTOSAR E2E Profile 1: CRC in byte 0, counter 0 to 14 in the low nibble of byte 1."""

    data_id: Annotated[int, Meta(ge=0, le=0xFFFF)]
    mode: Literal["both", "alternating", "low", "nibble"] = "both"
    max_step: Annotated[int, Meta(ge=1, le=14)] = 3


class Profile2Settings(
    msgspec.Struct,
    frozen=True,
    kw_only=True,
    forbid_unknown_fields=True,
    tag_field="profile",
    tag="P02",
):
    """AUTOSAR E2E Profile 2: as Profile 1 but counted to 15, with a data id for each count."""

    data_ids: Annotated[tuple[Byte, ...], Meta(min_length=16, max_length=16)]
    max_step: Annotated[int, Meta(ge=1, le=15)] = 3


class MessageSettings(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """What the DBC does not say about a message.

    ``fixed`` are raw values of signals that go out with a limit and never change.
    """

    cycle_ms: Annotated[float, Meta(gt=0.0)] | None = None
    counter: CounterSettings | None = None
    checksum: ChecksumSettings | None = None
    e2e: Profile1Settings | Profile2Settings | None = None
    fixed: dict[SignalName, int] = {}


class SignalMap(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """``[map]``: what is read, what is written, and how its messages are protected."""

    inputs: InputMap = InputMap()
    limits: LimitMap = LimitMap()
    messages: dict[str, MessageSettings] = {}
