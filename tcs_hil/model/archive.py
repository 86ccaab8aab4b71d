"""Arrays and metadata in one checked file: a plain npz that NumPy and unzip also open.

Members are ``NAME.npy``, ``metadata.json`` and ``sha256``, the digest over all
others.  It catches damage and edits; it is no signature against an attacker.
Equal content gives equal bytes: nothing is compressed and nothing is dated.
"""

from __future__ import annotations

import hashlib
import io
import zipfile
from collections.abc import Mapping
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from tcs_hil.errors import ModelError

FloatArray = NDArray[np.float64]

_METADATA = "metadata.json"
_DIGEST = "sha256"
_NO_DATE = (1980, 1, 1, 0, 0, 0)
_UNREADABLE = (zipfile.BadZipFile, ValueError, EOFError, OSError, RuntimeError)
"""What zipfile and NumPy raise on a damaged file; RuntimeError means encryption."""


def write(path: Path, metadata: bytes, arrays: Mapping[str, FloatArray]) -> None:
    """Write the file.  Raises ModelError if the path cannot be written."""
    members = {f"{name}.npy": _to_npy(array) for name, array in arrays.items()}
    members[_METADATA] = metadata
    members[_DIGEST] = _digest(members)
    packed = io.BytesIO()
    with zipfile.ZipFile(packed, "w") as archive:
        for name, content in sorted(members.items()):
            archive.writestr(zipfile.ZipInfo(name, _NO_DATE), content)
    try:
        path.write_bytes(packed.getvalue())
    except OSError as error:
        raise ModelError(f"model file '{path}' cannot be written: {error.strerror}") from error


def read(path: Path) -> tuple[bytes, dict[str, FloatArray]]:
    """Metadata and arrays, unchanged since written.  Raises ModelError naming the file."""
    members = _unpack(path, _content(path))
    digest = members.pop(_DIGEST, None)
    if digest is None or _METADATA not in members:
        raise ModelError(f"model file '{path}' is incomplete: no {_DIGEST} or no {_METADATA}")
    if digest != _digest(members):
        raise ModelError(f"model file '{path}' was altered after it was written")
    metadata = members.pop(_METADATA)
    return metadata, {name.removesuffix(".npy"): _array(path, c) for name, c in members.items()}


def _content(path: Path) -> bytes:
    try:
        return path.read_bytes()
    except OSError as error:
        raise ModelError(f"model file '{path}' cannot be read: {error.strerror}") from error


def _unpack(path: Path, content: bytes) -> dict[str, bytes]:
    try:
        with zipfile.ZipFile(io.BytesIO(content)) as archive:
            if any(member.compress_type for member in archive.infolist()):
                raise zipfile.BadZipFile("we never compress")
            return {name: archive.read(name) for name in archive.namelist()}
    except _UNREADABLE as error:
        raise ModelError(f"model file '{path}' is damaged or not a model file") from error


def _digest(members: Mapping[str, bytes]) -> bytes:
    """Hex digest over names, lengths and contents, in the order of the names."""
    sha = hashlib.sha256()
    for name, content in sorted(members.items()):
        sha.update(f"{name} {len(content)}\n".encode())
        sha.update(content)
    return sha.hexdigest().encode()


def _to_npy(array: FloatArray) -> bytes:
    packed = io.BytesIO()
    np.lib.format.write_array(packed, np.ascontiguousarray(array), allow_pickle=False)
    return packed.getvalue()


def _array(path: Path, content: bytes) -> FloatArray:
    try:
        array: FloatArray = np.lib.format.read_array(io.BytesIO(content), allow_pickle=False)
        if array.dtype != np.float64:
            raise ValueError("not an array of doubles")
    except _UNREADABLE as error:
        raise ModelError(f"model file '{path}' holds an unreadable array") from error
    array.flags.writeable = False
    return array
