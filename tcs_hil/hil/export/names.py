"""Units out of the names of this project, which end in them, and names of a field's wheels."""

from __future__ import annotations

UNITS = {
    "nm": "Nm",
    "n": "N",
    "radps": "rad/s",
    "rad": "rad",
    "mps2": "m/s2",
    "mps": "m/s",
    "m": "m",
    "s": "s",
    "us": "us",
    "ns": "ns",
}
"""As the DBC writes them."""
NO_UNIT = "-"

WHEELS = ("fl", "fr", "rl", "rr")


def unit_of(name: str) -> str:
    """``wheel_speed_fl_radps`` is in rad/s."""
    return UNITS.get(name.rpartition("_")[2], NO_UNIT)


def wheel_names(name: str, count: int) -> list[str]:
    """Names of the columns of a field with ``count`` wheels, motors or shafts.

    As in the telemetry: ``limit_nm`` becomes ``limit_fl_nm``, ``mu`` ``mu_fl``.
    """
    stem, _, last = name.rpartition("_")
    if not stem or last not in UNITS:
        return [f"{name}_{wheel}" for wheel in WHEELS[:count]]
    return [f"{stem}_{wheel}_{last}" for wheel in WHEELS[:count]]
