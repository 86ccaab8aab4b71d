"""Tyre property files."""

import pytest

from plant_emulator.scenario import load_scenario
from plant_emulator.tir import read_tir
from tcs_hil.errors import ConfigError

GOOD = """\
[MDI_HEADER]
FILE_TYPE     ='tir'
FILE_FORMAT   = ASCII
! a comment, PCX1 = 99
[DIMENSION]
UNLOADED_RADIUS = 0.32      $unloaded radius
[SCALING_COEFFICIENTS]
LMUX = 0.9                  $scale of the peak
LKX  = 1.1
[VERTICAL]
FNOMIN  = 4.0E+3            $nominal load
[LONGITUDINAL_COEFFICIENTS]
PCX1 = +1.579
PDX1 = +1.0422
PDX2 = -0.08285
PEX1 = 0.11113
PKX1 = 21.687
PKX2 = 13.728
PKX3 = -0.4098
PTX1 = 0.8
[ROLLING_COEFFICIENTS]
QSY1 = -0.012
"""


@pytest.fixture
def tir(tmp_path):
    def write(text):
        path = tmp_path / "tyre.tir"
        path.write_text(text)
        return path

    return write


def test_coefficients_are_read_and_scaled(tir):
    tyre = read_tir(tir(GOOD))
    assert tyre.fnomin == 4000.0
    assert tyre.pdx1 == pytest.approx(0.9 * 1.0422)
    assert tyre.pkx1 == pytest.approx(1.1 * 21.687)
    assert (tyre.pcx1, tyre.pkx3, tyre.pex2) == (1.579, -0.4098, 0.0)
    assert tyre.qsy1 == 0.012
    assert tyre.relaxation_m == pytest.approx(0.8 * 0.32)


def test_without_relaxation_in_the_file_the_default_stays(tir):
    assert read_tir(tir(GOOD.replace("PTX1", "$PTX1"))).relaxation_m == 0.15


@pytest.mark.parametrize("name", ["FNOMIN", "PCX1", "PDX1", "PKX1"])
def test_a_missing_coefficient_is_named(tir, name):
    with pytest.raises(ConfigError, match=rf"tyre\.tir: {name} is missing"):
        read_tir(tir(GOOD.replace(f"\n{name}", f"\n${name}")))


def test_a_coefficient_that_is_no_number_is_named(tir):
    with pytest.raises(ConfigError, match="PCX1 is not a number: lots"):
        read_tir(tir(GOOD.replace("+1.579", "lots")))


def test_an_impossible_relaxation_is_named(tir):
    with pytest.raises(ConfigError, match="relaxation_m"):
        read_tir(tir(GOOD.replace("PTX1 = 0.8", "PTX1 = 80.0")))


def test_other_units_than_si_are_refused(tir):
    read_tir(tir("[UNITS]\nFORCE = 'newton'\nLENGTH = 'meter'\n" + GOOD))
    with pytest.raises(ConfigError, match="FORCE is in 'pound_force'"):
        read_tir(tir("[UNITS]\nFORCE = 'pound_force'\n" + GOOD))


def test_units_are_those_of_the_units_section_and_no_angle_is_read(tir):
    header = "[UNITS]\nANGLE = 'degrees'\nFORCE = 'newton'\n[MODEL]\nLENGTH = 'long'\n"
    assert read_tir(tir(header + GOOD)) == read_tir(tir(GOOD))


def test_a_byte_order_mark_is_no_part_of_the_first_name(tir):
    text = GOOD.replace("FNOMIN  = 4.0E+3            $nominal load\n", "")
    assert read_tir(tir("\ufeffFNOMIN = 4000\n" + text)) == read_tir(tir(GOOD))


@pytest.mark.parametrize("number", ["inf", "nan", "1e999"])
def test_a_coefficient_that_is_not_finite_is_named(tir, number):
    with pytest.raises(ConfigError, match=r"tyre\.tir: PEX1 is not finite"):
        read_tir(tir(GOOD.replace("0.11113", number)))


def test_a_missing_file_is_named(tmp_path):
    with pytest.raises(ConfigError, match=r"absent\.tir"):
        read_tir(tmp_path / "absent.tir")


def test_a_scenario_takes_its_tyre_from_a_file_beside_it(tir, tmp_path):
    tir(GOOD)
    path = tmp_path / "scenario.toml"
    path.write_text(
        'description = "t"\nduration_s = 1.0\n'
        '[driver]\nrequest = [[0.0, 1.0]]\n[vehicle]\ntyre_file = "tyre.tir"\n'
    )
    assert load_scenario(path).vehicle.tyre.pcx1 == 1.579
