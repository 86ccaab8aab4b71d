"""A counter and a checksum wherever a maker has put them."""

from __future__ import annotations

from dataclasses import dataclass
from operator import mul

from tcs_hil.canbus.codec import compile_codec
from tcs_hil.canbus.e2e import E2EStatus
from tcs_hil.canbus.mapping.checksums import Checksum, Seal
from tcs_hil.canbus.mapping.counter import Counter, Succession


@dataclass(frozen=True, slots=True)
class Homemade:
    """Protection of a message of ``length`` bytes; either part of it may be missing."""

    length: int
    counter: Counter | None = None
    checksum: Checksum | None = None

    def checker(self) -> HomemadeChecker:
        """Make a receiver's side."""
        return HomemadeChecker(self)

    def protector(self) -> HomemadeProtector:
        """Make a sender's side."""
        return HomemadeProtector(self)


class HomemadeChecker:
    """The checksum speaks first: a damaged counter says nothing about lost frames."""

    def __init__(self, spec: Homemade) -> None:
        self._seal = None if spec.checksum is None else Seal(spec.checksum)
        self._counter = spec.counter
        if spec.counter is not None:
            self._decode = compile_codec("counter", spec.length, spec.counter.parts).decode
            self._weights = spec.counter.weights()
            self._succession = Succession(spec.counter.highest, spec.counter.max_step)

    def check(self, payload: bytes) -> E2EStatus:
        """Judge the next frame of the message."""
        if self._seal is not None and not self._seal.holds(payload):
            return E2EStatus.ERROR
        if self._counter is None:
            return E2EStatus.OK
        count = sum(map(mul, self._weights, self._decode(payload)))
        return self._succession.judge(int(count))


class HomemadeProtector:
    """Counts from 1, like autosar-e2e."""

    def __init__(self, spec: Homemade) -> None:
        self._seal = None if spec.checksum is None else Seal(spec.checksum)
        self._counter = spec.counter
        self._count = 0
        if spec.counter is not None:
            self._encode = compile_codec("counter", spec.length, spec.counter.parts).encode

    def protect(self, payload: bytearray) -> None:
        """Write the next counter and the checksum."""
        if self._counter is not None:
            self._count = (self._count + 1) % (self._counter.highest + 1)
            counted = self._encode(*self._counter.split(self._count))
            payload[:] = bytes(map(int.__or__, payload, counted))
        if self._seal is not None:
            self._seal.put(payload)
