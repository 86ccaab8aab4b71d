"""What the service and the vehicle say to each other, by name.

The DBC owns every identifier, bit and scale; this file says only which messages
and signals must be there and in which order the code passes their values.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import IntEnum

from tcs_hil.canbus.bench_control import BenchFault
from tcs_hil.signals import ControllerKind, TcsState

TCS = "TCS"
VEHICLE = "VEHICLE"
BENCH = "BENCH"


@dataclass(frozen=True, slots=True)
class MessageContract:
    """One message the code relies on.

    ``signals`` leaves out the CRC and the counter, which belong to the E2E
    protection and are called like the message with ``Crc`` and ``Counter`` added.
    """

    name: str
    sender: str
    signals: tuple[str, ...]
    cyclic: bool = True
    protected: bool = True

    @property
    def receiver(self) -> str:
        """The node it is meant for: the vehicle hears everybody, the service the vehicle."""
        return TCS if self.sender == VEHICLE else VEHICLE


CONTRACT: tuple[MessageContract, ...] = (
    MessageContract(
        "TorqueLimit", TCS, ("TorqueLimitL", "TorqueLimitR", "TcsActiveL", "TcsActiveR", "TcsState")
    ),
    MessageContract("DriverRequest", VEHICLE, ("DriverTorqueRequestL", "DriverTorqueRequestR")),
    MessageContract(
        "MotorState", VEHICLE, ("MotorSpeedL", "MotorSpeedR", "MotorTorqueL", "MotorTorqueR")
    ),
    MessageContract(
        "WheelSpeedsFront",
        VEHICLE,
        ("WheelSpeedFL", "WheelSpeedFR", "WheelSpeedFLValid", "WheelSpeedFRValid"),
    ),
    MessageContract(
        "WheelSpeedsRear",
        VEHICLE,
        (
            "WheelSpeedRL",
            "WheelSpeedRR",
            "WheelSpeedRLValid",
            "WheelSpeedRRValid",
            "VehicleAccelX",
            "VehicleAccelXValid",
        ),
    ),
    MessageContract(
        "TcsStatus",
        TCS,
        ("SlipL", "SlipR", "SlipReference", "TcsController", "TcsFaultCode", "TickOverruns"),
        protected=False,
    ),
    MessageContract(
        "TcsEstimates",
        TCS,
        ("MuEstimateL", "MuEstimateR", "MuConfidenceL", "MuConfidenceR", "DelayEstimate"),
        protected=False,
    ),
    MessageContract("BenchTick", VEHICLE, ("BenchTickNumber",), cyclic=False, protected=False),
    MessageContract("BenchTickDone", TCS, ("BenchTickAnswered",), cyclic=False, protected=False),
    MessageContract(
        "BenchControl", BENCH, ("BenchThrottle", "BenchMu", "BenchFault"), cyclic=False
    ),
)

VALUE_TABLES: dict[str, type[IntEnum]] = {
    "TcsState": TcsState,
    "TcsController": ControllerKind,
    "BenchFault": BenchFault,
}
"""Signals whose value table must read like the enumeration."""

NO_LIMIT_LABEL = "no limit"
NO_LIMIT_SIGNALS = ("TorqueLimitL", "TorqueLimitR")
AS_IN_SCENARIO_LABEL = "as in scenario"

HIGHEST_RAW_LABELS = dict.fromkeys(NO_LIMIT_SIGNALS, NO_LIMIT_LABEL) | dict.fromkeys(
    ("BenchThrottle", "BenchMu"), AS_IN_SCENARIO_LABEL
)
"""Signals whose highest raw value is no quantity but means what the label says."""

WHEEL_SPEEDS = ("WheelSpeedFL", "WheelSpeedFR", "WheelSpeedRL", "WheelSpeedRR")
WHEEL_SPEED_RESOLUTION_RADPS = 0.01
"""Coarser steps than this show up as chatter of the slip at low speed."""
