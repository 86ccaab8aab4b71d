"""What the supervisor looks at in one tick, and what it decides."""

from __future__ import annotations

from enum import IntEnum

import msgspec

from tcs_hil.fault_codes import FaultCode
from tcs_hil.gate import Permission
from tcs_hil.signals import BusCondition, TcsState


class Health(IntEnum):
    """What has become of one message, by its age and by its end-to-end protection."""

    GOOD = 0
    LATE = 1
    LOST = 2
    CORRUPT = 3
    AWAITED = 4
    ABSENT = 5  # the car has no such message, and nobody expects it


class Situation(msgspec.Struct, frozen=True):
    """What the rules look at in one tick."""

    front: Health
    rear: Health
    motor: Health
    driver: Health
    suspects: int  # bits of Suspect: implausible
    unusable: int  # the same, and wheels whose sensor says that it fails
    bus: BusCondition
    overrunning: bool = False
    replaced: bool = False  # something stood in for a law
    silent: bool = False  # a law could not decide, and nothing stood in for it
    mute: bool = False  # that has lasted too long
    broken: bool = False  # our own code raised


class Verdict(msgspec.Struct, frozen=True):
    """State, reason and permission for one tick."""

    state: TcsState
    fault_code: FaultCode
    permission: Permission
