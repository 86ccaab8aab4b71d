"""A small FMU made on the spot: the paper's quarter car, compiled for this machine."""

import platform
import re
import subprocess
import zipfile
from pathlib import Path

import fmpy

SOURCE = Path(__file__).with_name("car.c")
HEADERS = Path(fmpy.__file__).with_name("c-code")
GUID = "quarter-car"

VARIABLES = (
    ("torque_demand_fl_nm", "input"),
    ("torque_demand_fr_nm", "input"),
    ("mu_fl", "input"),
    ("mu_fr", "input"),
    ("speed_mps", "output"),
    ("wheel_speed_fl_radps", "output"),
    ("wheel_speed_fr_radps", "output"),
    ("wheel_speed_rl_radps", "output"),
    ("wheel_speed_rr_radps", "output"),
    ("start_speed_mps", "parameter"),
    ("mass_kg", "parameter"),
)


def build_unit(path: Path, version: int, renamed: dict[str, str] | None = None) -> Path:
    """Compile and pack the unit as FMI ``version``, its variables ``renamed``."""
    binary, rest = path.with_suffix(".so"), path.with_suffix(".c")
    rest.write_text(_rest_of_the_interface(version))
    flags = ["-shared", "-fPIC", "-O2", f"-I{HEADERS}", *(["-DFMI3"] if version == 3 else [])]
    subprocess.run(["gcc", *flags, "-o", binary, SOURCE, rest, "-lm"], check=True)
    folder = "linux64" if version == 2 else f"{platform.machine()}-linux"
    names = [((renamed or {}).get(name, name), causality) for name, causality in VARIABLES]
    with zipfile.ZipFile(path, "w") as archive:
        archive.writestr("modelDescription.xml", _fmi2(names) if version == 2 else _fmi3(names))
        archive.write(binary, f"binaries/{folder}/car.so")
    return path


def _rest_of_the_interface(version: int) -> str:
    """Every function a unit must export and ours does without, refusing (fmi2Error, fmi3Error)."""
    header = (HEADERS / f"fmi{version}Functions.h").read_text()
    exported = set(re.findall(rf"\b(fmi{version}[A-Z]\w*)TYPE\b", header))
    ours = set(re.findall(rf"\b(fmi{version}[A-Z]\w*)\(", SOURCE.read_text()))
    return "".join(f"int {name}(void) {{ return 3; }}\n" for name in sorted(exported - ours))


def _fmi2(names: list[tuple[str, str]]) -> str:
    scalars = "".join(
        f'<ScalarVariable name="{name}" valueReference="{place}" causality="{causality}"'
        f"{_variability(causality)}><Real{_start(causality)}/></ScalarVariable>"
        for place, (name, causality) in enumerate(names)
    )
    return (
        f'<fmiModelDescription fmiVersion="2.0" modelName="car" guid="{GUID}">'
        f'<CoSimulation modelIdentifier="car"/><ModelVariables>{scalars}</ModelVariables>'
        f"<ModelStructure/></fmiModelDescription>"
    )


def _fmi3(names: list[tuple[str, str]]) -> str:
    scalars = "".join(
        f'<Float64 name="{name}" valueReference="{place}" causality="{causality}"'
        f"{_variability(causality)}{_start(causality)}/>"
        for place, (name, causality) in enumerate(names)
    )
    return (
        f'<fmiModelDescription fmiVersion="3.0" modelName="car" instantiationToken="{GUID}">'
        f'<CoSimulation modelIdentifier="car"/><ModelVariables>{scalars}</ModelVariables>'
        f"<ModelStructure/></fmiModelDescription>"
    )


def _variability(causality: str) -> str:
    return ' variability="fixed"' if causality == "parameter" else ""


def _start(causality: str) -> str:
    return "" if causality == "output" else ' start="0"'
