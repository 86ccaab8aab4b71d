"""Quantities that a measurement judges together, wherever they come from."""

from __future__ import annotations

from collections.abc import Sequence

from tcs_hil.canbus.mapping.mailbox import MappedMailbox
from tcs_hil.canbus.mapping.reading import Reading
from tcs_hil.signals import InputState


class Group:
    """Readings that are as old as the oldest of them, and as good as the worst message.

    Without any message the car has no such thing, and nothing ever comes.
    """

    def __init__(self, readings: Sequence[Reading], mailboxes: Sequence[MappedMailbox]) -> None:
        self._readings = readings
        self._mailboxes = mailboxes

    @property
    def values(self) -> tuple[float, ...]:
        """Newest values, in the readings' order."""
        return tuple(reading.value for reading in self._readings)

    @property
    def valid(self) -> tuple[bool, ...]:
        """Whether the senders vouch for them."""
        return tuple(reading.valid for reading in self._readings)

    @property
    def stamps_ns(self) -> list[int]:
        """Stamps of those that have come."""
        return [r.stamp_ns for r in self._readings if r.stamp_ns is not None]

    def age_s(self, now_ns: int) -> float:
        """Age of the oldest value; infinite while one is missing."""
        return max(reading.age_s(now_ns) for reading in self._readings)

    def state(self, now_ns: int) -> InputState:
        """Worst that the protection of their messages has come to."""
        states = [mailbox.state(now_ns) for mailbox in self._mailboxes]
        if InputState.INVALID in states:
            return InputState.INVALID
        return min(states, default=InputState.ABSENT)
