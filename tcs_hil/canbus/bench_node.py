"""The bench as a node on the bus: a person's wishes to frames, and back.  Pure."""

from __future__ import annotations

from dataclasses import dataclass

from tcs_hil.canbus.bench_control import AS_IN_SCENARIO, BenchControl, BenchFault
from tcs_hil.canbus.codec import SignalSpec
from tcs_hil.canbus.contract import AS_IN_SCENARIO_LABEL
from tcs_hil.canbus.database import Database
from tcs_hil.canbus.e2e import E2EStatus
from tcs_hil.canbus.inbox import Mailbox
from tcs_hil.canbus.outbox import Outbox, OutgoingFrame

MESSAGE = "BenchControl"
_FAULTS = {int(fault): fault for fault in BenchFault}


@dataclass(frozen=True, slots=True)
class _Override:
    """A value that may be absent on the bus: its highest raw value says so."""

    absent: float
    largest: float

    @classmethod
    def of(cls, signal: SignalSpec) -> _Override:
        absent = signal.labels[AS_IN_SCENARIO_LABEL]
        return cls(absent, absent - signal.scale)

    def to_bus(self, value: float | None) -> float:
        return self.absent if value is None else min(value, self.largest)

    def from_bus(self, value: float) -> float | None:
        return None if value >= self.absent else value


def _overrides(database: Database) -> tuple[_Override, _Override]:
    message = database.messages[MESSAGE]
    return _Override.of(message.signal("BenchThrottle")), _Override.of(message.signal("BenchMu"))


class BenchNode:
    """Turns what the person wants into frames."""

    def __init__(self, database: Database) -> None:
        self._throttle, self._mu = _overrides(database)
        self._outbox = Outbox(database.messages[MESSAGE])

    def frame(self, control: BenchControl) -> OutgoingFrame:
        """Encode and sign the next control frame."""
        return self._outbox.frame(
            self._throttle.to_bus(control.throttle_nm),
            self._mu.to_bus(control.mu_ratio),
            control.fault,
        )


class BenchInbox:
    """Turns frames into what the person wants.

    A fault outside of the value table reads as none.
    """

    def __init__(self, database: Database) -> None:
        self._throttle, self._mu = _overrides(database)
        self._mailbox = Mailbox(database.messages[MESSAGE], ())
        self.frame_id = self._mailbox.frame_id

    def feed(self, data: bytes, stamp_ns: int) -> bool:
        """Take one control frame; True if it was good and ``control`` is now what it says."""
        fits = len(data) == self._mailbox.length
        return fits and self._mailbox.put(data, stamp_ns) is E2EStatus.OK

    @property
    def control(self) -> BenchControl:
        """What the newest good frame says; the scenario's own before the first."""
        if self._mailbox.stamp_ns is None:
            return AS_IN_SCENARIO
        throttle, mu, fault = self._mailbox.values
        return BenchControl(
            self._throttle.from_bus(throttle),
            self._mu.from_bus(mu),
            _FAULTS.get(int(fault), BenchFault.NONE),
        )
