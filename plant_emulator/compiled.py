"""The one seam to the compiler: numba turns the plant's pure functions into machine code.

Compiled functions read parameters as NumPy records.  A record has the fields
of the ``msgspec`` struct it was made from, so the functions are annotated with
the struct: same names, same types.
"""

from __future__ import annotations

import contextlib
import hashlib
import os
import tempfile
from collections.abc import Callable, Iterator, Sequence
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
    for home in _homes():
        folder = home / f"numba-{digest.hexdigest()[:16]}"
        with contextlib.suppress(OSError):
            folder.mkdir(parents=True, exist_ok=True)
        if os.access(folder, os.W_OK):
            return folder
    return Path(tempfile.mkdtemp(prefix="plant-emulator."))  # in a sandbox: compile every time


def _homes() -> Iterator[Path]:
    yield PACKAGE / "__pycache__"
    with contextlib.suppress(RuntimeError):  # a user without a home
        yield Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache") / "plant-emulator"


if not numba.config.CACHE_DIR:  # type: ignore[attr-defined]
    numba.config.CACHE_DIR = str(_cache_folder())  # type: ignore[attr-defined]

F = TypeVar("F", bound=Callable[..., object])
S = TypeVar("S", bound=msgspec.Struct)


def compiled(function: F) -> F:
    """Compile ``function`` on first call; the machine code is cached on disk.

    Calls between compiled functions are inlined: passing arrays from one to the
    other would cost as much as the physics.  Floating point stays IEEE (no
    fast-math): lockstep runs give the same bytes.  Division by zero gives inf or
    NaN, as in NumPy.
    """
    options: dict[str, Any] = {"cache": True, "error_model": "numpy", "forceinline": True}
    return cast(F, numba.njit(**options)(function))


def records(parameters: S) -> Sequence[S]:
    """Return ``parameters`` (nested structs of numbers) as an array of one record.

    Python hands an array to compiled code in a tenth of the time it takes to
    hand over the record in it.
    """
    return cast(Sequence[S], np.array([_values(parameters)], _layout(parameters)))


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
