"""A DBC is refused at start, with the message and the signal at fault named."""

from __future__ import annotations

from pathlib import Path

import pytest

from tcs_hil.canbus.bus_load import bus_load_ratio, worst_case_bits
from tcs_hil.canbus.database import DBC_ENCODING, load_database
from tcs_hil.canbus.e2e_state import Threshold, WindowSpec
from tcs_hil.errors import DatabaseError

GOOD = Path("dbc/tcs.dbc").read_text(encoding=DBC_ENCODING)


def refusal(tmp_path, text):
    path = tmp_path / "car.dbc"
    path.write_text(text, encoding=DBC_ENCODING)
    with pytest.raises(DatabaseError) as caught:
        load_database(path)
    sentence = str(caught.value)
    assert sentence.startswith(str(path))
    assert "\n" not in sentence
    return sentence


def test_the_packaged_database_is_the_one_in_dbc():
    assert load_database().messages.keys() == load_database(Path("dbc/tcs.dbc")).messages.keys()


def test_a_message_carries_its_frame_cycle_and_protection():
    rear = load_database().messages["WheelSpeedsRear"]
    assert (rear.frame_id, rear.length, rear.cycle_ns) == (0xA2, 8, 2_000_000)
    assert rear.e2e.data_ids == bytes.fromhex("A24FE3087C95D61B32A95E80C4176DFA")
    assert rear.e2e.max_delta_counter == 10
    assert load_database().messages["TcsStatus"].e2e is None


def test_a_message_carries_the_window_of_its_state_machine():
    messages = load_database().messages
    ten = Threshold(min_ok=10, max_error=10)
    assert messages["WheelSpeedsRear"].window == WindowSpec(
        24, Threshold(min_ok=5, max_error=2), Threshold(min_ok=5, max_error=10), ten
    )
    # The driver's request comes every 10 ms: with as many frames the car would wait for long.
    assert messages["DriverRequest"].window == WindowSpec(
        24,
        Threshold(min_ok=1, max_error=2),
        Threshold(min_ok=1, max_error=10),
        Threshold(min_ok=2, max_error=10),
    )


def test_the_two_nodes_share_out_the_identifiers():
    database = load_database()
    assert database.frame_ids_of("TCS") == {0x90, 0x300, 0x301, 0x7F1}
    assert database.frame_ids_of("VEHICLE") == {0x98, 0xA0, 0xA1, 0xA2, 0x7F0}


