"""What a flight recording says about the service that writes it."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from tcs_hil.hil.monitor.bus_view import S_IN_NS, WINDOW_NS, meaning
from tcs_hil.hil.monitor.history import BIN_NS, SPAN, History
from tcs_hil.hil.monitor.snapshot import Side, Snapshot, Spread, spread
from tcs_hil.runtime.follower import Totals
from tcs_hil.runtime.recording import Bookmark, read_on
from tcs_hil.runtime.times import times_us
from tcs_hil.signals import ControllerKind, TcsState

SHOWN_TIMES = ("latency", "wake_jitter", "solve", "total")
HISTORY_NS = SPAN * BIN_NS


class FlightView:
    """Reads on in a recording whenever it is asked; a new run starts from nothing."""

    def __init__(self, path: Path) -> None:
        """Open the recording.

        Raises:
            RecordingError: there is none, or it cannot be read.
        """
        self._path = path
        self._bookmark: Bookmark | None = None
        self._read()

    def snapshot(self, now_ns: int) -> Snapshot | None:
        """Everything that is known at ``now_ns``; None while no tick was made.

        Raises:
            RecordingError: the recording is gone or cannot be read.
        """
        self._read()
        newest = self._totals.newest
        return None if newest is None else self._instant(newest, now_ns)

    def _read(self) -> None:
        before = self._bookmark
        ticks, self._bookmark = read_on(self._path, before)
        if before is None or before.run != self._bookmark.run:
            self.history = History()
            self._totals = Totals(self._bookmark.run)
            self._recent = ticks[:0]
        self._totals.add(ticks, self._bookmark.made)
        if len(ticks):
            self._remember(ticks)

    def _remember(self, ticks: NDArray[np.void]) -> None:
        window = np.concatenate([self._recent, ticks])
        self._recent = window[window["wake_ns"] > window["wake_ns"][-1] - WINDOW_NS]
        for tick in ticks[ticks["now_ns"] > ticks["now_ns"][-1] - HISTORY_NS]:
            self.history.add(int(tick["now_ns"]), _side(tick, "l"), _side(tick, "r"), None)

    def _instant(self, tick: np.void, now_ns: int) -> Snapshot:
        return Snapshot(
            source=str(self._path),
            silent_s=max(now_ns - int(tick["wake_ns"]), 0) / S_IN_NS,
            state=TcsState(int(tick["state"])).name,
            controller=ControllerKind(int(tick["controller"])).name,
            fault_code=int(tick["fault_code"]),
            fault=meaning(int(tick["fault_code"])),
            slip_reference=None,
            vehicle_speed_mps=float(tick["vehicle_speed_mps"]),
            left=_side(tick, "l"),
            right=_side(tick, "r"),
            times=self._times(),
            rates_hz={},
            counts=self._counts(tick),
        )

    def _times(self) -> dict[str, Spread]:
        times = times_us(self._recent)
        spreads = {name: spread(times[name]) for name in SHOWN_TIMES}
        return {name: found for name, found in spreads.items() if found is not None}

    def _counts(self, tick: np.void) -> dict[str, int]:
        counters = ("e2e_errors", "e2e_repeated", "e2e_wrong_sequence", "lost_frames")
        return {name: int(tick[name]) for name in counters} | {"overruns": self._totals.overruns}


def _side(tick: np.void, side: str) -> Side:
    def value(name: str) -> float:
        return float(tick[name])

    limit_nm = value(f"limit_f{side}_nm")
    return Side(
        slip_ratio=value(f"slip_ratio_f{side}"),
        wheel_speed_radps=value(f"wheel_speed_f{side}_radps"),
        rear_speed_radps=value(f"wheel_speed_r{side}_radps"),
        request_nm=value(f"driver_torque_f{side}_nm"),
        limit_nm=limit_nm if np.isfinite(limit_nm) else None,
        motor_nm=value(f"motor_torque_f{side}_nm"),
    )
