"""What happens to frames between two nodes: the wire vcan has not, as a scenario describes it."""

from __future__ import annotations

from typing import Annotated

from msgspec import Meta

from plant_emulator.bounds import Ratio, Seed, Table

BitRate = Annotated[int, Meta(ge=0, le=1_000_000)]


class BusTiming(Table, frozen=True):
    """What happens to a frame between two nodes.

    ``bitrate`` 0 is a wire that takes no time.  ``background_load`` is the share of
    it that foreign frames of random identifiers take.  Vehicle frames are queued
    up to ``jitter_s`` late.  ``loss_ratio`` of all frames reach nobody.
    ``limit_delay_s`` passes between the arrival of a torque limit and its effect
    (gateway and inverter).  ``answer_s`` is when, after sampling, the service reads
    the bus and answers: in lockstep only, in real time the service decides.
    """

    bitrate: BitRate = 500_000
    background_load: Annotated[float, Meta(ge=0.0, le=0.8)] = 0.0
    jitter_s: Annotated[float, Meta(ge=0.0, le=0.002)] = 0.0
    loss_ratio: Ratio = 0.0
    limit_delay_s: Annotated[float, Meta(ge=0.0, le=10.0)] = 0.004
    answer_s: Annotated[float, Meta(ge=0.0, lt=0.002)] = 0.0017
    seed: Seed = 2


IDEAL = BusTiming(bitrate=0, limit_delay_s=0.0, answer_s=0.0)
"""No delay anywhere."""
