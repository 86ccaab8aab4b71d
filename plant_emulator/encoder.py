"""Toothed-wheel speed sensors: edges in time, and the speed a wheel-speed unit makes of them."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from plant_emulator.compiled import compiled

TURN_RAD = 2.0 * math.pi


class Encoder(NamedTuple):
    """Four toothed rings and what their sensors have seen; arrays, changed in place.

    ``edges`` are the angles of the edges within a turn, without edges the sensor
    is ideal.  ``gap`` numbers the edge last passed, over all turns.  ``missing``
    is a tooth that gives no edges, -1 for none.
    """

    edges: NDArray[np.float64]  # (4, edges of a turn), rad, ascending from zero
    gap: NDArray[np.int64]  # (4,)
    seen: NDArray[np.int64]  # (4,) edges since the start
    stamp_s: NDArray[np.float64]  # (4,) time of the newest edge
    missing: NDArray[np.int64]  # (4,)


def make_encoder(
    teeth: int, pitch_error: float, angles_rad: NDArray[np.float64], rng: np.random.Generator
) -> Encoder:
    """Cut four rings, every edge off by up to ``pitch_error`` of a pitch; no teeth, no edges."""
    edges = 2 * teeth
    error = rng.uniform(-pitch_error, pitch_error, (4, edges))
    positions = (np.arange(edges) + 0.5 + error) * (TURN_RAD / max(edges, 1))
    turn = np.floor(angles_rad / TURN_RAD)
    rest = angles_rad - turn * TURN_RAD
    passed = np.array([np.searchsorted(positions[w], rest[w], side="right") for w in range(4)])
    return Encoder(
        positions,
        (turn.astype(np.int64) * edges + passed - 1).astype(np.int64),
        np.zeros(4, np.int64),
        np.zeros(4),
        np.full(4, -1, np.int64),
    )


@compiled
def edge_angle(edges: NDArray[np.float64], number: int) -> float:
    """Angle of edge ``number``, counted over all turns."""
    turn = number // edges.size
    return float(turn * TURN_RAD + edges[number - turn * edges.size])


@compiled
def pass_edges(
    encoder: Encoder, wheel: int, before_rad: float, after_rad: float, start_s: float, h: float
) -> None:
    """Stamp the edges a wheel passes in one integration step, in either direction.

    Within a step of 0.1 ms the speed is constant as far as a stamp can tell.
    """
    edges = encoder.edges[wheel]
    number = encoder.gap[wheel]
    pace = h / (after_rad - before_rad) if after_rad != before_rad else 0.0
    while after_rad >= edge_angle(edges, number + 1):
        number += 1
        _stamp(encoder, wheel, number, start_s + pace * (edge_angle(edges, number) - before_rad))
    while after_rad < edge_angle(edges, number):
        _stamp(encoder, wheel, number, start_s + pace * (edge_angle(edges, number) - before_rad))
        number -= 1
    encoder.gap[wheel] = number


@compiled
def _stamp(encoder: Encoder, wheel: int, number: int, time_s: float) -> None:
    tooth = (number % encoder.edges.shape[1]) // 2
    if tooth != encoder.missing[wheel]:
        encoder.seen[wheel] += 1
        encoder.stamp_s[wheel] = time_s


class WheelMotion(NamedTuple):
    """Angle and speed of the four wheels."""

    angle_rad: NDArray[np.float64]  # (4,)
    speed_radps: NDArray[np.float64]  # (4,)


def _stamps_before_start(encoder: Encoder, rolling: WheelMotion) -> NDArray[np.float64]:
    """When the wheels, rolling as they do at time zero, passed their last edges."""
    since_rad = [
        angle - edge_angle(encoder.edges[wheel], encoder.gap[wheel])
        for wheel, angle in enumerate(rolling.angle_rad)
    ]
    return -np.array(since_rad) / np.maximum(rolling.speed_radps, 1e-3)


class SpeedUnit(NamedTuple):
    """What the unit that makes speeds of edges remembers; arrays, changed in place."""

    dropout_s: float
    count: NDArray[np.int64]  # (4,) edges at the last sample
    stamp_s: NDArray[np.float64]  # (4,) newest edge then
    speed_radps: NDArray[np.float64]  # (4,) speed shown then


def make_speed_unit(encoder: Encoder, rolling: WheelMotion, dropout_s: float) -> SpeedUnit:
    """Start a unit on wheels that have always rolled as they do now."""
    stamp_s = _stamps_before_start(encoder, rolling)
    return SpeedUnit(dropout_s, encoder.seen.copy(), stamp_s, rolling.speed_radps.copy())


@compiled
def sample_speeds(unit: SpeedUnit, encoder: Encoder, time_s: float) -> None:
    """Update the speed of each wheel, rad/s, as the electronics do once per cycle.

    Edges counted over the time between their stamps; held between edges, but
    never faster than one edge since the newest one allows; zero after
    ``dropout_s`` without an edge.
    """
    pitch_rad = TURN_RAD / encoder.edges.shape[1]
    for wheel in range(4):
        edges = encoder.seen[wheel] - unit.count[wheel]
        if edges > 0:
            between_s = encoder.stamp_s[wheel] - unit.stamp_s[wheel]
            unit.speed_radps[wheel] = edges * pitch_rad / between_s
            unit.stamp_s[wheel] = encoder.stamp_s[wheel]
            unit.count[wheel] = encoder.seen[wheel]
        silence_s = time_s - unit.stamp_s[wheel]
        if silence_s > unit.dropout_s:
            unit.speed_radps[wheel] = 0.0
        elif silence_s * unit.speed_radps[wheel] > pitch_rad:
            unit.speed_radps[wheel] = pitch_rad / silence_s
