"""What the service could not run with is said in sentences."""

from __future__ import annotations

from typing import Any

import pytest

from tcs_hil.errors import ConfigError
from tcs_hil.service.bus_end import bus_end

from .examined import ERROR, GONE, config_with, found
from .makers import AURELIS, MONTANE, QUENDAL, Maker

FAULTS: dict[str, tuple[Maker, dict[str, Any], str, str]] = {
    "no such message": (
        MONTANE,
        {"map__inputs__wheel_speed_fl__signal": "ABS_WhlSpd_Front.WhlSpd_FL"},
        "inputs.wheel_speed_fl",
        "the DBC has no message ABS_WhlSpd_Front; near it: ABS_WhlSpd_Frnt",
    ),
    "no such signal": (
        MONTANE,
        {"map__inputs__wheel_speed_fl__signal": "ABS_WhlSpd_Frnt.whlspd_lf"},
        "inputs.wheel_speed_fl",
        "message ABS_WhlSpd_Frnt has no signal whlspd_lf; near it: WhlSpd_F",
    ),
    "a wheel is missing": (
        MONTANE,
        {"map__inputs__wheel_speed_rr": GONE},
        "inputs.wheel_speed_rr",
        "is missing; slip needs the speed of every wheel",
    ),
    "half of the motors": (
        MONTANE,
        {"map__inputs__motor_torque_left": GONE},
        "inputs.motor_torque_left",
        "is missing; map speed and torque of both motors, or none of them",
    ),
    "no request": (
        MONTANE,
        {"map__inputs__driver_torque_axle": GONE},
        "inputs.driver_torque_left",
        "is missing; map driver_torque_left and driver_torque_right, or driver_torque_axle",
    ),
    "two kinds of request": (
        MONTANE,
        {"map__inputs__driver_torque_left": {"signal": "VCU_Demand.VCU_AxleTrq"}},
        "inputs.driver_torque_axle",
        "stands beside a left or a right one",
    ),
    "one limit only": (
        MONTANE,
        {"map__limits__right": GONE},
        "limits.right",
        "is missing; map left and right, or axle",
    ),
    "a unit of another kind": (
        MONTANE,
        {"map__inputs__wheel_speed_fl__unit": "Nm"},
        "inputs.wheel_speed_fl",
        'the map says "Nm"; give unit as one of rad/s, rpm',
    ),
    "a unit nobody knows": (
        QUENDAL,
        {"map__inputs__accel_x": {"signal": "WHL_DATA.WHL_Temp"}},
        "inputs.accel_x",
        'the DBC, for WHL_DATA.WHL_Temp, says "degC"; give unit as one of m/s2, g',
    ),
    "a factor of nothing": (
        MONTANE,
        {"map__inputs__wheel_speed_fl__factor": 0.0},
        "inputs.wheel_speed_fl",
        "a factor of 0",
    ),
    "an invalid code too wide": (
        AURELIS,
        {"map__inputs__wheel_speed_fl__invalid_raw": [65536]},
        "inputs.wheel_speed_fl.invalid_raw",
        "raw value 65536 does not fit the 16 bits of WheelFrLe_n (0 to 65535)",
    ),
    "a range the wrong way round": (
        AURELIS,
        {"map__inputs__wheel_speed_fl__valid_range": [10.0, 0.0]},
        "inputs.wheel_speed_fl.valid_range",
        "the range 10 to 0 is empty",
    ),
    "a flag on another page": (
        QUENDAL,
        {"map__inputs__wheel_speed_fl__valid_when": {"signal": "WHL_Temp"}},
        "inputs.wheel_speed_fl.valid_when",
        "WHL_Temp is not in every frame",
    ),
    "no cycle time": (
        QUENDAL,
        {"map__messages__DRV_REQ__cycle_ms": GONE},
        "messages.DRV_REQ",
        "the DBC gives no cycle time of DRV_REQ; give cycle_ms",
    ),
    "a checksum that cannot fit": (
        MONTANE,
        {"map__messages__INV_State__checksum__signal": "INV_RollCnt"},
        "messages.INV_State.checksum",
        "sum-complement cannot fit INV_RollCnt, which is 4 bits",
    ),
    "a counter that cannot count so far": (
        QUENDAL,
        {"map__messages__WHL_DATA__counter__highest": 16},
        "messages.WHL_DATA.counter",
        "WHL_CntLow, WHL_CntHigh can count to 15 only",
    ),
    "a profile and a counter": (
        AURELIS,
        {"map__messages__EscWheelFr__counter": {"signals": ["EscWheelFr_SQC"]}},
        "messages.EscWheelFr",
        "an E2E profile brings its own counter and checksum",
    ),
    "a profile where a signal lies": (
        AURELIS,
        {"map__messages__EduMotor": {"e2e": {"profile": "P01", "data_id": 1}}},
        "messages.EduMotor",
        "EduMotor.MotLe_n lies on bits of the counter, of the checksum or of another signal",
    ),
    "two signals in one place": (
        MONTANE,
        {"map__limits__right__signal": "TCS_TrqLim.TCS_LimL"},
        "messages.TCS_TrqLim",
        "TCS_TrqLim.TCS_LimL lies on bits of",
    ),
    "no limit among the torques": (
        MONTANE,
        {"map__limits__left__no_limit_raw": 1000},
        "limits.left.no_limit_raw",
        "raw value 1000 is a torque; it must be an end of the range",
    ),
    "limits against the torque": (
        MONTANE,
        {"map__limits__left__factor": -1.0},
        "limits.left",
        "the values of TCS_LimL must grow with the torque",
    ),
    "a limit that can never be lifted": (
        AURELIS,
        {"map__limits__left__at": "motor", "vehicle__motor_torque_max_nm": 4000.0},
        "limits.left",
        "can say 3000 Nm at most, less than the motor's 4000 Nm",
    ),
    "a limit on another page": (
        QUENDAL,
        {"map__messages__TCU_LIM__fixed": {}},
        "limits.left",
        "TCU_LIM.TCU_MaxL is multiplexed; fix TCU_Page to 1 under messages.TCU_LIM.fixed",
    ),
    "a fixed value too large": (
        MONTANE,
        {"map__messages__TCS_TrqLim__fixed__TCS_Mode": 4},
        "messages.TCS_TrqLim.fixed",
        "raw value 4 does not fit the 2 bits of TCS_Mode (0 to 3)",
    ),
    "read and written": (
        MONTANE,
        {
            "map__limits__left": {"signal": "INV_State.INV_TrqL"},
            "map__limits__right": {"signal": "INV_State.INV_TrqR"},
        },
        "messages.INV_State",
        "would be sent with the identifier 0x140, which is also read",
    ),
    "slower than the supervisor waits": (
        MONTANE,
        {"map__messages__ABS_WhlSpd_Frnt__cycle_ms": 50},
        "messages.ABS_WhlSpd_Frnt",
        "brings its values every 50 ms: the supervisor would give them up",
    ),
}


@pytest.mark.parametrize("name", FAULTS)
def test_what_the_service_could_not_run_with_is_an_error(name: str) -> None:
    maker, changes, key, sentence = FAULTS[name]
    first = next(f for f in found(maker, **changes) if f.weight is ERROR)
    assert (first.key, first.sentence[: len(sentence)]) == (key, sentence)
    with pytest.raises(ConfigError, match=f"map.{key}: "):
        bus_end(config_with(maker, **changes))
