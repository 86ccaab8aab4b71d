"""Structs back into TOML files, so that what was run can be run again by hand."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import msgspec
import tomli_w


def write_toml(path: Path, struct: msgspec.Struct) -> None:
    """Write every value of ``struct``, defaults too; `tcs_hil.config.read_toml` gives it back."""
    path.write_text(tomli_w.dumps(_without_none(msgspec.to_builtins(struct))), encoding="utf-8")


def _without_none(value: Any) -> Any:
    """TOML has no null: a key that is absent says the same."""
    if isinstance(value, dict):
        return {key: _without_none(each) for key, each in value.items() if each is not None}
    if isinstance(value, (list, tuple)):
        return [_without_none(each) for each in value]
    return value
