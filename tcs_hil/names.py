"""What the names of quantities say: a unit at their end, and which wheel they are of."""

from __future__ import annotations

WHEELS = ("fl", "fr", "rl", "rr")
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


def unit_of(name: str) -> str:
    """``wheel_speed_fl_radps`` is in rad/s."""
    return UNITS.get(name.rpartition("_")[2], NO_UNIT)


def column_names(name: str, shape: tuple[int, ...]) -> tuple[str, ...]:
    """Names of the columns of a field: its own, or one for each wheel, motor or shaft it has.

    The wheel stands before the unit: ``limit_nm`` of shape (2,) has the columns
    ``limit_fl_nm`` and ``limit_fr_nm``, ``mu`` has ``mu_fl``...
    """
    if not shape:
        return (name,)
    stem, _, unit = name.rpartition("_")
    of_wheel = f"{stem}_{{}}_{unit}" if stem and unit in UNITS else f"{name}_{{}}"
    return tuple(of_wheel.format(wheel) for wheel in WHEELS[: shape[0]])
