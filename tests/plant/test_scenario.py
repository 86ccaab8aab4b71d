"""Scenario files: what is shipped is good, what is wrong is refused in one sentence."""

import pytest

from plant_emulator.scenario import list_scenarios, load_scenario
from tcs_hil.errors import ConfigError

MINIMAL = """
description = "a test"
duration_s = 1.0
[driver]
request = [[0.0, 100.0]]
"""

GARBAGE = '[[fault]]\ntarget = "WheelSpeedFL"\nkind = "garbage"\n'


def refusal(tmp_path, text):
    path = tmp_path / "bad.toml"
    path.write_text(text)
    with pytest.raises(ConfigError) as caught:
        load_scenario(path)
    message = str(caught.value)
    assert str(tmp_path) in message
    assert "\n" not in message
    return message


def test_every_shipped_scenario_loads_by_its_name():
    listings = list_scenarios()
    assert {"manoeuvre-1", "manoeuvre-2"} <= {listing.name for listing in listings}
    for listing in listings:
        assert load_scenario(listing.name).description == listing.description


def test_names_of_shipped_scenarios_are_unique():
    names = [listing.name for listing in list_scenarios()]
    assert len(names) == len(set(names))


def test_a_minimal_file_is_enough(tmp_path):
    path = tmp_path / "minimal.toml"
    path.write_text(MINIMAL)
    scenario = load_scenario(path)
    assert scenario.vehicle.variant == "vehicle"
    assert scenario.driver.request == ((0.0, 100.0),)


def test_an_unknown_name_is_refused_by_name():
    with pytest.raises(ConfigError, match="'no-such-thing'"):
        load_scenario("no-such-thing")


def test_a_road_file_no_file_can_be_is_refused(tmp_path):
    text = MINIMAL.replace("[driver]", 'road_file = "a\\u0000b.csv"\n[driver]')
    assert "road_file" in refusal(tmp_path, text)


@pytest.mark.parametrize("name", ["*", "**", "manoeuvre-?", "[m]anoeuvre-1", "x" * 5000, ""])
def test_a_name_is_no_pattern(name):
    with pytest.raises(ConfigError, match=r"neither a \.toml file nor one that is shipped"):
        load_scenario(name)


def test_a_missing_file_is_refused(tmp_path):
    with pytest.raises(ConfigError, match=r"absent\.toml"):
        load_scenario(tmp_path / "absent.toml")


@pytest.mark.parametrize(
    ("addition", "named"),
    [
        ("[[road]]\nmu = 0.3\nslope = 1.0\n", "slope"),
        ("[[road]]\nmu = -0.3\n", "mu"),
        ("[[road]]\nmu = 0.3\nmu_left = 0.2\n", "mu_left"),
        ("[[road]]\nmu_left = 0.3\n", "mu_right"),
        ("[[road]]\nmu = 0.3\n[[road]]\nmu = 0.1\n", "from_m"),
        ('[vehicle]\nvariant = "boat"\n', "variant"),
        ("[vehicle.quarter_car]\nmass_kg = 0\n", "mass_kg"),
        ('[controller]\nkind = "magic"\n', "kind"),
        ('[[expect]]\nop = "<"\nvalue = 1.0\n', "signal"),
        ('[[expect]]\nop = "<"\nvalue = 1.0\nmetric = "peak"\nfrom_s = 2.0\nto_s = 1.0\n', "to_s"),
        ("[brakes]\n", "brakes"),
        (5 * '[[fault]]\ntarget = "TcsStatus"\nkind = "duplicated"\n', "duplicated"),
        ("[vehicle.body]\nmass_kg = 150\n", "mass_kg"),
        ("[vehicle.body]\nwheelbase_m = 1.2\n", "wheelbase_m"),
        ("[bus]\nlimit_delay_s = inf\n", "limit_delay_s"),
        ("[vehicle.body]\nmass_kg = nan\n", "mass_kg"),
        ("[vehicle.tyre]\nphx1 = -inf\n", "phx1"),
        ("[sensors]\naccel_bias_mps2 = 1e300\n", "accel_bias_mps2"),
        ('[vehicle]\ntyre_file = "a\\u0000b.tir"\n', "vehicle.tyre_file"),
        (GARBAGE + "low = 2.0\nhigh = 1.0\n", "low"),
        (GARBAGE + "high = inf\n", "high"),
        (GARBAGE + "low = nan\n", "low"),
        ('[[fault]]\ntarget = "MotorState"\nkind = "delayed"\ndelay_s = inf\n', "delay_s"),
        ('[[fault]]\ntarget = "VEHICLE"\nkind = "babbling"\nperiod_s = inf\n', "period_s"),
        (
            '[[fault]]\ntarget = "WheelSpeedFL"\nkind = "tooth-missing"\n'
            "tooth = 99999999999999999999\n",
            "tooth",
        ),
    ],
)
def test_a_wrong_key_or_value_is_refused_by_name(tmp_path, addition, named):
    assert named in refusal(tmp_path, MINIMAL + addition)


def test_a_driver_that_goes_back_in_time_is_refused(tmp_path):
    text = MINIMAL.replace("[[0.0, 100.0]]", "[[1.0, 100.0], [0.5, 0.0]]")
    assert "request" in refusal(tmp_path, text)


def test_the_car_can_be_exchanged():
    scenario = load_scenario("manoeuvre-1")
    assert scenario.with_variant("vehicle").vehicle.variant == "vehicle"
    assert scenario.with_variant("vehicle").road == scenario.road
