"""What a run has left, as samples on the plant's time base: zero is when the plant set off."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import can
import numpy as np
from cantools.database.can import Message
from numpy.typing import NDArray

from plant_emulator.scenario import Scenario
from tcs_hil.canbus.database import parse_dbc
from tcs_hil.hil.export.time_base import Parts, TimeBase, align
from tcs_hil.hil.judging.channels import LATENCY, STAGES, Channel, signals
from tcs_hil.hil.logs.bus_log import read_log
from tcs_hil.hil.metrics import Truth
from tcs_hil.hil.run import Mode, RunFiles
from tcs_hil.names import column_names
from tcs_hil.runtime.record import NO_LATENCY
from tcs_hil.runtime.recording import read_info
from tcs_hil.service.settings import ServiceConfig

FloatArray = NDArray[np.float64]

CLOCKS_AGREE_S = 0.01
"""In real time the clocks of plant, service and bus are aligned by frames, to a few ms."""

S_PER_NS = 1e-9
US_PER_NS = 1e-3


@dataclass(frozen=True, slots=True)
class Series:
    """Samples of one channel: times (n,) and values (n,), n may be 0."""

    time_s: FloatArray
    values: FloatArray

    def between(self, from_s: float, to_s: float) -> Series:
        """The samples of a window, both ends included."""
        inside = (self.time_s >= from_s) & (self.time_s <= to_s)
        return Series(self.time_s[inside], self.values[inside])


class Evidence:
    """One run's files, read when they are first asked for.

    ``clocked`` says that a clock, not the bench, set the pace.
    """

    def __init__(
        self, files: RunFiles, scenario: Scenario, config: ServiceConfig, mode: Mode
    ) -> None:
        self.files = files
        self.scenario = scenario
        self.config = config
        self.clocked = mode == "real-time"

    @cached_property
    def truth(self) -> Truth:
        """Rows of the plant's truth."""
        return self.files.read_truth()

    @cached_property
    def ticks(self) -> NDArray[np.void]:
        """Ticks of the service."""
        return self.files.read_flight()

    @property
    def end_s(self) -> float:
        """When the run ended."""
        return float(self.truth["time_s"][-1])

    @property
    def heard_until_s(self) -> float:
        """Up to when service and bus are judged: silence after the plant's end is no fault."""
        return self.end_s - CLOCKS_AGREE_S if self.clocked else self.end_s

    @property
    def tick_time_s(self) -> FloatArray:
        """When each tick decided, (n,)."""
        if not self.clocked:  # the bench's time is the plant's: no need to read the bus for it
            return np.asarray(self.ticks["now_ns"] * S_PER_NS)
        return np.asarray((self._base.ticks_ns - self._base.truth_ns[0]) * S_PER_NS)

    def series(self, channel: Channel) -> Series:
        """Samples of one channel, from the plant's start to its end."""
        read = {"truth": self._of_truth, "service": self._of_service, "bus": self._of_bus}
        end_s = self.end_s if channel.source == "truth" else self.heard_until_s
        return read[channel.source](channel.name).between(0.0, end_s)

    @cached_property
    def _frames(self) -> list[can.Message]:
        return list(read_log(self.files.bus))

    @cached_property
    def _base(self) -> TimeBase:
        with np.load(self.files.truth) as recording:
            jitter_ns = recording["jitter_ns"]
        info = read_info(self.files.flight)
        # Ours alone say whose frames pace and begin a run, whatever the DBC of the car.
        return align(Parts(self._frames, self.ticks, info, self.truth, jitter_ns), parse_dbc()[1])

    def _of_truth(self, name: str) -> Series:
        return Series(self.truth["time_s"], truth_columns(self.truth)[name])

    def _of_service(self, name: str) -> Series:
        if name in STAGES:
            begin, end = (self.ticks[stamp] for stamp in STAGES[name])
            return Series(self.tick_time_s, (end - begin) * US_PER_NS)
        if name == LATENCY:
            return self._latency()
        return Series(self.tick_time_s, self.ticks[name].astype(float))

    def _latency(self) -> Series:
        """Of the ticks that met new wheel speeds: others were not late, the bus was silent."""
        latency_ns, stamps_ns = self.ticks["latency_ns"], self.ticks["wheel_stamp_ns"]
        fresh = (np.diff(stamps_ns, prepend=0) != 0) & (latency_ns != NO_LATENCY)
        return Series(self.tick_time_s[fresh], latency_ns[fresh] * US_PER_NS)

    def _of_bus(self, name: str) -> Series:
        message, signal = signals(self.config.bus.database)[name]
        time_ns, values = [], []
        for place, now_ns in zip(self._base.order, self._base.frames_ns, strict=True):
            frame = self._frames[place]
            if frame.arbitration_id == message.frame_id and len(frame.data) >= message.length:
                time_ns.append(now_ns - self._base.truth_ns[0])
                values.append(_decoded(message, signal.name, bytes(frame.data)))
        return Series(np.array(time_ns) * S_PER_NS, np.array(values, float))


def _decoded(message: Message, signal: str, data: bytes) -> float:
    values = message.decode(data, decode_choices=False)
    return float(values[signal])  # type: ignore[call-overload, arg-type]


def truth_columns(truth: Truth) -> dict[str, FloatArray]:
    """Every column of the truth by its name, a wheel's own for each wheel."""
    columns: dict[str, FloatArray] = {}
    for name in truth.dtype.names or ():
        values = truth[name]
        names = column_names(name, values.shape[1:])
        columns |= zip(names, np.atleast_2d(values.T), strict=True)
    return columns
