"""Length of a classic CAN frame on the wire, stuff bits counted one by one."""

from __future__ import annotations

from plant_emulator.compiled import compiled

UNSTUFFED_BITS = 13  # CRC and ACK delimiters, ACK slot, end of frame (7), interframe space (3)
CRC_POLYNOMIAL = 0x4599


@compiled
def _stuffed(word: int, bits: int, run: int, last: int, crc: int) -> tuple[int, int, int, int]:
    """Send ``bits`` of ``word``, highest first; returns stuff bits, run, last bit and CRC."""
    stuffed = 0
    for place in range(bits - 1, -1, -1):
        bit = (word >> place) & 1
        crc = ((crc << 1) ^ (CRC_POLYNOMIAL * (bit ^ ((crc >> 14) & 1)))) & 0x7FFF
        run = run + 1 if bit == last else 1
        last = bit
        if run == 5:  # the complement is inserted and starts a run of its own
            stuffed, run, last = stuffed + 1, 1, 1 - bit
    return stuffed, run, last, crc


@compiled
def _frame_bits(frame_id: int, length: int, high: int, low: int) -> int:
    # Start of frame, identifier, RTR, IDE and r0 (all dominant), length code.
    header = (frame_id << 7) | length
    total, run, last, crc = _stuffed(header, 19, 0, 2, 0)
    in_high = max(length - 4, 0)
    more, run, last, crc = _stuffed(high, 8 * in_high, run, last, crc)
    total += more
    more, run, last, crc = _stuffed(low, 8 * (length - in_high), run, last, crc)
    total += more
    more, _, _, _ = _stuffed(crc, 15, run, last, 0)
    return total + more + 19 + 8 * length + 15 + UNSTUFFED_BITS


def frame_bits(frame_id: int, data: bytes) -> int:
    """Bits of a data frame with an 11-bit identifier, interframe space included.

    Source: ISO 11898-1: five equal bits from start of frame to the end of the
    CRC are followed by one of the other kind.
    """
    word = int.from_bytes(data, "big")
    # Two halves: compiled integers have 64 bits and a sign.
    return _frame_bits(frame_id, len(data), word >> 32, word & 0xFFFF_FFFF)
