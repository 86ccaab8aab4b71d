"""Everything ``tcs-hil run`` can be told, from one TOML file and the command line."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Literal

import msgspec
from msgspec import Meta
from msgspec.structs import replace

from tcs_hil.canbus.mapping.settings import SignalMap
from tcs_hil.config import FilePath, Name, read_toml
from tcs_hil.control.settings import ControlSettings
from tcs_hil.model.vehicle import Vehicle
from tcs_hil.runtime.realtime import FIFO_PRIORITY
from tcs_hil.safety_settings import GateSettings, SupervisorSettings
from tcs_hil.signals import ControllerKind

ControllerName = Literal["off", "pi", "kmpc", "nmpc"]
TriggerName = Literal["timer", "frame", "lockstep"]


class BusSettings(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Where the frames are, in python-can's terms; ``auto`` is explained by ``open_bus``."""

    interface: Name = "auto"
    channel: Name = "vcan0"
    bitrate: Annotated[int, Meta(gt=0, le=1_000_000)] | None = None
    database: FilePath | None = None


class TickSettings(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """What starts a tick, and what the operating system is asked for to start it on time.

    ``timer`` is the 2 ms grid shifted by ``phase_us``, ``frame`` the rear wheel
    speeds, ``lockstep`` a bench.  The timer may watch the clock for the last
    ``spin_us`` instead of sleeping.  ``priority`` is that of SCHED_FIFO; ``cpu``
    the core to stay on.
    """

    trigger: TriggerName = "timer"
    phase_us: Annotated[int, Meta(ge=0, lt=20_000)] = 0
    spin_us: Annotated[int, Meta(ge=0, le=1_000)] = 0
    priority: Annotated[int, Meta(ge=1, le=99)] = FIFO_PRIORITY
    cpu: Annotated[int, Meta(ge=0, le=4095)] | None = None


class RecorderSettings(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Flight recording: none without a path; the newest ``ticks`` are kept."""

    path: FilePath | None = None
    ticks: Annotated[int, Meta(ge=1, le=10_000_000)] = 100_000


class ServiceConfig(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Everything ``tcs-hil run`` can be told.

    With a ``map`` the database is another car's DBC.
    """

    controller: ControllerName = "kmpc"
    model: FilePath | None = None
    bus: BusSettings = BusSettings()
    tick: TickSettings = TickSettings()
    recorder: RecorderSettings = RecorderSettings()
    control: ControlSettings = ControlSettings()
    vehicle: Vehicle = Vehicle()
    supervisor: SupervisorSettings = SupervisorSettings()
    gate: GateSettings = GateSettings()
    map: SignalMap | None = None

    def beside(self, folder: Path) -> ServiceConfig:
        """The same configuration with its paths absolute, relative ones taken from ``folder``."""

        def absolute(path: str | None) -> str | None:
            return None if path is None else str((folder / path).absolute())

        return replace(
            self,
            model=absolute(self.model),
            bus=replace(self.bus, database=absolute(self.bus.database)),
            recorder=replace(self.recorder, path=absolute(self.recorder.path)),
        )

    @property
    def kind(self) -> ControllerKind:
        """The control law as it is named on the bus."""
        return ControllerKind[self.controller.upper()]


def read_service(path: Path) -> ServiceConfig:
    """Read a configuration file; a relative path in it is relative to the file.

    Raises:
        ConfigError: the file is missing, or something in it does not fit; both are named.
    """
    return read_toml(path, ServiceConfig).beside(path.parent)
