"""What is kept of the truth, and what it costs."""

import msgspec
import numpy as np
import pytest

from plant_emulator import recording
from plant_emulator.recording import TruthRecorder
from plant_emulator.truth import ROW_SIZE
from tcs_hil.errors import ConfigError


@pytest.fixture
def day(launch):
    return msgspec.structs.replace(launch, duration_s=86_400.0)


def test_without_a_path_nothing_is_kept(day):
    recorder = TruthRecorder(None, day)
    recorder.add(np.zeros(ROW_SIZE))
    recorder.save()
    assert recorder.rows.size == 0


def test_rows_are_kept_in_order_across_chunks(day, monkeypatch):
    monkeypatch.setattr(recording, "CHUNK_ROWS", 4)
    recorder = TruthRecorder(None, day, in_memory=True)
    for index in range(10):
        recorder.add(np.full(ROW_SIZE, float(index)))
    assert recorder.rows["time_s"].tolist() == list(range(10))


def test_a_day_takes_memory_only_as_it_passes(day):
    recorder = TruthRecorder(None, day, in_memory=True)
    recorder.add(np.zeros(ROW_SIZE))
    assert sum(chunk.nbytes for chunk in recorder._chunks) < 2**23


def test_a_run_that_does_not_fit_into_memory_says_so(day, monkeypatch):
    monkeypatch.setattr(recording, "CHUNK_ROWS", 10**14)
    with pytest.raises(ConfigError, match="`duration_s`"):
        TruthRecorder(None, day, in_memory=True).add(np.zeros(ROW_SIZE))
