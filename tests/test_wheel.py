"""The wheel works without the checkout: in an environment that has only our dependencies."""

import os
import shutil
import subprocess
import sys
import sysconfig
import venv
import zipfile
from pathlib import Path

import pytest
from needs import needs

ROOT = Path(__file__).resolve().parent.parent
PACKAGES = ("tcs_hil", "plant_emulator")
NOT_SOURCES = shutil.ignore_patterns(
    ".*", "__pycache__", "*.egg-info", "*.so", "build", "dist", "runs"
)
KINDS_OF_DATA = {".css", ".dbc", ".j2", ".js", ".LICENSE", ".npz", ".toml"}
DECIDED_BY = """
from tcs_hil.control.backend import chosen_backend
from tcs_hil.control.factory import make_controller
from tcs_hil.control.protocol import WheelState
from tcs_hil.control.settings import ControlSettings
from tcs_hil.model.bank import KoopmanBank, default_bank_path
from tcs_hil.model.vehicle import Vehicle
from tcs_hil.signals import ControllerKind
settings = ControlSettings()
bank = KoopmanBank.load(default_bank_path(), settings.period_s)
law = make_controller(ControllerKind.KMPC, settings, Vehicle(), bank)
law.step(WheelState.at_rest(), 100.0)
print(chosen_backend(ControllerKind.KMPC, settings))
"""
"""A program that lets the default law decide, and says which code it was."""


def built(folder: Path, **environment: str) -> Path:
    # From a copy: setuptools would pack what an earlier build left in the checkout.
    sources = shutil.copytree(ROOT, folder / "sources", symlinks=True, ignore=NOT_SOURCES)
    build = [sys.executable, "-m", "build", "--wheel", "--no-isolation", "--outdir", str(folder)]
    subprocess.run([*build, str(sources)], check=True, env=os.environ | environment)
    return next(folder.glob("*.whl"))


@pytest.fixture(scope="module")
def wheel(tmp_path_factory: pytest.TempPathFactory) -> Path:
    # The compiled tick is for scripts/check to build: here it would take a minute for nothing.
    return built(tmp_path_factory.mktemp("wheel"), TCS_HIL_INTERPRETED="1")


@pytest.fixture(scope="module")
def installed(wheel: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    return programs(wheel, tmp_path_factory.mktemp("environment"))


def programs(wheel: Path, folder: Path) -> Path:
    """The programs of an environment with the wheel, and our dependencies by reference."""
    venv.create(folder, symlinks=True)
    python = folder / "bin" / "python"
    install = ["-m", "pip", "--python", str(python), "install", "--no-deps", "--no-index"]
    subprocess.run([sys.executable, *install, str(wheel)], check=True)
    site = next(folder.glob("lib/python*/site-packages"))
    (site / "dependencies.pth").write_text(sysconfig.get_path("purelib") + "\n")
    return folder / "bin"


def output(program: Path, *arguments: str, folder: Path) -> str:
    env = {name: value for name, value in os.environ.items() if name != "PYTHONPATH"}
    command = [str(program), *arguments]
    return subprocess.run(
        command, cwd=folder, env=env, check=True, stdout=subprocess.PIPE
    ).stdout.decode()


def package_files(root: Path) -> set[str]:
    files = (path for name in PACKAGES for path in (root / name).rglob("*") if path.is_file())
    return {
        str(path.relative_to(root))
        for path in files
        if "__pycache__" not in path.parts and path.suffix != ".so"  # compiled where it is used
    }


def test_the_wheel_holds_every_file_of_the_packages(wheel: Path) -> None:
    packed = {name for name in zipfile.ZipFile(wheel).namelist() if ".dist-info/" not in name}
    assert {name for name in packed if not name.endswith(".so")} == package_files(ROOT)
    assert {Path(name).suffix for name in packed} >= KINDS_OF_DATA


def test_the_installed_packages_are_not_the_checkout(installed: Path, tmp_path: Path) -> None:
    where = "import tcs_hil, plant_emulator; print(tcs_hil.__file__, plant_emulator.__file__)"
    assert str(ROOT) not in output(installed / "python", "-c", where, folder=tmp_path)


@pytest.mark.parametrize("program", ["tcs-hil", "plant-emulator"])
def test_an_installed_program_explains_itself(
    program: str, installed: Path, tmp_path: Path
) -> None:
    assert f"Usage: {program}" in output(installed / program, "--help", folder=tmp_path)


def test_the_installed_emulator_lists_every_scenario(installed: Path, tmp_path: Path) -> None:
    listed = output(installed / "plant-emulator", "list", folder=tmp_path)
    scenarios = ROOT / "plant_emulator" / "scenarios"
    missing = [path.stem for path in scenarios.rglob("*.toml") if path.stem not in listed]
    assert missing == []


def test_with_a_compiler_the_installed_laws_are_native(installed: Path, tmp_path: Path) -> None:
    needs(shutil.which("cc"), "a C compiler (apt-get install gcc)")
    decided_by = output(installed / "python", "-c", DECIDED_BY, folder=tmp_path)
    assert decided_by.strip() == "native"


def test_without_a_compiler_the_wheel_is_built_and_the_laws_run_in_python(tmp_path: Path) -> None:
    wheel = built(tmp_path, CC="false", TCS_HIL_INTERPRETED="1")
    assert not [name for name in zipfile.ZipFile(wheel).namelist() if name.endswith(".so")]
    python = programs(wheel, tmp_path / "environment") / "python"
    assert output(python, "-c", DECIDED_BY, folder=tmp_path).strip() == "python"
