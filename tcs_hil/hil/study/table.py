"""Results of a study on disk: Parquet parts while it runs, one table at the end."""

from __future__ import annotations

import contextlib
from collections.abc import Sequence
from pathlib import Path

import msgspec

from tcs_hil.errors import ConfigError
from tcs_hil.hil.study.plan import Plan
from tcs_hil.hil.study.trial import Row

try:
    import pyarrow as pa
    import pyarrow.parquet as pq
except ImportError as error:
    raise ConfigError("a study needs pyarrow: pip install 'tcs-hil[bench]'") from error

PLAN = "plan.json"
TABLE = "campaign.parquet"


class Table:
    """A folder with the rows of one plan; what is already in it need not be driven again.

    Raises:
        ConfigError: the folder cannot be written, or holds the rows of another plan.
    """

    def __init__(self, folder: Path, plan: Plan) -> None:
        self._folder = folder
        try:
            folder.mkdir(parents=True, exist_ok=True)
            self._claim(folder / PLAN, plan)
        except OSError as error:
            raise ConfigError(f"{folder}: cannot be written ({error.strerror})") from error
        self._rows = self._read()

    @property
    def path(self) -> Path:
        """The whole table, once `finish` has written it."""
        return self._folder / TABLE

    @property
    def done(self) -> set[int]:
        """Index of every point that has its row."""
        return {row["index"] for row in self._rows}

    @property
    def rows(self) -> list[Row]:
        """Every row so far, by index."""
        return sorted(self._rows, key=lambda row: int(row["index"]))

    def add(self, rows: Sequence[Row]) -> None:
        """Keep more rows; they are on disk when this returns."""
        self._rows += rows
        _write(self._folder / f"part-{rows[0]['index']:07d}.parquet", rows)

    def finish(self) -> None:
        """Put the parts together."""
        _write(self.path, self.rows)
        for part in self._folder.glob("part-*.parquet"):
            part.unlink()

    def _claim(self, path: Path, plan: Plan) -> None:
        with contextlib.suppress(FileNotFoundError):
            if msgspec.json.decode(path.read_bytes()).get("digest") != plan.digest:
                raise ConfigError(f"{self._folder}: holds another study; give another --out")
            return
        study = msgspec.to_builtins(plan)
        path.write_bytes(msgspec.json.format(msgspec.json.encode({"digest": plan.digest} | study)))

    def _read(self) -> list[Row]:
        files = [*self._folder.glob("part-*.parquet"), *self._folder.glob(TABLE)]
        by_index = {row["index"]: row for file in files for row in pq.read_table(file).to_pylist()}
        return list(by_index.values())


def _write(path: Path, rows: Sequence[Row]) -> None:
    """All or nothing: an interruption leaves no half a file under the final name."""
    draft = path.with_suffix(".draft")
    pq.write_table(pa.Table.from_pylist(list(rows)), draft)
    draft.replace(path)
