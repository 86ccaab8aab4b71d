"""What workers and cars of a bench need, imported and compiled once, before they are forked.

multiprocessing's fork server can be told only which modules to import; importing
this one also drives a plant and a service for a moment.
"""

from __future__ import annotations

import tcs_hil.hil.suite.library
import tcs_hil.hil.suite.runner
from plant_emulator.scenario import Variant, load_scenario
from plant_emulator.session import warm_up

VARIANTS: tuple[Variant, ...] = ("quarter-car", "vehicle")
# multiprocessing imports the bench's own main module in each of its children.
WORKERS = (tcs_hil.hil.suite.library, tcs_hil.hil.suite.runner)

for variant in VARIANTS:
    warm_up(load_scenario("manoeuvre-1").with_variant(variant))
