"""Roads measured or drawn elsewhere: patches from a CSV file."""

from __future__ import annotations

import csv
from itertools import pairwise
from pathlib import Path

import msgspec

from plant_emulator.road import Patch
from tcs_hil.errors import ConfigError


def read_road(path: Path) -> tuple[Patch, ...]:
    """Read a CSV file whose header names the keys of a `[[road]]` patch, one patch a line.

    Empty cells are left out.

    Raises:
        ConfigError: the file cannot be read, has no patches, or a column or value is wrong.
    """
    try:
        with path.open(newline="", encoding="utf-8-sig") as file:
            table = csv.DictReader(file, skipinitialspace=True)
            lines = [{k: v for k, v in line.items() if v} for line in table]
        patches = msgspec.convert(lines, tuple[Patch, ...], strict=False)
    except OSError as error:
        raise ConfigError(f"{path}: cannot be read ({error.strerror})") from error
    except (ValueError, csv.Error, msgspec.ValidationError) as error:
        raise ConfigError(f"{path}: cannot be read as a road: {error}") from error
    if not patches:
        raise ConfigError(f"{path}: a road needs at least one patch")
    if any(later.from_m <= earlier.from_m for earlier, later in pairwise(patches)):
        raise ConfigError(f"{path}: from_m must increase from one patch to the next")
    return patches
