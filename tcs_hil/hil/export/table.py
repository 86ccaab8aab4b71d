"""What every exported file is made of: channels with units, in tables with their own instants."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from datetime import UTC, datetime
from typing import Any, NamedTuple

import can
import numpy as np
from numpy.typing import NDArray

from tcs_hil.errors import ConfigError

Instants = NDArray[np.int64]  # (n,), ns since the start of the run
NS_PER_S = 1_000_000_000


class Channel(NamedTuple):
    """One quantity: numbers, whole or not, of shape (n,); ``labels`` name some or all of them."""

    name: str
    values: NDArray[Any]
    unit: str = "-"
    comment: str = ""
    labels: Mapping[int, str] = {}


@dataclass(frozen=True, slots=True)
class Table:
    """Channels sampled together at ``time_ns``, which never falls but may stand."""

    name: str
    comment: str
    time_ns: Instants
    channels: tuple[Channel, ...]

    def full_name(self, channel: Channel) -> str:
        """``TorqueLimit.TcsState``: what a channel is called in every file."""
        return f"{self.name}.{channel.name}"


@dataclass(frozen=True, slots=True)
class Run:
    """A whole run: decoded messages, telemetry and truth, and the frames as they were.

    ``frames`` are stamped in seconds since the start; ``start_ns`` is when that
    was, since 1970; ``about`` says in words what the run was, ``lost`` what could
    not be read of it.
    """

    start_ns: int
    tables: tuple[Table, ...]
    frames: tuple[can.Message, ...] = ()
    about: Mapping[str, str] = field(default_factory=dict)
    lost: str = ""

    @property
    def start(self) -> datetime:
        """The start of the run, UTC, cut to the microsecond."""
        seconds, rest_ns = divmod(self.start_ns, NS_PER_S)
        return datetime.fromtimestamp(seconds, UTC).replace(microsecond=rest_ns // 1000)

    @property
    def description(self) -> dict[str, str]:
        """What goes into a file's metadata: the start, ``about``, and ``lost`` if anything was."""
        start = {"start": self.start.isoformat(), "start_ns": str(self.start_ns)}
        return {**start, **self.about, **({"lost": self.lost} if self.lost else {})}

    @property
    def decoded(self) -> tuple[Table, ...]:
        """The tables, for a format that holds nothing else.

        Raises:
            ConfigError: there are none.
        """
        if not self.tables:
            raise ConfigError("nothing to export: no frame is of a message in the DBC")
        return self.tables
