"""The service's end of a maker's bus."""

from __future__ import annotations

import tomllib
from typing import Any

from tcs_hil.canbus.mapping.node import MappedNode
from tcs_hil.config import convert
from tcs_hil.service.bus_end import bus_end
from tcs_hil.service.settings import ServiceConfig

from .makers import Maker


def node_of(maker: Maker, **tables: Any) -> MappedNode:
    """The node that speaks with the maker's car; ``tables`` replace parts of the map."""
    config = tomllib.loads(maker.toml.read_text())
    config["map"] |= tables
    node = bus_end(convert(config, ServiceConfig, "test").beside(maker.toml.parent)).node
    assert isinstance(node, MappedNode)
    return node
