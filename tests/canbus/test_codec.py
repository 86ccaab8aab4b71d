"""The compiled codec against cantools, and what cantools leaves open."""

from __future__ import annotations

import math
from dataclasses import replace

import cantools
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tcs_hil.canbus.codec import compile_codec
from tcs_hil.canbus.contract import CONTRACT
from tcs_hil.canbus.database import DBC_ENCODING, load_database, signal_spec

DATABASE = load_database()
REFERENCE = cantools.database.load_file("dbc/tcs.dbc", encoding=DBC_ENCODING)
NAMES = [contract.name for contract in CONTRACT]


def reference_payload(message, values):
    """Encode with cantools; whatever is not among ``values`` stays raw 0."""
    rest = {s.name: s.offset for s in message.signals if s.name not in values}
    return message.encode({**values, **rest}, strict=False)


@pytest.mark.parametrize("name", NAMES)
@given(data=st.data())
def test_decoding_agrees_with_cantools_to_the_last_bit(name, data):
    spec, message = DATABASE.messages[name], REFERENCE.get_message_by_name(name)
    payload = data.draw(st.binary(min_size=spec.length, max_size=spec.length))
    expected = message.decode(payload, decode_choices=False)
    assert spec.codec.decode(payload) == tuple(expected[s.name] for s in spec.signals)


@pytest.mark.parametrize("name", NAMES)
@given(data=st.data())
def test_encoding_agrees_with_cantools_within_the_range(name, data):
    spec, message = DATABASE.messages[name], REFERENCE.get_message_by_name(name)
    values = [data.draw(st.floats(s.minimum, s.maximum)) for s in spec.signals]
    by_name = {s.name: value for s, value in zip(spec.signals, values, strict=True)}
    assert bytes(spec.codec.encode(*values)) == reference_payload(message, by_name)


@pytest.mark.parametrize("name", NAMES)
@given(data=st.data())
def test_what_is_decoded_encodes_to_the_same_bits(name, data):
    spec = DATABASE.messages[name]
    raw = [data.draw(st.integers(*s.raw_range)) for s in spec.signals]
    values = [r * s.scale + s.offset for r, s in zip(raw, spec.signals, strict=True)]
    decoded = spec.codec.decode(bytes(spec.codec.encode(*values)))
    assert decoded == tuple(values)


@pytest.mark.parametrize("name", NAMES)
@given(value=st.floats())
def test_any_float_is_sent_as_a_value_within_the_range(name, value):
    spec = DATABASE.messages[name]
    decoded = spec.codec.decode(bytes(spec.codec.encode(*[value] * len(spec.signals))))
    for signal, got in zip(spec.signals, decoded, strict=True):
        assert signal.minimum - 1e-9 <= got <= signal.maximum + 1e-9
        if signal.minimum <= value <= signal.maximum:
            assert abs(got - value) <= signal.scale * 0.5000001


def sent_and_back(signal, value):
    codec = compile_codec("Test", 8, [signal])
    return codec.decode(bytes(codec.encode(value)))[0]


def test_a_value_beyond_the_range_saturates_like_a_sensor():
    accel = DATABASE.messages["WheelSpeedsRear"].signal("VehicleAccelX")
    assert sent_and_back(accel, 1000.0) == pytest.approx(32.767)
    assert sent_and_back(accel, -math.inf) == pytest.approx(-32.768)


def test_a_range_narrower_than_the_bits_saturates_at_the_range():
    accel = DATABASE.messages["WheelSpeedsRear"].signal("VehicleAccelX")
    narrow = replace(accel, minimum=-2.0, maximum=3.0)
    assert sent_and_back(narrow, 1000.0) == pytest.approx(3.0)
    assert sent_and_back(narrow, -1000.0) == pytest.approx(-2.0)


def test_nan_is_sent_as_the_value_nearest_to_zero():
    motor = DATABASE.messages["MotorState"]
    assert sent_and_back(motor.signal("MotorSpeedL"), math.nan) == 0.0
    assert sent_and_back(replace(motor.signal("MotorSpeedL"), minimum=5.0), math.nan) == 5.0


MOTOROLA_DBC = """
VERSION ""
NS_ :
BS_:
BU_: A B
BO_ 1 Mixed: 8 A
 SG_ High : 3|12@0- (0.5,-3) [-1027|1020.5] "-" B
 SG_ Middle : 23|16@0+ (0.01,0) [0|655.35] "-" B
 SG_ Shifted : 39|4@0+ (1,1) [1|16] "-" B
 SG_ Doubled : 32|4@1+ (2,0) [0|30] "-" B
 SG_ Low : 40|10@1- (0.25,0) [-128|127.75] "-" B
"""


def mixed_message(byte_orders):
    """Message with its signals of the given byte orders, by cantools and by us."""
    parsed = cantools.database.load_string(MOTOROLA_DBC, "dbc")
    message = parsed.get_message_by_name("Mixed")
    signals = [signal_spec(message, s) for s in message.signals if s.byte_order in byte_orders]
    return message, signals, compile_codec("Mixed", message.length, signals)


@pytest.mark.parametrize("byte_orders", [["big_endian"], ["big_endian", "little_endian"]])
@given(data=st.data())
def test_motorola_signals_agree_with_cantools(byte_orders, data):
    message, signals, codec = mixed_message(byte_orders)
    values = [data.draw(st.floats(s.minimum, s.maximum)) for s in signals]
    by_name = {s.name: value for s, value in zip(signals, values, strict=True)}
    payload = bytes(codec.encode(*values))
    assert payload == reference_payload(message, by_name)
    expected = message.decode(payload)
    assert codec.decode(payload) == tuple(expected[s.name] for s in signals)
