"""Sending one message of another car: the ceilings and what goes with them."""

from __future__ import annotations

from tcs_hil.canbus.codec import compile_codec
from tcs_hil.canbus.mapping.mailbox import NS_PER_MS
from tcs_hil.canbus.mapping.plan import MappedOutput
from tcs_hil.canbus.outbox import Cycle, OutgoingFrame
from tcs_hil.signals import Command


class MappedSender:
    """Encodes, counts and signs one message, on the cycle that its receivers expect."""

    def __init__(self, output: MappedOutput) -> None:
        message, fields = output.message, output.fields
        self._frame_id = message.frame_id
        self._fills = tuple(field.fill for field in fields)
        signals = [field.signal for field in fields]
        self._encode = compile_codec(message.name, message.length, signals).encode
        protection = message.protection
        self._protector = protection.protector() if protection is not None else None
        self._cycle = Cycle(round(message.cycle_ms * NS_PER_MS))

    def is_due(self, now_ns: int) -> bool:
        """Say once per cycle that the message is due; the first time at once."""
        return self._cycle.is_due(now_ns)

    def frame(self, command: Command) -> OutgoingFrame:
        """Encode the command with the next counter and the checksum."""
        payload = self._encode(*(fill(command) for fill in self._fills))
        if self._protector is not None:
            self._protector.protect(payload)
        return self._frame_id, bytes(payload)
