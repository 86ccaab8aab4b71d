"""Samples packed for the page, unpacked as its program does."""

from __future__ import annotations

import base64
import zlib

import numpy as np
import pytest

from tcs_hil.hil.report.pack import EMPTY, LEVELS, SAMPLES_MAX, Packed, pack


def unpacked(packed: Packed) -> dict[str, np.ndarray]:
    levels = np.frombuffer(zlib.decompress(base64.b64decode(packed.data)), "<i2")
    channels = {}
    for name, row, (low, high) in zip(
        packed.names, levels.reshape(-1, packed.count), packed.ranges, strict=True
    ):
        values = low + (row + LEVELS / 2) / LEVELS * (high - low)
        channels[name] = np.where(row == EMPTY, np.nan, values)
    return channels


def test_a_short_run_keeps_every_sample_to_a_65000th_of_its_range() -> None:
    time_s = np.arange(1000) * 0.002
    slip, torque = np.sin(9.0 * time_s), 250.0 * np.exp(-time_s)
    packed = pack(time_s, {"slip": slip, "torque": torque})
    assert (packed.count, packed.start_s, packed.step_s) == (1000, 0.0, pytest.approx(0.002))
    found = unpacked(packed)
    np.testing.assert_allclose(found["slip"], slip, atol=2.0 / LEVELS)
    np.testing.assert_allclose(found["torque"], torque, atol=250.0 / LEVELS)


def test_of_a_long_run_no_peak_is_lost() -> None:
    time_s = np.arange(50_000) * 0.002
    values = np.zeros(len(time_s))
    values[31_234], values[40_001] = 1.0, -2.0
    packed = pack(time_s, {"slip": values})
    found = unpacked(packed)["slip"]
    assert packed.count <= SAMPLES_MAX + 2
    assert found.max() == pytest.approx(1.0, abs=1e-4)
    assert found.min() == pytest.approx(-2.0, abs=1e-4)
    at_s = packed.start_s + packed.step_s * np.argmax(found)
    assert at_s == pytest.approx(31_234 * 0.002, abs=2.0 * packed.step_s)


def test_what_is_not_finite_is_empty() -> None:
    values = np.array([1.0, np.inf, np.nan, 2.0])
    found = unpacked(pack(np.arange(4.0), {"limit": values}))["limit"]
    np.testing.assert_array_equal(np.isnan(found), [False, True, True, False])
    assert found[3] == pytest.approx(2.0)


def test_channels_that_never_move_are_packed_too() -> None:
    channels = {"mu": np.full(3, 0.3), "nothing": np.full(3, np.nan)}
    found = unpacked(pack(np.arange(3.0), channels))
    np.testing.assert_allclose(found["mu"], 0.3)
    assert np.isnan(found["nothing"]).all()
