"""The counter's verdicts; the CRC itself is checked by the golden bytes."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tcs_hil.canbus.e2e import Checker, E2ESpec, E2EStatus, Protector

SPEC = E2ESpec(data_ids=bytes(range(16)), max_delta_counter=10)


def frames(count, spec=SPEC, length=8):
    protector, sent = Protector(spec), []
    for _ in range(count):
        payload = bytearray(length)
        protector.protect(payload)
        sent.append(bytes(payload))
    return sent


def verdicts(payloads, spec=SPEC):
    checker = Checker(spec)
    return [checker.check(payload) for payload in payloads]


def test_the_first_frame_is_good_whatever_its_counter():
    assert verdicts(frames(7)[6:]) == [E2EStatus.OK]


def test_an_unbroken_row_is_good_across_the_wrap_of_the_counter():
    assert set(verdicts(frames(40))) == {E2EStatus.OK}


def test_the_counter_runs_from_1_to_15_and_on_to_0():
    assert [f[1] & 0x0F for f in frames(17)] == [*range(1, 16), 0, 1]


def test_the_counter_leaves_the_high_nibble_alone():
    payload = bytearray([0, 0xA0, 0, 0])
    protector = Protector(SPEC)
    for _ in range(16):
        payload[1] &= 0xF0
        protector.protect(payload)
        assert payload[1] & 0xF0 == 0xA0


def test_a_frame_seen_twice_is_repeated():
    first, second = frames(2)
    assert verdicts([first, first, second]) == [E2EStatus.OK, E2EStatus.REPEATED, E2EStatus.OK]


@pytest.mark.parametrize(
    ("lost", "verdict"), [(0, E2EStatus.OK), (9, E2EStatus.OK), (10, E2EStatus.WRONG_SEQUENCE)]
)
def test_as_many_frames_may_be_lost_as_the_window_allows(lost, verdict):
    sent = frames(lost + 2)
    assert verdicts([sent[0], sent[-1]])[-1] is verdict


def test_after_a_jump_the_next_frame_in_order_is_good():
    sent = frames(14)
    assert verdicts([sent[0], sent[12], sent[13]]) == [
        E2EStatus.OK,
        E2EStatus.WRONG_SEQUENCE,
        E2EStatus.OK,
    ]


@pytest.mark.parametrize("counter", range(16))
def test_a_sender_that_starts_anew_costs_one_frame_at_most(counter):
    before, after = frames(counter + 1), frames(20)
    assert set(verdicts(before + after)[counter + 2 :]) == {E2EStatus.OK}


def test_a_bad_frame_does_not_hide_how_far_the_counter_has_moved():
    sent = frames(12)
    assert verdicts([sent[0], bytes(8), sent[11]])[-1] is E2EStatus.WRONG_SEQUENCE


def test_a_frame_of_another_message_is_an_error():
    stranger = E2ESpec(data_ids=bytes(range(100, 116)), max_delta_counter=10)
    assert verdicts(frames(1, stranger)) == [E2EStatus.ERROR]


def test_a_bad_frame_leaves_the_sequence_alone():
    first, second = frames(2)
    assert verdicts([first, bytes(8), second])[1:] == [E2EStatus.ERROR, E2EStatus.OK]


@given(
    counter=st.integers(0, 15),
    bits=st.integers(1, 2**64 - 1).filter(lambda n: n.bit_count() <= 3),
)
def test_up_to_three_flipped_bits_are_always_noticed(counter, bits):
    payload = frames(counter + 1)[counter]
    broken = (int.from_bytes(payload, "little") ^ bits).to_bytes(8, "little")
    # Bits of the counter change the data id too, so 3 there are the CRC's to catch by chance.
    if broken[1] & 0x0F == payload[1] & 0x0F:
        assert verdicts([broken]) == [E2EStatus.ERROR]
