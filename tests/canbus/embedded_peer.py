"""One node of the process tests; told what to do by lines on stdin, answers on stdout.

``open`` joins the channel; ``talk ID COUNT EXPECTED`` sends COUNT numbered frames
while reading, until EXPECTED frames are in, and prints what came from whom as JSON.
"""

from __future__ import annotations

import json
import sys
import time
from collections import defaultdict

import can

from tcs_hil.canbus.embedded import EmbeddedBus

PATIENCE_S = 30.0


def talk(bus: EmbeddedBus, own_id: int, count: int, expected: int) -> dict[int, list[int]]:
    heard: dict[int, list[int]] = defaultdict(list)
    deadline = time.monotonic() + PATIENCE_S
    number = 0
    while number < count or sum(map(len, heard.values())) < expected:
        if time.monotonic() > deadline:
            break
        if number < count:
            data = number.to_bytes(4, "big")
            bus.send(can.Message(arbitration_id=own_id, data=data, is_extended_id=False))
            number += 1
        while (msg := bus.recv(0.0 if number < count else 0.01)) is not None:
            heard[msg.arbitration_id].append(int.from_bytes(msg.data, "big"))
    return heard


def main() -> None:
    bus = None
    for line in sys.stdin:
        match line.split():
            case ["open"]:
                bus = EmbeddedBus("vcan0")
                print("open", flush=True)
            case ["talk", *numbers]:
                print(json.dumps(talk(bus, *map(int, numbers))), flush=True)
    if bus is not None:
        bus.shutdown()


if __name__ == "__main__":
    main()
