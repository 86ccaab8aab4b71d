"""The service as a process on a maker's bus: configuration only, no line of code."""

from __future__ import annotations

import uuid
from pathlib import Path

import numpy as np

from tcs_hil.canbus.bus import open_bus
from tcs_hil.hil.metrics import slip_metrics
from tcs_hil.model.vehicle import Vehicle
from tcs_hil.runtime.recording import read
from tcs_hil.signals import TcsState

from .bridge import drive
from .makers import AURELIS


def test_a_launch_in_lockstep_over_the_embedded_bus(tmp_path: Path) -> None:
    channels = (f"vcan-{uuid.uuid4().hex[:8]}", f"vcan-{uuid.uuid4().hex[:8]}")
    emulators, _ = open_bus("embedded", channels[0])
    services, _ = open_bus("embedded", channels[1])
    with emulators, services:
        ticks, truth, flight = drive(AURELIS, emulators, services, tmp_path, channels)
    recorded = read(flight)
    assert ticks == len(recorded) == 200
    assert list(np.unique(recorded["state"])) == [
        TcsState.INIT,
        TcsState.STANDBY,
        TcsState.ACTIVE,
    ]
    assert not recorded["e2e_errors"].any()
    with np.load(truth) as rows:
        metrics = slip_metrics(rows["truth"], 0.1, Vehicle())
    # Without control the wheels turn at more than ten times the car's speed by then.
    assert metrics.peak_ratio < 0.5
