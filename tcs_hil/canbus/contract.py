"""What the service and the vehicle say to each other, by name.

The DBC owns every identifier, bit and scale; this file says only which messages
and signals must be there and in which order the code passes their values.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import IntEnum

from tcs_hil.signals import ControllerKind, TcsState

TCS = "TCS"
VEHICLE = "VEHICLE"


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
        """The other of the two nodes."""
        return VEHICLE if self.sender == TCS else TCS


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
)

VALUE_TABLES: dict[str, type[IntEnum]] = {"TcsState": TcsState, "TcsController": ControllerKind}
"""Signals whose value table must read like the enumeration."""

NO_LIMIT_LABEL = "no limit"
NO_LIMIT_SIGNALS = ("TorqueLimitL", "TorqueLimitR")

WHEEL_SPEEDS = ("WheelSpeedFL", "WheelSpeedFR", "WheelSpeedRL", "WheelSpeedRR")
WHEEL_SPEED_RESOLUTION_RADPS = 0.01
"""Coarser steps than this show up as chatter of the slip at low speed."""
