"""Which code decides: the native step, or the same law in Python."""

from __future__ import annotations

from typing import Literal

from tcs_hil import native
from tcs_hil.control.settings import ControlSettings
from tcs_hil.errors import ConfigError
from tcs_hil.signals import ControllerKind

Backend = Literal["native", "python"]

NATIVE_LAWS = {
    ("paper", ControllerKind.KMPC),
    ("paper", ControllerKind.NMPC),
    ("default", ControllerKind.KMPC),
    ("default", ControllerKind.NMPC),
}
"""Presets and laws that have a native step."""


def chosen_backend(kind: ControllerKind, settings: ControlSettings) -> Backend:
    """What runs a law.

    Raises ConfigError if ``backend`` asks for a native step that was not built, or
    that this law does not have.
    """
    exists = (settings.preset, kind) in NATIVE_LAWS
    if settings.backend == "native":
        if not exists:
            raise ConfigError(
                f"backend is native, but {kind.name} of preset {settings.preset} has no native step"
            )
        if not native.is_built():
            raise ConfigError(
                "backend is native, but no native step was built: install a C compiler, "
                "then tcs-hil again"
            )
    return "native" if exists and native.is_built() and settings.backend != "python" else "python"
