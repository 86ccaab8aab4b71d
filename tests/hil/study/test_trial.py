import math

import msgspec
import pytest

from tcs_hil.errors import ConfigError
from tcs_hil.hil.study.plan import Axis, Success
from tcs_hil.hil.study.trial import job, run


def test_a_point_is_put_where_its_keys_say(plan):
    axes = (
        Axis(key="vehicle.body.mass_kg", values=(1234.5,)),
        Axis(key="road.0.mu", values=(0.25,)),
        Axis(key="driver.request.0.1", values=(99.0,)),
        Axis(key="service.control.slip_reference", values=(0.08,)),
    )
    made = job(plan(*axes), (1234.5, 0.25, 99.0, 0.08), 7)
    assert made.scenario.vehicle.body.mass_kg == 1234.5
    assert made.scenario.road[0].mu == 0.25
    assert made.scenario.driver.request[0][1] == 99.0
    assert made.config.control.slip_reference == 0.08


@pytest.mark.parametrize(
    "key", ["vehicle.colour", "road.9.mu", "vehicle.body.mass_kg.x", "road.mu"]
)
def test_a_key_that_does_not_exist_is_refused_by_name(key, plan):
    with pytest.raises(ConfigError, match=f"`{key}`"):
        job(plan(Axis(key=key, values=(1.0,))), (1.0,), 0)


def test_a_value_out_of_bounds_is_refused_with_its_point(plan):
    with pytest.raises(ConfigError, match=r"point 3: road\[0\].mu"):
        job(plan(Axis(key="road.0.mu", values=(9.0,))), (9.0,), 3)


def test_a_row_holds_the_point_and_what_came_of_it(plan):
    row = run(plan(), (1200.0, 0.3), 4)
    assert (row["index"], row["vehicle.body.mass_kg"], row["road.0.mu"]) == (4, 1200.0, 0.3)
    assert 0.0 < row["peak_slip_ratio"] < 1.0
    assert row["error"] == ""


@pytest.mark.parametrize(("peak_slip_ratio", "succeeds"), [(0.01, False), (1.0, True)])
def test_a_run_that_breaks_a_limit_is_no_success(peak_slip_ratio, succeeds, plan):
    success = Success(peak_slip_ratio=peak_slip_ratio, limit_cycle=True)
    assert run(plan(success=success), (1400.0, 0.1), 0)["success"] is succeeds


def test_a_run_that_breaks_is_a_row_and_no_success(plan):
    row = run(plan(Axis(key="road.0.mu", values=(9.0,))), (9.0,), 0)
    assert "road[0].mu" in row["error"]
    assert not row["success"]
    assert math.isnan(row["rmse_ratio"])


def test_what_a_quarter_car_has_not_cannot_be_varied(plan):
    chosen = plan(Axis(key="vehicle.body.mass_kg", values=(1.0,)))
    quarter = msgspec.structs.replace(chosen, scenario=chosen.scenario.with_variant("quarter-car"))
    with pytest.raises(ConfigError, match="nothing to the quarter car"):
        job(quarter, (1.0,), 0)


def test_the_scenario_names_the_law_it_was_driven_with(plan):
    assert job(plan(controller="pi"), (1400.0, 0.3), 0).scenario.controller.kind == "pi"
