"""Keeps watch over one cyclic message: what its frames said, how often and how late they came."""

from __future__ import annotations

from tcs_hil.canbus.cadence import Cadence
from tcs_hil.canbus.e2e import ERROR, REPEATED, E2EStatus
from tcs_hil.canbus.e2e_state import StateMachine, WindowSpec
from tcs_hil.signals import InputState


class MessageWatch:
    """Advances the E2E state machine by every frame and by every cycle without one.

    A frame too many counts as an error, whatever its CRC says: it takes two
    senders for that, and one of them is not who we think.  Unless it repeats the
    one before: that is an echo, and brings nothing that could be believed.
    """

    __slots__ = ("_cadence", "_machine")

    def __init__(self, window: WindowSpec, cycle_ns: int) -> None:
        self._cadence = Cadence(cycle_ns)
        self._machine = StateMachine(window)

    def count(self, status: E2EStatus, stamp_ns: int) -> None:
        """Count a frame that came at ``stamp_ns``, judged as ``status``."""
        self._pass_time(stamp_ns)
        expected = self._cadence.arrive(stamp_ns)
        believable = expected or status is REPEATED
        self._machine.add(status if believable else ERROR)

    def state(self, now_ns: int) -> InputState:
        """State at ``now_ns``, every cycle without its frame counted."""
        self._pass_time(now_ns)
        return self._machine.state

    def _pass_time(self, now_ns: int) -> None:
        missed = self._cadence.missed(now_ns)
        if missed:
            self._machine.add_missed(missed)
