"""Counters and checksums: known answers, and what is refused."""

from __future__ import annotations

from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tcs_hil.canbus.codec import SignalSpec
from tcs_hil.canbus.e2e import E2EStatus
from tcs_hil.canbus.mapping.checksums import Checksum, ChecksumKind, Seal
from tcs_hil.canbus.mapping.counter import Counter, Succession
from tcs_hil.canbus.mapping.homemade import Homemade
from tcs_hil.canbus.mapping.profiles import DataIdMode, Profile1
from tcs_hil.canbus.mapping.protection import Protection

from .makers import crc8

OK, ERROR, REPEATED, WRONG = (
    E2EStatus.OK,
    E2EStatus.ERROR,
    E2EStatus.REPEATED,
    E2EStatus.WRONG_SEQUENCE,
)
CHECK = b"123456789"


def part(shift: int, length: int) -> SignalSpec:
    top = (1 << length) - 1
    return SignalSpec("part", shift, length, False, False, 1, 0, 0, top)


def sealed(kind: ChecksumKind, data: bytes, initial: int, final_xor: int) -> int:
    frame = bytearray(data + b"\0")
    Seal(Checksum(len(data), kind, initial, final_xor)).put(frame)
    return frame[-1]


@pytest.mark.parametrize(
    ("kind", "initial", "final_xor", "expected"),
    [
        ("xor", 0x00, 0x00, 0x31),  # 31 ^ 32 ^ ... ^ 39
        ("sum", 0x00, 0x00, 0xDD),  # 31 + 32 + ... + 39 = 1dd
        ("sum", 0x05, 0xFF, 0x1D),  # 1e2, inverted
        ("sum-complement", 0x00, 0x00, 0x23),
        ("crc8-j1850", 0xFF, 0xFF, 0x4B),  # check values of the AUTOSAR CRC Library
        ("crc8-h2f", 0xFF, 0xFF, 0xDF),
        ("crc8-j1850", 0x00, 0x00, 0x37),  # CRC-8/GSM-A in the CRC catalogue
    ],
)
def test_checksums_have_their_known_values(
    kind: ChecksumKind, initial: int, final_xor: int, expected: int
) -> None:
    assert sealed(kind, CHECK, initial, final_xor) == expected


@given(
    data=st.binary(min_size=1, max_size=7),
    initial=st.integers(0, 255),
    final_xor=st.integers(0, 255),
)
def test_crcs_take_any_initial_value_and_final_exclusive_or(
    data: bytes, initial: int, final_xor: int
) -> None:
    for kind, polynomial in (("crc8-j1850", 0x1D), ("crc8-h2f", 0x2F)):
        expected = crc8(polynomial, data, initial, final_xor)
        assert sealed(kind, data, initial, final_xor) == expected  # type: ignore[arg-type]


def test_the_data_id_goes_before_or_after_the_frame() -> None:
    frame = bytearray(b"\0abc")
    Seal(Checksum(0, "crc8-h2f", 0xFF, 0xFF, prefix=b"id")).put(frame)
    assert frame[0] == crc8(0x2F, b"idabc")
    Seal(Checksum(0, "crc8-h2f", 0xFF, 0xFF, suffix=b"id")).put(frame)
    assert frame[0] == crc8(0x2F, b"abcid")


def test_a_checksum_in_the_middle_skips_itself() -> None:
    frame = bytearray(b"\x01\xff\x02")
    Seal(Checksum(1, "sum", 0, 0)).put(frame)
    assert frame == b"\x01\x03\x02"


def test_a_counter_in_three_parts_has_its_lowest_bits_first() -> None:
    counter = Counter((part(0, 2), part(9, 1), part(20, 3)), highest=63, max_step=3)
    assert counter.split(0b101_1_10) == [0b10, 1, 0b101]
    assert counter.weights() == (1, 4, 8)


@pytest.mark.parametrize(
    ("counts", "verdicts"),
    [
        ([5, 6, 7], [OK, OK, OK]),
        ([14, 0, 1], [OK, OK, OK]),  # 14 is the highest
        ([5, 5, 6], [OK, REPEATED, OK]),
        ([5, 8, 12, 13], [OK, OK, WRONG, OK]),  # two may be lost, three not
        ([5, 4, 5], [OK, WRONG, OK]),
        ([5, 15, 6], [OK, ERROR, OK]),  # no such count
    ],
)
def test_a_succession_is_judged_by_its_steps(counts: list[int], verdicts: list[E2EStatus]) -> None:
    succession = Succession(highest=14, max_step=3)
    assert [succession.judge(count) for count in counts] == verdicts


HOMEMADE = Homemade(
    6, Counter((part(3, 2), part(30, 3)), highest=29, max_step=2), Checksum(5, "xor", 0xA5, 0)
)


@pytest.mark.parametrize(
    "protection",
    [
        HOMEMADE,
        replace(HOMEMADE, checksum=None),
        replace(HOMEMADE, counter=None),
        *(Profile1(0x1234, mode, 3) for mode in ("both", "alternating", "low", "nibble")),
    ],
    ids=str,
)
def test_what_is_protected_is_accepted_for_ever(protection: Protection) -> None:
    sender, receiver = protection.protector(), protection.checker()
    for _ in range(40):
        frame = bytearray(b"\0\0\x10\x20\x02\0")
        sender.protect(frame)
        assert receiver.check(bytes(frame)) is OK


@pytest.mark.parametrize("mode", ["both", "alternating", "low", "nibble"])
@given(bit=st.integers(0, 47))
def test_profile_1_refuses_a_frame_with_any_bit_turned(mode: DataIdMode, bit: int) -> None:
    protection = Profile1(0x1234, mode, 3)
    frame = bytearray(b"\0\0\x10\x20\x02\0")
    protection.protector().protect(frame)
    frame[bit // 8] ^= 1 << bit % 8
    assert protection.checker().check(bytes(frame)) is ERROR


@given(bit=st.integers(0, 47))
def test_an_exclusive_or_refuses_a_frame_with_any_bit_turned(bit: int) -> None:
    frame = bytearray(6)
    HOMEMADE.protector().protect(frame)
    frame[bit // 8] ^= 1 << bit % 8
    assert HOMEMADE.checker().check(bytes(frame)) is ERROR


def test_a_damaged_frame_does_not_move_the_counter() -> None:
    sender, receiver = HOMEMADE.protector(), HOMEMADE.checker()
    verdicts = []
    for spoil in (0, 0, 0xFF, 0xFF, 0):
        frame = bytearray(6)
        sender.protect(frame)
        frame[4] ^= spoil
        verdicts.append(receiver.check(bytes(frame)))
    assert verdicts == [OK, OK, ERROR, ERROR, WRONG]  # max_step 2: two lost is one too many


def test_another_data_id_is_another_sender() -> None:
    frame = bytearray(6)
    Profile1(0x1234, "both", 3).protector().protect(frame)
    assert Profile1(0x1235, "both", 3).checker().check(bytes(frame)) is ERROR
