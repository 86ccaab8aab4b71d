"""The one seam to the compiler: numba turns the plant's pure functions into machine code.

Compiled functions read parameters as NumPy records.  A record has the fields
of the ``msgspec`` struct it was made from, so the functions are annotated with
the struct, and run on the struct itself when called through ``.py_func``.
"""

from __future__ import annotations

import hashlib
import os
from collections.abc import Callable
from pathlib import Path
from typing import Any, TypeVar, cast

import msgspec
import numba
import numpy as np

PACKAGE = Path(__file__).parent


def _cache_folder() -> Path:
    """Where machine code is kept: one folder per state of this package's sources.

    numba itself looks only at the file a function stands in, and would run a
    stale copy of what that function calls.
    """
    digest = hashlib.sha256()
    for source in sorted(PACKAGE.glob("*.py")):
        digest.update(source.read_bytes())
    home = PACKAGE / "__pycache__"
    if not os.access(PACKAGE, os.W_OK):
        home = Path(os.environ.get("XDG_CACHE_HOME", "~/.cache")).expanduser() / "plant-emulator"
    return home / f"numba-{digest.hexdigest()[:16]}"


if not numba.config.CACHE_DIR:  # type: ignore[attr-defined]
    numba.config.CACHE_DIR = str(_cache_folder())  # type: ignore[attr-defined]

F = TypeVar("F", bound=Callable[..., object])
S = TypeVar("S", bound=msgspec.Struct)


def compiled(function: F) -> F:
    """Compile ``function`` on first call; the machine code is cached on disk.

    Compiled code works in arrays it is given and makes none, so numba's run time
    (and its reference counts, which cost more than the physics) is left out.
    Floating point stays IEEE (no fast-math): lockstep runs give the same bytes.
    Division by zero gives inf or NaN, as in NumPy.
    """
    options: dict[str, Any] = {"cache": True, "error_model": "numpy", "_nrt": False}
    return cast(F, numba.njit(**options)(function))


def record(parameters: S) -> S:
    """Return ``parameters`` (nested structs of numbers) as the record compiled code takes."""
    array = np.array([_values(parameters)], _layout(parameters))
    return cast(S, array[0])


def _layout(parameters: msgspec.Struct) -> np.dtype[Any]:
    fields = [(name, getattr(parameters, name)) for name in parameters.__struct_fields__]
    return np.dtype(
        [(n, _layout(v) if isinstance(v, msgspec.Struct) else np.dtype(type(v))) for n, v in fields]
    )


def _values(parameters: msgspec.Struct) -> tuple[object, ...]:
    return tuple(
        _values(v) if isinstance(v, msgspec.Struct) else v
        for v in msgspec.structs.astuple(parameters)
    )
