"""The one seam to the compiler: numba turns the plant's pure functions into machine code.

Compiled functions find parameters and memory in NumPy records.  A record has the
fields of the ``msgspec`` struct or named tuple it was made from, so the functions
are annotated with that: same names, same types.
"""

from __future__ import annotations

import contextlib
import functools
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
S = TypeVar("S")


def compiled(function: F) -> F:
    """Compile ``function`` on first call; the machine code is cached on disk.

    Calls between compiled functions are inlined: passing arrays from one to the
    other would cost as much as the physics.  Floating point stays IEEE (no
    fast-math): lockstep runs give the same bytes.  Division by zero gives inf or
    NaN, as in NumPy.
    """
    options: dict[str, Any] = {"cache": True, "error_model": "numpy", "forceinline": True}
    return cast(F, numba.njit(**options)(function))


def records(parts: S) -> Sequence[S]:
    """Return ``parts``, a struct or named tuple of numbers, arrays and more such, as one record.

    The record stands in an array, which Python hands to compiled code in a tenth of
    the time it takes to hand over the record in it, or the parts one by one.  What
    the parts hold is copied: from then on it lives in the record.
    """
    return cast(Sequence[S], np.array([_values(parts)], _same(_layout(parts))))


def opened(record: Sequence[S]) -> S:
    """Return the parts of a record of `records`; arrays among them are the record's own memory."""
    return cast(S, np.asarray(record).view(np.recarray)[0])


@functools.cache
def _same(layout: np.dtype[Any]) -> np.dtype[Any]:
    """The first layout that was equal: every call compares those that are not the very same."""
    return layout


def _layout(parts: object) -> np.dtype[Any]:
    return np.dtype([(name, *_shape(value)) for name, value in _fields(parts)])


def _shape(value: object) -> tuple[Any, ...]:
    if isinstance(value, np.ndarray):
        return value.dtype, value.shape
    return (np.dtype(type(value)) if isinstance(value, float | int) else _layout(value),)


def _values(parts: object) -> object:
    if isinstance(parts, np.ndarray | float | int):
        return parts
    return tuple(_values(value) for _, value in _fields(parts))


def _fields(parts: Any) -> Iterator[tuple[str, object]]:
    names = parts.__struct_fields__ if isinstance(parts, msgspec.Struct) else parts._fields
    return ((name, getattr(parts, name)) for name in names)
