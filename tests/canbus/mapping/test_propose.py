"""The map that is proposed for a DBC, against the one its maker wrote."""

from __future__ import annotations

import tomllib
from typing import Any

import pytest

from tcs_hil.canbus.database import parse_dbc
from tcs_hil.canbus.mapping.findings import Weight
from tcs_hil.canbus.mapping.propose import propose
from tcs_hil.config import convert
from tcs_hil.service.bus_end import examine_map
from tcs_hil.service.settings import ServiceConfig

from .makers import AURELIS, FOLDER, MAKERS, QUENDAL, Maker


def proposal(maker: Maker) -> dict[str, Any]:
    path = FOLDER / f"{maker.name}.dbc"
    return tomllib.loads(propose(parse_dbc(path)[1], str(path)))


def signals(table: dict[str, Any]) -> dict[str, str]:
    """Every signal of the map by its key, flags of the limits left out."""
    places = {**table["map"]["inputs"], **table["map"]["limits"]}
    return {key: value["signal"] for key, value in places.items() if not key.startswith("active")}


@pytest.mark.parametrize("maker", MAKERS, ids=lambda maker: maker.name)
def test_it_finds_what_the_maker_meant(maker: Maker) -> None:
    written = tomllib.loads(maker.toml.read_text())
    assert signals(proposal(maker)) == signals(written)


def test_it_runs_as_it_is_where_the_dbc_says_all() -> None:
    _, findings = examine_map(convert(proposal(AURELIS), ServiceConfig, "proposal"))
    assert not findings.errors
    assert {f.key for f in findings.found if f.weight is Weight.WARNING} >= {"messages.EduMotor"}


def test_split_counters_are_put_together_and_cycles_asked_for() -> None:
    path = FOLDER / "quendal.dbc"
    text = propose(parse_dbc(path)[1], str(path))
    assert 'counter = { signals = ["WHL_CntLow", "WHL_CntHigh"] }' in text
    assert text.count("# cycle_ms: the DBC does not say") == 3
    _, findings = examine_map(convert(proposal(QUENDAL), ServiceConfig, "proposal"))
    assert {finding.key for finding in findings.errors} >= {"messages.DRV_REQ"}
