"""Looking over a maker's map with something changed in it."""

from __future__ import annotations

import tomllib
from typing import Any

from tcs_hil.canbus.mapping.findings import Finding, Weight
from tcs_hil.config import convert
from tcs_hil.service.bus_end import examine_map
from tcs_hil.service.settings import ServiceConfig

from .makers import Maker

ERROR, WARNING, NOTE = Weight.ERROR, Weight.WARNING, Weight.NOTE
GONE = object()


def config_with(maker: Maker, **changes: Any) -> ServiceConfig:
    """The maker's configuration with changes by dotted path; ``GONE`` takes a key out."""
    table = tomllib.loads(maker.toml.read_text())
    for path, value in changes.items():
        *parents, last = path.split("__")
        place = table
        for parent in parents:
            place = place.setdefault(parent, {})
        if value is GONE:
            del place[last]
        else:
            place[last] = value
    return convert(table, ServiceConfig, "test").beside(maker.toml.parent)


def found(maker: Maker, **changes: Any) -> list[Finding]:
    return examine_map(config_with(maker, **changes))[1].found
