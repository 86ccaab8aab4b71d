"""Samples small enough to travel inside a page."""

from __future__ import annotations

import base64
import zlib
from collections.abc import Mapping

import msgspec
import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]

SAMPLES_MAX = 4000
"""More than a screen has columns; of a longer run each stretch tells its lowest and highest."""
LEVELS = 65_534
EMPTY = -32_768
"""Stands for no value; the others are levels between a channel's lowest and highest."""


class Packed(msgspec.Struct, frozen=True):
    """Channels on one grid of ``count`` times, ``step_s`` apart.

    ``data`` is base64 of zlib of 16-bit levels, little-endian, channel after
    channel; ``ranges`` holds lowest and highest value of each.
    """

    names: list[str]
    ranges: list[tuple[float, float]]
    start_s: float
    step_s: float
    count: int
    data: str


def pack(time_s: FloatArray, channels: Mapping[str, FloatArray]) -> Packed:
    """Pack channels at evenly spaced ``time_s`` (n,), n > 1; what is not finite is empty."""
    step_s = float(time_s[-1] - time_s[0]) / (len(time_s) - 1)
    stretch = -(-2 * len(time_s) // SAMPLES_MAX) if len(time_s) > SAMPLES_MAX else 1
    thin = {name: _envelope(values, stretch) for name, values in channels.items()}
    ranges = {name: _range(values) for name, values in thin.items()}
    levels = [_levels(values, *ranges[name]) for name, values in thin.items()]
    return Packed(
        names=list(thin),
        ranges=list(ranges.values()),
        start_s=float(time_s[0]),
        step_s=step_s * (stretch / 2.0 if stretch > 1 else 1.0),
        count=len(levels[0]),
        data=base64.b64encode(zlib.compress(np.concatenate(levels).tobytes(), 9)).decode(),
    )


def _envelope(values: FloatArray, stretch: int) -> FloatArray:
    """Lowest and highest of every ``stretch`` samples, in turn; the samples if it is 1."""
    values = np.where(np.isfinite(values), values, np.nan)
    if stretch == 1:
        return values
    padded = np.append(values, np.full(-len(values) % stretch, values[-1])).reshape(-1, stretch)
    empty = np.isnan(padded).all(axis=1)
    filled = np.where(empty[:, None], 0.0, padded)
    pairs = np.column_stack([np.nanmin(filled, axis=1), np.nanmax(filled, axis=1)])
    pairs[empty] = np.nan
    return pairs.ravel()


def _range(values: FloatArray) -> tuple[float, float]:
    known = values[~np.isnan(values)]
    return (float(known.min()), float(known.max())) if known.size else (0.0, 0.0)


def _levels(values: FloatArray, lowest: float, highest: float) -> NDArray[np.int16]:
    share = (values - lowest) / (highest - lowest) if highest > lowest else values * 0.0
    levels = np.where(np.isnan(share), EMPTY, np.round(share * LEVELS) - LEVELS // 2)
    return levels.astype("<i2")
