"""What a suite was run with."""

from __future__ import annotations

import platform
from importlib.metadata import PackageNotFoundError, version

PACKAGES = ("tcs-hil", "python-can", "cantools", "numpy", "osqp", "casadi", "numba")


def versions() -> dict[str, str]:
    """Versions of this package, of Python and of what the figures may depend on."""
    return {"python": platform.python_version()} | {name: _version(name) for name in PACKAGES}


def _version(name: str) -> str:
    try:
        return version(name)
    except PackageNotFoundError:
        return "not installed"  # run from a checkout
