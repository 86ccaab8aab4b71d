"""The CAN interface in every state it can be found in."""

from __future__ import annotations

import json
from typing import Any

import pytest
from runtime.doctor.machines import FakeMachine

from tcs_hil.runtime.doctor.bus import interface, socketcan
from tcs_hil.runtime.doctor.finding import Finding, Verdict

OK, WARN, FAIL = Verdict.OK, Verdict.WARN, Verdict.FAIL


def seen(channel: str, kind: str, *flags: str, **data: Any) -> Finding:
    link = {"ifname": channel, "flags": flags, "linkinfo": {"info_kind": kind, "info_data": data}}
    return interface(FakeMachine(programs={"ip": json.dumps([{}, link])}), channel)


def can0(state: str = "ERROR-ACTIVE", bitrate: int = 500_000, restart_ms: int = 100) -> Finding:
    timing = {"bitrate": bitrate, "sample_point": "0.875"}
    return seen("can0", "can", "UP", state=state, bittiming=timing, restart_ms=restart_ms)


def test_a_healthy_controller_is_fine() -> None:
    assert can0() == Finding(
        "interface can0", OK, "500000 bit/s, ERROR-ACTIVE, restarts after 100 ms"
    )


@pytest.mark.parametrize(
    ("finding", "verdict", "remedy"),
    [
        (can0("BUS-OFF"), FAIL, "sudo ip link set can0 type can restart"),
        (can0(bitrate=250_000), WARN, "bitrate 500000"),
        (can0("ERROR-PASSIVE"), WARN, "termination"),
        (can0("ERROR-WARNING"), WARN, "bit rate mismatch?"),
        (can0("BUS-OFF"), FAIL, "bit rate mismatch?"),
        (can0(restart_ms=0), WARN, "restart-ms 100"),
        (seen("can0", "can", "NOARP"), FAIL, "set can0 up type can bitrate 500000"),
        (seen("vcan0", "vcan", "NOARP"), FAIL, "sudo ip link set vcan0 up"),
    ],
)
def test_every_trouble_comes_with_what_mends_it(
    finding: Finding, verdict: Verdict, remedy: str
) -> None:
    assert finding.verdict is verdict
    assert remedy in finding.remedy


def test_an_ill_controller_says_whether_it_fails_to_send_or_to_read() -> None:
    data = {"state": "ERROR-PASSIVE", "bittiming": {"bitrate": 500_000}}
    found = seen("can0", "can", "UP", **data, berr_counter={"tx": 3, "rx": 135}).found
    assert found == "500000 bit/s, ERROR-PASSIVE, errors sending 3, receiving 135"


def test_a_virtual_interface_has_no_controller_to_be_ill() -> None:
    assert seen("vcan0", "vcan", "UP", "LOWER_UP").verdict is OK


def test_a_missing_vcan_is_replaced_and_a_missing_can_is_not() -> None:
    assert interface(FakeMachine(), "vcan0").verdict is WARN
    assert interface(FakeMachine(), "can0").verdict is FAIL


def test_a_kernel_without_can_is_told() -> None:
    assert socketcan(FakeMachine(can=True)).verdict is OK
    assert socketcan(FakeMachine(can=False)).remedy == "sudo modprobe can-raw"
