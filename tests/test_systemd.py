"""The units: valid, and as closed as a service that needs a bus and real time can be."""

import shutil
import subprocess
from pathlib import Path

import pytest

UNITS = sorted((Path(__file__).resolve().parent.parent / "systemd").glob("*.service"))
EXPOSURE_LIMIT_TENTHS = 15

pytestmark = pytest.mark.skipif(
    shutil.which("systemd-analyze") is None, reason="systemd-analyze is not installed"
)


@pytest.mark.parametrize("unit", UNITS, ids=lambda unit: unit.name)
def test_the_exposure_of_a_unit_is_low(unit: Path) -> None:
    limit = f"--threshold={EXPOSURE_LIMIT_TENTHS}"
    subprocess.run(["systemd-analyze", "security", "--offline=true", limit, unit], check=True)


def test_systemd_finds_nothing_wrong_with_the_units(tmp_path: Path) -> None:
    for unit in UNITS:
        # The programs are not installed here; verify wants to see them.
        text = unit.read_text().replace("/opt/tcs-hil/bin/", "/usr/bin/env ")
        (tmp_path / unit.name).write_text(text)
    verify = ["systemd-analyze", "verify", "--man=no", *sorted(tmp_path.iterdir())]
    found = subprocess.run(verify, check=True, capture_output=True, text=True)
    assert str(tmp_path) not in found.stderr
