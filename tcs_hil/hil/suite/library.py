"""Suites by name: the folders of the scenario library, all of them, and those that are made."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from msgspec import structs

from plant_emulator.scenario import list_scenarios, load_scenario
from tcs_hil.errors import ConfigError, offer
from tcs_hil.hil.faults.suite import FAMILIES, SUITE, family_cases, fault_cases
from tcs_hil.hil.suite.case import Case
from tcs_hil.service.settings import ServiceConfig

ALL = "all"
OWN = "own"
"""The suite of scenarios that are not shipped."""

GENERATED: dict[str, Callable[[ServiceConfig], list[Case]]] = {
    SUITE: fault_cases,
    FAMILIES: family_cases,
}
"""Suites that no folder holds: from the service's configuration to the cases."""


def suite_names() -> list[str]:
    """Every name `--suite` takes."""
    return [ALL, *dict.fromkeys(listing.suite for listing in list_scenarios()), *GENERATED]


def suite_cases(name: str, config: ServiceConfig) -> list[Case]:
    """The cases of a suite, against the service that ``config`` describes.

    Raises:
        ConfigError: there is no such suite.
    """
    if name in GENERATED:
        return GENERATED[name](config)
    listings = [listing for listing in list_scenarios() if name in (ALL, listing.suite)]
    if not listings:
        raise ConfigError(f"there is no suite {name!r}{offer(name, suite_names())}")
    return [_case(listing.suite, listing.name, listing.name, config) for listing in listings]


def scenario_case(name_or_path: str, config: ServiceConfig) -> Case:
    """The case of one scenario, shipped or not.

    Raises:
        ConfigError: it does not exist or cannot be used.
    """
    shipped = {listing.name: listing.suite for listing in list_scenarios()}
    suite = shipped.get(name_or_path, OWN)
    return _case(suite, Path(name_or_path).stem, name_or_path, config)


def _case(suite: str, name: str, source: str, config: ServiceConfig) -> Case:
    """The scenario says which law it is meant for."""
    scenario = load_scenario(source)
    control = structs.replace(config.control, preset=scenario.controller.preset)
    config = structs.replace(config, controller=scenario.controller.kind, control=control)
    return Case(suite, name, scenario, config)
