"""What was compiled when the package was installed: the laws' steps in C, and the tick.

Numbers and arrays go in, numbers come out; what they mean is known to
`tcs_hil.control.native`.
"""

from __future__ import annotations

from functools import cache
from importlib import import_module
from importlib.machinery import EXTENSION_SUFFIXES
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tcs_hil.errors import ConfigError
from tcs_hil.native.sources import checksum, is_checkout

FloatArray = NDArray[np.float64]

_EXTENSION = "tcs_hil.native._core"
_TICK = "tcs_hil.pipeline"


@cache
def is_built() -> bool:
    """Is there a compiled step in this installation?"""
    return find_spec(_EXTENSION) is not None


@cache
def tick_is_compiled() -> bool:
    """Does the rest of a tick run as machine code (setup.py), or is it interpreted?"""
    spec = find_spec(_TICK)
    return spec is not None and (spec.origin or "").endswith(tuple(EXTENSION_SUFFIXES))


@cache
def core() -> Any:
    """The extension: ``ffi`` and ``lib``, as declared in ``interface.h``.

    Raises ConfigError in a checkout whose C has changed since: structs that are laid out
    in another way make nonsense without any sign of it.
    """
    extension, room = import_module(_EXTENSION), Path(__file__).parent
    if is_checkout(room) and getattr(extension.lib, "sources_checksum", None) != checksum(room):
        raise ConfigError(
            f"the native step was not built from the C in {room}: "
            "run pip install --no-build-isolation --no-deps -e ."
        )
    return extension


def array_of(memory: Any) -> FloatArray:
    """The doubles of an array in a C struct, as an array over the same memory."""
    return np.frombuffer(core().ffi.buffer(memory), np.float64)


def doubles(array: FloatArray) -> Any:
    """Pointer to the elements of an array, row by row; C is to have copied them on return."""
    return core().ffi.from_buffer("double[]", np.ascontiguousarray(array, dtype=np.float64))
