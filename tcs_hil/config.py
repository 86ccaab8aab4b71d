"""TOML files into frozen, bounded structs; what does not fit is refused in one sentence."""

from __future__ import annotations

import tomllib
from pathlib import Path
from typing import TypeVar

import msgspec

from tcs_hil.errors import ConfigError

T = TypeVar("T")


def read_toml(path: Path, struct: type[T]) -> T:
    """Read ``path`` as a ``struct``.

    Raises:
        ConfigError: the file is missing or unreadable, is not TOML, or has an
            unknown key or a value out of its bounds; file and key are named.
    """
    try:
        text = path.read_text(encoding="utf-8")
    except OSError as error:
        raise ConfigError(f"{path}: cannot be read ({error.strerror})") from error
    except UnicodeDecodeError as error:
        raise ConfigError(f"{path}: cannot be read (not UTF-8 text)") from error
    except ValueError as error:  # no name a file can have
        raise ConfigError(f"{str(path)!r}: cannot be read ({error})") from error
    try:
        table = tomllib.loads(text)
    except ValueError as error:  # broken TOML, or a number of thousands of digits
        raise ConfigError(f"{path}: not valid TOML: {error}") from error
    except RecursionError as error:
        raise ConfigError(f"{path}: not valid TOML: nested too deeply") from error
    return convert(table, struct, str(path))


def convert(table: object, struct: type[T], source: str) -> T:
    """Check a table of plain values against ``struct``; ``source`` opens the error's sentence."""
    try:
        return msgspec.convert(table, struct)
    except (msgspec.ValidationError, UnicodeDecodeError) as error:
        # msgspec may cut a name it quotes within a character: UnicodeDecodeError.
        raise ConfigError(f"{source}: {_one_sentence(str(error))}") from error
    except RecursionError as error:
        raise ConfigError(f"{source}: nested too deeply") from error


def _one_sentence(message: str) -> str:
    """``Object contains unknown field `x` - at `$.bus``` becomes ``bus: unknown key `x```."""
    what, _, where = message.partition(" - at `$")
    what = what.replace("Object contains unknown field", "unknown key")
    what = what.replace("Object missing required field", "missing key")
    key = where.strip("`").lstrip(".")
    return f"{key}: {what}" if key else what
