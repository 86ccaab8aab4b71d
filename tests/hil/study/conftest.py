"""Studies that are over in a moment."""

import msgspec
import pytest

from plant_emulator.scenario import load_scenario
from tcs_hil.hil.study.plan import Axis, Plan, Study
from tcs_hil.service.settings import ServiceConfig

AXES = (
    Axis(key="vehicle.body.mass_kg", low=1120.0, high=1680.0),
    Axis(key="road.0.mu", low=0.1, high=0.6),
)


@pytest.fixture
def plan():
    def make(*axes, controller="off", **options):
        study = Study(
            scenario="manoeuvre-1",
            vary=axes or AXES,
            service=ServiceConfig(controller=controller),
            **options,
        )
        scenario = msgspec.structs.replace(load_scenario("manoeuvre-1"), duration_s=0.2)
        return Plan(study, scenario.with_variant("vehicle").resolved())

    return make
