"""Tyre property files (.tir) of MF-Tyre 5.2 and its relatives."""

from __future__ import annotations

import codecs
import math
import re
from pathlib import Path

import msgspec

from plant_emulator.tyre import Tyre
from tcs_hil.errors import ConfigError

_LINE = re.compile(r"^\s*([A-Z][A-Z0-9_]*)\s*=\s*([^$!\s]+)", re.IGNORECASE)

_SCALES = {
    "fnomin": ("LFZO",),
    "pcx1": ("LCX",),
    "pdx1": ("LMUX",),
    "pdx2": ("LMUX",),
    "pex1": ("LEX",),
    "pex2": ("LEX",),
    "pex3": ("LEX",),
    "pkx1": ("LKX",),
    "pkx2": ("LKX",),
    "phx1": ("LHX",),
    "phx2": ("LHX",),
    "pvx1": ("LVX", "LMUX"),
    "pvx2": ("LVX", "LMUX"),
    "qsy1": ("LMY",),
}
"""Scale factors of the file that multiply each coefficient (Pacejka, Sec. 4.3.2)."""

_RELAXATION = ("PTX1", "LSGKP", "UNLOADED_RADIUS")
_USED = {*(name.upper() for name in (*_SCALES, "pex4", "pkx3")), *_RELAXATION}
_USED |= {factor for factors in _SCALES.values() for factor in factors}

_SECTION = re.compile(r"^\s*\[\s*([A-Z0-9_]+)\s*\]", re.IGNORECASE)
_UNITS = ("FORCE", "LENGTH", "MASS", "TIME")  # no angle is read
_SI = ("newton", "meter", "metre", "kg", "kilogram", "second", "n", "m", "s")

_REQUIRED = ("fnomin", "pcx1", "pdx1", "pkx1")


def read_tir(path: Path) -> Tyre:
    """Read the longitudinal coefficients of a tyre property file in SI units.

    What the file leaves out is zero, scale factors are one.  The relaxation length
    comes from pTx1..3 at nominal load where the file has them.  A negative
    rolling-resistance coefficient (the sign convention of some tools) counts as
    positive.  Slip in the file is rim over ground speed less one; see `Tyre` for ours.

    Raises:
        ConfigError: the file cannot be read, is not in SI units, or a coefficient is
            missing or no finite number.
    """
    table = _read_table(path)
    coefficients = {
        name: table.get(name.upper(), 0.0) * _scale(table, name)
        for name in (*_SCALES, "pex4", "pkx3")
    }
    coefficients["qsy1"] = abs(coefficients["qsy1"])
    for name in _REQUIRED:
        if coefficients[name] <= 0.0:
            raise ConfigError(f"{path}: {name.upper()} is missing or not positive")
    relaxation_m = _relaxation_m(table)
    if relaxation_m is not None:
        coefficients["relaxation_m"] = relaxation_m
    try:
        return msgspec.convert(coefficients, Tyre)
    except msgspec.ValidationError as error:
        raise ConfigError(f"{path}: {error}") from error


def _read_table(path: Path) -> dict[str, float]:
    try:
        content = path.read_bytes().removeprefix(codecs.BOM_UTF8)
    except (OSError, ValueError) as error:  # ValueError: no name a file can have
        raise ConfigError(f"{path}: cannot be read ({error})") from error
    table, section = {}, ""
    for line in content.decode("latin-1").splitlines():  # comments in any language
        if opened := _SECTION.match(line):
            section = opened[1].upper()
        if (found := _LINE.match(line)) is None:
            continue
        name, text = found[1].upper(), found[2]
        if section == "UNITS":
            _check_unit(path, name, text.strip("'\""))
        elif name in _USED:
            table[name] = _number(path, name, text)
    return table


def _check_unit(path: Path, name: str, unit: str) -> None:
    if name in _UNITS and unit.lower() not in _SI:
        raise ConfigError(f"{path}: {name} is in {unit!r}; only SI units are read")


def _number(path: Path, name: str, text: str) -> float:
    try:
        number = float(text)
    except ValueError as error:
        raise ConfigError(f"{path}: {name} is not a number: {text}") from error
    if not math.isfinite(number):
        raise ConfigError(f"{path}: {name} is not finite: {text}")
    return number


def _scale(table: dict[str, float], name: str) -> float:
    product = 1.0
    for factor in _SCALES.get(name, ()):
        product *= table.get(factor, 1.0)
    return product


def _relaxation_m(table: dict[str, float]) -> float | None:
    """sigma_kappa = F_z (pTx1 + pTx2 dfz) exp(-pTx3 dfz) R0 / F_z0, at dfz = 0."""
    if table.get("PTX1", 0.0) <= 0.0:
        return None
    return table["PTX1"] * table.get("UNLOADED_RADIUS", 0.3) * table.get("LSGKP", 1.0)