REFUSED = {
    "a message is missing": (
        "BO_ 160 MotorState:",
        "BO_ 160 EngineState:",
        "message MotorState is missing",
    ),
    "a signal is missing": (
        "SG_ WheelSpeedRL :",
        "SG_ WheelSpeedHL :",
        "signal WheelSpeedRL of message WheelSpeedsRear is missing",
    ),
    "the unit is missing": (
        '(0.01,0) [0|655.35] "rad/s"  TCS\n SG_ WheelSpeedFR',
        '(0.01,0) [0|655.35] ""  TCS\n SG_ WheelSpeedFR',
        "signal WheelSpeedFL of message WheelSpeedsFront has no unit",
    ),
    "the comment is missing": (
        'CM_ SG_ 768 SlipL "Estimated slip ratio of the front left wheel, '
        "saturated to the signal's range\";",
        "",
        "signal SlipL of message TcsStatus has no comment",
    ),
    "the receiver is missing": (
        'SG_ TcsFaultCode : 40|8@1+ (1,0) [0|255] "-"  VEHICLE',
        'SG_ TcsFaultCode : 40|8@1+ (1,0) [0|255] "-"  Vector__XXX',
        "signal TcsFaultCode of message TcsStatus must be received by node VEHICLE",
    ),
    "the range is missing": (
        "[-32.768|32.767]",
        "[0|0]",
        "signal VehicleAccelX of message WheelSpeedsRear has no range",
    ),
    "the factor is negative": (
        "(0.001,0) [-32.768",
        "(-0.001,0) [-32.768",
        "signal VehicleAccelX of message WheelSpeedsRear must have a positive factor",
    ),
    "wheel speeds are coarse": (
        'SG_ WheelSpeedFR : 32|16@1+ (0.01,0) [0|655.35] "rad/s"',
        'SG_ WheelSpeedFR : 32|16@1+ (0.02,0) [0|1310.7] "rad/s"',
        "signal WheelSpeedFR of message WheelSpeedsFront has steps of 0.02 rad/s",
    ),
    "the signal is a float": (
        "BA_DEF_  ",
        "SIG_VALTYPE_ 2032 BenchTickNumber : 1;\nBA_DEF_  ",
        "signal BenchTickNumber of message BenchTick is a floating-point signal",
    ),
    "the message is multiplexed": (
        "SG_ TcsController : 34|3",
        "SG_ TcsController M : 34|3",
        "message TcsStatus is multiplexed",
    ),
    "the identifier is extended": (
        "BO_ 2032 BenchTick:",
        "BO_ 2147485680 BenchTick:",
        "message BenchTick has an extended identifier",
    ),
    "two messages share an identifier": (
        "BO_ 2033 BenchTickDone:",
        "BO_ 2032 BenchTickDone:",
        "messages BenchTick and BenchTickDone share the identifier 0x7f0",
    ),
    "the frame is CAN FD": (
        "BO_ 2032 BenchTick: 4",
        "BO_ 2032 BenchTick: 12",
        "message BenchTick is longer than the 8 bytes",
    ),
    "the sender is another node": (
        "BO_ 152 DriverRequest: 5 VEHICLE",
        "BO_ 152 DriverRequest: 5 TCS",
        "message DriverRequest must be sent by node VEHICLE",
    ),
    "the cycle time is missing": (
        'BA_ "GenMsgCycleTime" BO_ 768 20;',
        "",
        "message TcsStatus has no cycle time",
    ),
    "the state table differs": (
        'VAL_ 144 TcsState 5 "FAULT"',
        'VAL_ 144 TcsState 5 "ERROR"',
        "signal TcsState of message TorqueLimit needs the value table 0 OFF, 1 INIT",
    ),
    "no value means no limit": (
        "VAL_ 144 TorqueLimitL 16383",
        "VAL_ 144 TorqueLimitL 16382",
        "signal TorqueLimitL of message TorqueLimit must call its highest raw value",
    ),
    "the profile is missing": (
        'BA_ "E2EProfile" BO_ 160 1;',
        "",
        "message MotorState needs the attribute E2EProfile P02",
    ),
    "the data ids are short": (
        "A05B19D4723EC80756FD9361B48E2CEA",
        "A05B19D4723EC80756FD9361B48E2C",
        "message MotorState needs 16 bytes in hex as attribute E2EDataIdList",
    ),
    "the data ids are no hex": (
        "A05B19D4723EC80756FD9361B48E2CEA",
        "XYZ",
        "message MotorState needs 16 bytes in hex as attribute E2EDataIdList",
    ),
    "the counter window is missing": (
        'BA_ "E2EMaxDeltaCounter" BO_ 161 10;',
        "",
        "message WheelSpeedsFront needs the attribute E2EMaxDeltaCounter in 1 to 14",
    ),
    "the window is unknown": (
        'BA_DEF_ BO_  "E2EWindowSize" INT 0 64;\n',
        "",
        "message TorqueLimit needs the attribute E2EWindowSize in 1 to 64",
    ),
    "the window is too long": (
        'BA_DEF_DEF_  "E2EWindowSize" 24;',
        'BA_DEF_DEF_  "E2EWindowSize" 65;',
        "message TorqueLimit needs the attribute E2EWindowSize in 1 to 64",
    ),
    "no good frame at all makes a message valid": (
        'BA_ "E2EMinOkInit" BO_ 152 1;',
        'BA_ "E2EMinOkInit" BO_ 152 0;',
        "message DriverRequest needs the attribute E2EMinOkInit in 1 to 24",
    ),
    "more errors are tolerated than there are frames": (
        'BA_DEF_DEF_  "E2EMaxErrorValid" 10;',
        'BA_DEF_DEF_  "E2EMaxErrorValid" 25;',
        "message TorqueLimit needs the attribute E2EMaxErrorValid in 0 to 24",
    ),
    "valid does not outlast init": (
        'BA_ "E2EMinOkValid" BO_ 152 1;',
        'BA_ "E2EMinOkValid" BO_ 152 2;',
        "message DriverRequest has an E2EMinOkInit below its E2EMinOkValid",
    ),
    "valid does not outlast invalid": (
        'BA_DEF_DEF_  "E2EMaxErrorInvalid" 10;',
        'BA_DEF_DEF_  "E2EMaxErrorInvalid" 11;',
        "message TorqueLimit has an E2EMaxErrorInvalid above its E2EMaxErrorValid",
    ),
    "the crc is elsewhere": (
        "SG_ DriverRequestCrc : 0|8@1+",
        "SG_ DriverRequestCrc : 0|7@1+",
        "signal DriverRequestCrc of message DriverRequest must fill byte 0",
    ),
    "the counter is elsewhere": (
        "SG_ DriverRequestCounter : 8|4@1+",
        "SG_ DriverRequestCounter : 12|4@1+",
        "signal DriverRequestCounter of message DriverRequest must fill the low nibble of byte 1",
    ),
    "the counter is missing": (
        "SG_ DriverRequestCounter :",
        "SG_ DriverRequestCount :",
        "signal DriverRequestCounter of message DriverRequest is missing",
    ),
    "signals overlap": (
        "SG_ SlipR : 12|12",
        "SG_ SlipR : 8|12",
        "is not a valid DBC: The signals SlipR and SlipL are overlapping in message TcsStatus",
    ),
    "it is no DBC": (GOOD, "VERSION 1 2 3", "is not a valid DBC"),
}


