"""How patient the supervisor is, and how fast the gate lets a ceiling move."""

from __future__ import annotations

from typing import Annotated

import msgspec

Cycles = Annotated[int, msgspec.Meta(ge=0, le=100)]
Ticks = Annotated[int, msgspec.Meta(ge=1, le=1000)]
Rate = Annotated[float, msgspec.Meta(gt=0.0, le=1e6)]


class SupervisorSettings(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Patience of the supervisor.

    Cycles are those of the input concerned: up to ``bridged_cycles`` the last
    value serves, beyond ``tolerated_cycles`` it is lost.  A controller may be
    silent for as many ticks.
    """

    bridged_cycles: Cycles = 2
    tolerated_cycles: Cycles = 10
    good_ticks_to_recover: Ticks = 10
    overruns_to_degrade: Ticks = 5


class GateSettings(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """How fast a ceiling may move.

    ``rise_rate_nmps`` and ``fall_rate_nmps`` bound a trusted law;
    ``window_rise_nm`` is the most it may raise in ``window_s``.  A ceiling that
    is given up rises by ``release_rate_nmps``.  One that reaches the request, to
    within ``slack_nm``, is lifted; not before ``lift_s``, though, where it was the
    request that fell, for that may come back.
    """

    rise_rate_nmps: Rate = 20_000.0
    fall_rate_nmps: Rate = 125_000.0
    release_rate_nmps: Rate = 500.0
    window_s: Annotated[float, msgspec.Meta(gt=0.0, le=1.0)] = 0.1
    window_rise_nm: Annotated[float, msgspec.Meta(gt=0.0, le=1e4)] = 200.0
    slack_nm: Annotated[float, msgspec.Meta(ge=0.0, le=5.0)] = 0.05
    lift_s: Annotated[float, msgspec.Meta(ge=0.0, le=1.0)] = 0.02
