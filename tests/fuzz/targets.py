"""Every parser of bytes from outside, by the name its corpus has."""

from __future__ import annotations

from collections.abc import Callable

from . import file_targets, frame_targets, map_targets

Target = Callable[[bytes], None]

TARGETS: dict[str, Target] = {
    "frames": frame_targets.frames,
    "codec": frame_targets.codec,
    "mapped_frames": map_targets.mapped_frames,
    "signal_map": map_targets.signal_map,
    "dbc": file_targets.dbc,
    "config": file_targets.config,
    "scenario": file_targets.scenario,
    "road": file_targets.road,
    "tyre": file_targets.tyre,
    "model": file_targets.model,
    "flight_recording": file_targets.flight_recording,
    "bus_log": file_targets.bus_log,
}
