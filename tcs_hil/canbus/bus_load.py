"""How much of the wire the cyclic messages of a database take."""

from __future__ import annotations

from tcs_hil.canbus.database import Database

FRAME_OVERHEAD_BITS = 47
"""Classic frame with an 11-bit identifier, without data, with the gap to the next."""
STUFFED_OVERHEAD_BITS = 34
"""Part of the overhead in which stuff bits occur: start of frame through CRC."""


def bus_load_ratio(database: Database, bitrate: int) -> float:
    """Share of the bus taken when every frame carries as many stuff bits as it can.

    A stuff bit can follow every fourth bit after the first (Davis, Burns, Bril &
    Lukkien, "Controller Area Network schedulability analysis", 2007, eq. 1).
    """
    bits_per_s = sum(
        worst_case_bits(spec.length) * 1e9 / spec.cycle_ns
        for spec in database.messages.values()
        if spec.cycle_ns
    )
    return bits_per_s / bitrate


def worst_case_bits(length: int) -> int:
    """Bits on the wire of a frame with ``length`` data bytes."""
    data_bits = 8 * length
    return FRAME_OVERHEAD_BITS + data_bits + (STUFFED_OVERHEAD_BITS + data_bits - 1) // 4
