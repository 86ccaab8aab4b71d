"""The units: valid, as closed as a service that needs a bus and real time can be, and removable."""

import os
import shutil
import subprocess
from pathlib import Path

import pytest
from needs import needs

from tcs_hil.config import read_toml
from tcs_hil.service.settings import ServiceConfig

PROJECT = Path(__file__).resolve().parent.parent
SHIPPED = PROJECT / "systemd"
UNITS = sorted(SHIPPED.glob("*.service"))
CONFIGURATION = Path("etc/tcs-hil/tcs-hil.toml")
EXPOSURE_LIMIT_TENTHS = 15


@pytest.fixture
def systemd_analyze() -> str:
    return needs(shutil.which("systemd-analyze"), "systemd-analyze (apt-get install systemd)")


@pytest.mark.parametrize("unit", UNITS, ids=lambda unit: unit.name)
def test_the_exposure_of_a_unit_is_low(unit: Path, systemd_analyze: str) -> None:
    limit = f"--threshold={EXPOSURE_LIMIT_TENTHS}"
    subprocess.run([systemd_analyze, "security", "--offline=true", limit, unit], check=True)


def test_systemd_finds_nothing_wrong_with_the_units(tmp_path: Path, systemd_analyze: str) -> None:
    for unit in UNITS:
        # The programs are not installed here; verify wants to see them.
        text = unit.read_text().replace("/opt/tcs-hil/bin/", "/usr/bin/env ")
        (tmp_path / unit.name).write_text(text)
    verify = [systemd_analyze, "verify", "--man=no", *sorted(tmp_path.iterdir())]
    found = subprocess.run(verify, check=True, capture_output=True, text=True)
    assert str(tmp_path) not in found.stderr


def test_the_shipped_configuration_is_accepted_and_its_recording_is_where_the_units_look() -> None:
    config = read_toml(SHIPPED / "tcs-hil.toml", ServiceConfig)
    assert config.bus.interface == "socketcan"  # a service never falls back to another bus
    assert config.recorder.path == "/run/tcs-hil/flight"
    assert "RuntimeDirectory=tcs-hil\n" in (SHIPPED / "tcs-hil.service").read_text()
    assert " %t/tcs-hil/flight " in (SHIPPED / "tcs-hil-metrics.service").read_text()


def test_the_unit_allows_the_priority_and_the_memory_that_the_configuration_asks_for() -> None:
    unit = (SHIPPED / "tcs-hil.service").read_text()
    (limit,) = (line for line in unit.splitlines() if line.startswith("LimitRTPRIO="))
    config = read_toml(SHIPPED / "tcs-hil.toml", ServiceConfig)
    assert int(limit.partition("=")[2]) >= config.tick.priority
    assert "LimitMEMLOCK=infinity" in unit


def make(target: str, root: Path) -> str:
    command = ["make", "--no-print-directory", "-C", PROJECT, target]
    ended = subprocess.run(
        command, env=os.environ | {"DESTDIR": str(root)}, check=True, capture_output=True, text=True
    )
    return ended.stdout


def files_below(root: Path) -> set[Path]:
    return {path.relative_to(root) for path in root.rglob("*") if path.is_file()}


def test_everything_shipped_is_installed_where_systemd_looks(tmp_path: Path) -> None:
    make("install-service", tmp_path)
    installed = files_below(tmp_path)
    assert CONFIGURATION in installed
    assert {Path("etc/systemd/system", unit.name) for unit in UNITS} <= installed
    assert Path("etc/systemd/network/80-can0.network") in installed
    assert len(installed) == len(list(SHIPPED.iterdir()))


def test_uninstalling_leaves_nothing_behind(tmp_path: Path) -> None:
    make("install-service", tmp_path)
    make("uninstall-service", tmp_path)
    assert files_below(tmp_path) == set()


def test_a_configuration_that_was_edited_survives_update_and_removal(tmp_path: Path) -> None:
    make("install-service", tmp_path)
    (tmp_path / CONFIGURATION).write_text("controller = 'pi'\n")
    make("install-service", tmp_path)
    assert "kept" in make("uninstall-service", tmp_path)
    assert files_below(tmp_path) == {CONFIGURATION}
    assert (tmp_path / CONFIGURATION).read_text() == "controller = 'pi'\n"
