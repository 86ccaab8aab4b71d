"""Roads from CSV files."""

import pytest

from plant_emulator.road import Patch
from plant_emulator.road_file import read_road
from plant_emulator.scenario import load_scenario
from tcs_hil.errors import ConfigError


@pytest.fixture
def road(tmp_path):
    def write(text):
        path = tmp_path / "road.csv"
        path.write_text(text)
        return path

    return write


def test_patches_are_read_and_empty_cells_left_out(road):
    text = "from_m,mu,mu_left,mu_right,grade,scaling\n0,0.6,,,,\n12.5,,0.1,0.3,-0.05,peak\n"
    assert read_road(road(text)) == (
        Patch(mu=0.6),
        Patch(from_m=12.5, mu_left=0.1, mu_right=0.3, grade=-0.05, scaling="peak"),
    )


def test_a_byte_order_mark_and_spaces_after_commas_are_no_part_of_a_name(road):
    assert read_road(road("\ufefffrom_m, mu\n0, 0.6\n")) == (Patch(mu=0.6),)


@pytest.mark.parametrize(
    ("text", "named"),
    [
        ("from_m,mu\n", "at least one patch"),
        ("from_m,mu\n0,slippery\n", "mu"),
        ("from_m,mu,colour\n0,0.3,black\n", "colour"),
        ("from_m,mu\n5,0.3\n5,0.2\n", "from_m must increase"),
    ],
)
def test_a_bad_road_is_refused_by_name(road, text, named):
    with pytest.raises(ConfigError, match=rf"road\.csv: .*{named}"):
        read_road(road(text))


def test_a_missing_file_is_named(tmp_path):
    with pytest.raises(ConfigError, match=r"absent\.csv"):
        read_road(tmp_path / "absent.csv")


def test_a_scenario_takes_its_road_from_a_file_beside_it(road, tmp_path):
    road("from_m,mu\n0,0.25\n")
    path = tmp_path / "scenario.toml"
    path.write_text(
        'description = "t"\nduration_s = 1.0\nroad_file = "road.csv"\n'
        "[driver]\nrequest = [[0.0, 1.0]]\n"
    )
    assert load_scenario(path).road == (Patch(mu=0.25),)
