"""Toothed-wheel speed sensors: edges in time, and the speed a wheel-speed unit makes of them."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from plant_emulator.compiled import compiled, opened, records

TURN_RAD = 2.0 * math.pi

GAP, SEEN, MISSING = range(3)
BELOW, ABOVE, STAMP = range(3)


class Encoder(NamedTuple):
    """Four toothed rings and what their sensors have seen; arrays, changed in place.

    Columns of ``numbers``: the edge last passed, counted over all turns; how many
    edges were seen; the tooth that gives no edges, -1 for none.  Columns of
    ``marks``: angle of the edge below and of the one above the sensor, rad; time
    of the newest edge, s.
    """

    edges: NDArray[np.float64]  # (4, edges of a turn), rad, ascending; none if ideal
    numbers: NDArray[np.int64]  # (4, 3)
    marks: NDArray[np.float64]  # (4, 3)


class WheelMotion(NamedTuple):
    """Angle and speed of the four wheels."""

    angle_rad: NDArray[np.float64]  # (4,)
    speed_radps: NDArray[np.float64]  # (4,)


def make_encoder(
    teeth: int, pitch_error: float, rolling: WheelMotion, rng: np.random.Generator
) -> Encoder:
    """Cut four rings, every edge off by up to ``pitch_error`` of a pitch; no teeth, no edges.

    The stamps are those of wheels that have always rolled as they do now.
    """
    edges = 2 * teeth
    error = rng.uniform(-pitch_error, pitch_error, (4, edges))
    positions = (np.arange(edges) + 0.5 + error) * (TURN_RAD / max(edges, 1))
    encoder = Encoder(positions, np.zeros((4, 3), np.int64), np.zeros((4, 3)))
    encoder.numbers[:, MISSING] = -1
    for wheel in range(4 if edges else 0):
        _place(encoder, wheel, rolling.angle_rad[wheel])
        since_rad = rolling.angle_rad[wheel] - encoder.marks[wheel, BELOW]
        encoder.marks[wheel, STAMP] = -since_rad / max(rolling.speed_radps[wheel], 1e-3)
    return encoder


def _place(encoder: Encoder, wheel: int, angle_rad: float) -> None:
    turn = math.floor(angle_rad / TURN_RAD)
    edges = encoder.edges[wheel]
    passed = int(np.searchsorted(edges, angle_rad - turn * TURN_RAD, side="right"))
    _between(encoder, wheel, turn * edges.size + passed - 1)


@compiled
def edge_angle(edges: NDArray[np.float64], number: int) -> float:
    """Angle of edge ``number``, counted over all turns."""
    turn = number // edges.size
    return float(turn * TURN_RAD + edges[number - turn * edges.size])


@compiled
def _between(encoder: Encoder, wheel: int, number: int) -> None:
    """Put the sensor between edge ``number`` and the next."""
    encoder.numbers[wheel, GAP] = number
    encoder.marks[wheel, BELOW] = edge_angle(encoder.edges[wheel], number)
    encoder.marks[wheel, ABOVE] = edge_angle(encoder.edges[wheel], number + 1)


@compiled
def pass_edges(
    encoder: Encoder, wheel: int, before_rad: float, after_rad: float, start_s: float, h: float
) -> None:
    """Stamp the edges a wheel passes in one integration step, in either direction.

    Within a step of 0.1 ms the speed is constant as far as a stamp can tell, and
    no wheel makes a whole turn: an angle that jumps or is NaN passes nothing.
    """
    if not abs(after_rad - before_rad) < TURN_RAD:
        return
    marks = encoder.marks[wheel]
    while after_rad >= marks[ABOVE]:
        moment_s = start_s + h * (marks[ABOVE] - before_rad) / (after_rad - before_rad)
        _between(encoder, wheel, encoder.numbers[wheel, GAP] + 1)
        _stamp(encoder, wheel, encoder.numbers[wheel, GAP], moment_s)
    while after_rad < marks[BELOW]:
        moment_s = start_s + h * (marks[BELOW] - before_rad) / (after_rad - before_rad)
        _stamp(encoder, wheel, encoder.numbers[wheel, GAP], moment_s)
        _between(encoder, wheel, encoder.numbers[wheel, GAP] - 1)


@compiled
def _stamp(encoder: Encoder, wheel: int, number: int, time_s: float) -> None:
    tooth = (number % encoder.edges.shape[1]) // 2
    if tooth != encoder.numbers[wheel, MISSING]:
        encoder.numbers[wheel, SEEN] += 1
        encoder.marks[wheel, STAMP] = time_s


class SpeedMemory(NamedTuple):
    """What the unit that makes speeds of edges knows and remembers; arrays, changed in place."""

    pitch_rad: float
    dropout_s: float
    seen: NDArray[np.int64]  # (4,) edges at the last sample
    stamp_s: NDArray[np.float64]  # (4,) newest edge then
    speed_radps: NDArray[np.float64]  # (4,) speed shown then


class SpeedUnit:
    """The electronics that make speeds of edges, once per cycle.

    Edges counted over the time between their stamps; held between edges, but
    never faster than one edge since the newest one allows; zero after
    ``dropout_s`` without an edge.  It starts with the wheels' speeds.
    """

    def __init__(self, encoder: Encoder, rolling: WheelMotion, dropout_s: float) -> None:
        self._encoder = encoder
        self._memory = records(
            SpeedMemory(
                TURN_RAD / encoder.edges.shape[1],
                dropout_s,
                encoder.numbers[:, SEEN],
                encoder.marks[:, STAMP],
                rolling.speed_radps,
            )
        )
        self._speed_radps = opened(self._memory).speed_radps

    def sample(self, time_s: float) -> list[float]:
        """Return the speed of each wheel at ``time_s``, rad/s."""
        _update_speeds(self._memory, self._encoder.numbers, self._encoder.marks, time_s)
        speeds: list[float] = self._speed_radps.tolist()
        return speeds


@compiled
def _update_speeds(
    memory: Sequence[SpeedMemory],  # one
    numbers: NDArray[np.int64],  # (4, 3), the encoder's
    marks: NDArray[np.float64],  # (4, 3), the encoder's
    time_s: float,
) -> None:
    unit, pitch_rad = memory[0], memory[0].pitch_rad
    for wheel in range(4):
        edges = numbers[wheel, SEEN] - unit.seen[wheel]
        if edges > 0:
            between_s = marks[wheel, STAMP] - unit.stamp_s[wheel]
            unit.speed_radps[wheel] = edges * pitch_rad / between_s
            unit.stamp_s[wheel] = marks[wheel, STAMP]
            unit.seen[wheel] = numbers[wheel, SEEN]
        silence_s = time_s - unit.stamp_s[wheel]
        if silence_s > unit.dropout_s:
            unit.speed_radps[wheel] = 0.0
        elif silence_s * unit.speed_radps[wheel] > pitch_rad:
            unit.speed_radps[wheel] = pitch_rad / silence_s
