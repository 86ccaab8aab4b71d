"""What the service would run worse with is said with its consequence."""

from __future__ import annotations

from typing import Any

import pytest

from tcs_hil.canbus.mapping.findings import Finding

from .examined import ERROR, GONE, NOTE, WARNING, found
from .makers import MONTANE, QUENDAL, Maker

ADVICE: dict[str, tuple[Maker, dict[str, Any], Finding]] = {
    "the map's unit is not the DBC's": (
        MONTANE,
        {"map__inputs__motor_speed_left__unit": "rad/s"},
        Finding(
            WARNING,
            "inputs.motor_speed_left.unit",
            'says rad/s and the DBC says "1/min" of INV_State.INV_SpdL; the map is taken',
        ),
    ),
    "cycles the supervisor bridges badly": (
        MONTANE,
        {"map__messages__ABS_WhlSpd_Rear__cycle_ms": 10},
        Finding(
            WARNING,
            "messages.ABS_WhlSpd_Rear",
            "brings its values every 10 ms: the supervisor would let no torque rise between two "
            "frames; set supervisor.bridged_cycles to 5 or more",
        ),
    ),
    "pages that take turns": (
        QUENDAL,
        {"map__messages__WHL_DATA__cycle_ms": 2},
        Finding(
            NOTE,
            "messages.WHL_DATA",
            "brings its values every 4 ms: slip is held more loosely than with 2 ms",
        ),
    ),
    "limits that go out slowly": (
        MONTANE,
        {"map__messages__TCS_TrqLim__cycle_ms": 10},
        Finding(
            WARNING,
            "messages.TCS_TrqLim",
            "goes out every 10 ms while the service decides every 2 ms: limits reach the motors "
            "up to 8 ms late",
        ),
    ),
    "coarse steps": (
        MONTANE,
        {"map__inputs__wheel_speed_fl__factor": 10.0},
        Finding(
            WARNING,
            "inputs.wheel_speed_fl",
            "has steps of 0.0874 rad/s: below 2.8 m/s one step is more than 1% of slip",
        ),
    ),
    "a request that stops short of the motor": (
        QUENDAL,
        {"map__inputs__driver_torque_left__full_scale_nm": 200.0},
        Finding(
            WARNING,
            "inputs.driver_torque_left",
            "can ask 209.6 Nm of a motor, which has 250 Nm; limits stop there as well",
        ),
    ),
    "a limit that cannot reach zero": (
        MONTANE,
        {"map__limits__left__offset": 150.0},
        Finding(WARNING, "limits.left", "can hold a motor down to 50 Nm only"),
    ),
    "a counter and a checksum nobody looks at": (
        MONTANE,
        {"map__messages__VCU_Demand": GONE},
        Finding(
            WARNING,
            "messages.VCU_Demand",
            "by name, VCU_AliveCnt and VCU_Chk would be a counter or a checksum; not used",
        ),
    ),
    "a message described for nothing": (
        MONTANE,
        {"map__messages__ABS_Brake": {"cycle_ms": 10}},
        Finding(WARNING, "messages.ABS_Brake", "no signal of this message is mapped"),
    ),
    "a message without protection": (
        MONTANE,
        {},
        Finding(
            NOTE,
            "messages.ABS_LongAcc",
            "nothing protects it: damaged and repeated frames go unnoticed",
        ),
    ),
}


@pytest.mark.parametrize("name", ADVICE)
def test_what_the_service_would_run_worse_with_is_said_with_its_consequence(name: str) -> None:
    maker, changes, expected = ADVICE[name]
    findings = found(maker, **changes)
    assert expected in findings
    assert ERROR not in {finding.weight for finding in findings}


def test_patience_of_the_supervisor_silences_the_warning() -> None:
    slow = {"map__messages__ABS_WhlSpd_Rear__cycle_ms": 10}
    patient = found(MONTANE, **slow, supervisor__bridged_cycles=5)
    assert WARNING not in {finding.weight for finding in patient}