@pytest.mark.parametrize("case", REFUSED)
def test_a_database_is_refused_where(tmp_path, case):
    good, bad, expected = REFUSED[case]
    assert good in GOOD
    text = GOOD.replace(good, bad, 1)
    if case in RENAMED:
        text = text.replace(*RENAMED[case])
    assert expected in refusal(tmp_path, text)


# Renaming a message or signal takes its comments along, and an attribute its default.
RENAMED = {
    "a signal is missing": (" WheelSpeedRL ", " WheelSpeedHL "),
    "the counter is missing": (" DriverRequestCounter ", " DriverRequestCount "),
    "the identifier is extended": (" 2032 ", " 2147485680 "),
    "the window is unknown": ('BA_DEF_DEF_  "E2EWindowSize" 24;\n', ""),
    "two messages share an identifier": (" 2033 ", " 2032 "),
}


def test_a_file_that_is_not_there_is_named(tmp_path):
    with pytest.raises(
        DatabaseError, match=r"nowhere\.dbc: cannot be read \(No such file or directory\)$"
    ):
        load_database(tmp_path / "nowhere.dbc")


@pytest.mark.parametrize("length", [0, 1, 8])
def test_a_frame_takes_the_bits_of_the_textbook(length):
    # Davis et al. 2007: 55 + 10 s bits for an 11-bit identifier and s data bytes.
    assert worst_case_bits(length) == 55 + 10 * length


@pytest.mark.parametrize(("bitrate", "limit"), [(500_000, 0.60), (1_000_000, 0.35)])
def test_the_bus_load_stays_within_the_contract(bitrate, limit):
    assert 0.1 < bus_load_ratio(load_database(), bitrate) < limit


@pytest.mark.parametrize(
    ("was", "becomes", "culprit"),
    [
        ("(0.125,0) [0|511.75]", "(0.125,0) [0|1e400]", "DriverTorqueRequestL"),
        ("(0.125,0) [0|511.75]", "(1e400,0) [0|511.75]", "DriverTorqueRequestL"),
        ('BA_ "E2EProfile" BO_ 152 1;', 'BA_ "E2EProfile" BO_ 152 7;', "DriverRequest"),
    ],
)
def test_numbers_that_make_no_sense_are_refused_by_name(
    tmp_path: Path, was: str, becomes: str, culprit: str
) -> None:
    assert was in GOOD
    assert culprit in refusal(tmp_path, GOOD.replace(was, becomes))
