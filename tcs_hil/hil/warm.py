"""What every program of a bench needs, imported and compiled once, before it is forked off.

multiprocessing's fork server can be told only which modules to import; importing
this one also drives a plant and a service for a moment.
"""

from __future__ import annotations

import plant_emulator.cli
import tcs_hil.cli.record
import tcs_hil.cli.run
from plant_emulator.scenario import Variant, load_scenario
from plant_emulator.session import warm_up

VARIANTS: tuple[Variant, ...] = ("quarter-car", "vehicle")
PROGRAMS = (plant_emulator.cli, tcs_hil.cli.run, tcs_hil.cli.record)

for variant in VARIANTS:
    warm_up(load_scenario("manoeuvre-1").with_variant(variant))
