"""The bus vcan has not: frame lengths, arbitration, load and loss."""

import itertools

import msgspec
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from plant_emulator.bustiming import IDEAL, BusTiming
from plant_emulator.frame_bits import frame_bits
from plant_emulator.virtual_bus import Sender, VirtualBus

WIRE = BusTiming(bitrate=500_000)
BIT_NS = 2000


def bits_by_text(frame_id, data):
    """The same count from strings: CRC-15 by long division, stuffing by regular groups."""
    head = f"0{frame_id:011b}000{len(data):04b}" + "".join(f"{byte:08b}" for byte in data)
    rest = [int(bit) for bit in head + "0" * 15]
    divisor = [int(bit) for bit in f"{0xC599:016b}"]
    for start in range(len(head)):
        if rest[start]:
            for place, bit in enumerate(divisor):
                rest[start + place] ^= bit
    stream = head + "".join(map(str, rest[-15:]))
    sent = []
    for bit in stream:
        sent.append(bit)
        if len(sent) >= 5 and len(set(sent[-5:])) == 1 and _run(sent) % 5 == 0:
            sent.append("1" if bit == "0" else "0")
    return len(sent) + 10 + 3


def _run(sent):
    return len(next("".join(group) for _, group in itertools.groupby(reversed(sent))))


@pytest.mark.parametrize("seed", range(40))
def test_frame_lengths_agree_with_a_count_on_text(seed):
    rng = np.random.default_rng(seed)
    data = bytes(
        rng.choice([0x00, 0xFF, 0x1F, 0xF8, 0x55, int(rng.integers(256))], rng.integers(9)).tolist()
    )
    frame_id = int(rng.choice([0x000, 0x7FF, 0x090, 0x0A1, int(rng.integers(0x800))]))
    assert frame_bits(frame_id, data) == bits_by_text(frame_id, data)


def test_a_frame_without_stuff_bits_has_the_length_of_the_standard():
    assert min(frame_bits(i, b"\x55" * 8) for i in range(0x800)) == 47 + 64


def ids(deliveries):
    return [delivery.frame.frame_id for delivery in deliveries]


def test_an_ideal_wire_delivers_at_once_in_order_of_identifiers():
    bus = VirtualBus(IDEAL)
    for frame_id in (0xA2, 0x98, 0xA0):
        bus.offer(5, frame_id, b"", Sender.VEHICLE)
    delivered = bus.run_until(5)
    assert ids(delivered) == [0x98, 0xA0, 0xA2]
    assert {delivery.time_ns for delivery in delivered} == {5}


def test_a_frame_arrives_after_its_bits():
    bus = VirtualBus(WIRE)
    bus.offer(1000, 0xA1, b"\x12" * 6, Sender.VEHICLE)
    end_ns = 1000 + frame_bits(0xA1, b"\x12" * 6) * BIT_NS
    assert bus.run_until(end_ns - 1) == []
    assert bus.next_arrival_ns == end_ns
    (delivery,) = bus.run_until(end_ns)
    assert delivery.time_ns == end_ns
    assert bus.next_arrival_ns is None


def test_the_lowest_identifier_wins_but_never_interrupts():
    bus = VirtualBus(WIRE)
    bus.offer(0, 0x300, b"", Sender.SERVICE)
    bus.offer(10_000, 0x200, b"", Sender.VEHICLE)
    bus.offer(20_000, 0x100, b"", Sender.VEHICLE)
    delivered = bus.run_until(1_000_000)
    assert ids(delivered) == [0x300, 0x100, 0x200]
    lengths = [frame_bits(frame_id, b"") * BIT_NS for frame_id in ids(delivered)]
    assert [delivery.time_ns for delivery in delivered] == list(np.cumsum(lengths))


def data(deliveries):
    return [delivery.frame.data for delivery in deliveries]


def test_equal_identifiers_keep_their_order():
    bus = VirtualBus(WIRE)
    for sender, payload in ((Sender.SERVICE, b"\x02"), (Sender.VEHICLE, b"\x01")):
        bus.offer(0, 0x100, payload, sender)
    assert data(bus.run_until(1_000_000)) == [b"\x02", b"\x01"]


def test_a_newer_frame_replaces_the_one_that_waits_but_not_the_one_on_the_wire():
    bus = VirtualBus(WIRE)
    for time_ns, payload in ((0, b"\x01"), (10_000, b"\x02"), (20_000, b"\x03")):
        bus.offer(time_ns, 0x100, payload, Sender.VEHICLE)
    assert data(bus.run_until(1_000_000)) == [b"\x01", b"\x03"]


def test_a_second_mailbox_keeps_a_duplicate():
    bus = VirtualBus(WIRE)
    for mailbox in (0, 1):
        bus.offer(0, 0x100, b"\x01", Sender.VEHICLE, mailbox)
    assert data(bus.run_until(1_000_000)) == [b"\x01", b"\x01"]


def test_cutting_time_into_pieces_changes_nothing():
    def run(instants):
        bus = VirtualBus(msgspec.structs.replace(WIRE, background_load=0.4, loss_ratio=0.1))
        arrived = []
        for index in range(200):
            bus.offer(index * 500_000, 0x100 + index % 7, bytes(8), Sender.VEHICLE)
        for instant in instants:
            arrived += bus.run_until(instant)
        return list(zip((d.time_ns for d in arrived), ids(arrived), data(arrived), strict=True))

    assert run([120_000_000]) == run(range(0, 120_000_001, 37_000))


def test_background_load_takes_its_share():
    alone, busy = (VirtualBus(BusTiming(background_load=load)) for load in (0.0, 0.6))
    for bus in (alone, busy):
        for index in range(2000):
            bus.offer(index * 1_000_000, 0x400, bytes(8), Sender.VEHICLE)
    late = [
        np.mean([d.time_ns % 1_000_000 for d in bus.run_until(2_100_000_000)])
        for bus in (alone, busy)
    ]
    assert late[1] > 1.3 * late[0]
    assert len(busy.run_until(3_000_000_000)) == 0


OFFERS = st.lists(
    st.tuples(st.integers(0, 5_000_000), st.integers(0, 0x7FF), st.binary(max_size=8)),
    min_size=1,
    max_size=30,
    unique_by=lambda offer: offer[1],
)


@given(OFFERS)
def test_the_wire_carries_one_frame_at_a_time_and_is_never_idle_while_one_waits(offers):
    bus, waiting = VirtualBus(WIRE), []
    for time_ns, frame_id, data in sorted(offers, key=lambda offer: offer[0]):
        bus.offer(time_ns, frame_id, data, Sender.VEHICLE)
        waiting.append((time_ns, frame_id, data))
    free_ns = 0
    for delivery in bus.run_until(1_000_000_000):
        end_ns, frame = delivery.time_ns, delivery.frame
        start_ns = end_ns - frame_bits(frame.frame_id, frame.data) * BIT_NS
        assert start_ns == max(free_ns, min(offer[0] for offer in waiting))
        there = [offer[1] for offer in waiting if offer[0] <= start_ns]
        assert frame.frame_id == min(there)
        sent = (frame.frame_id, frame.data)
        waiting.remove(next(offer for offer in waiting if offer[1:] == sent))
        free_ns = end_ns
    assert waiting == []


def test_lost_frames_reach_nobody():
    bus = VirtualBus(BusTiming(bitrate=0, loss_ratio=0.25))
    for index in range(4000):
        bus.offer(index, 0x100, b"", Sender.VEHICLE)
    assert len(bus.run_until(4000)) == pytest.approx(3000, abs=100)
