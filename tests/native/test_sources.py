"""A native step that was built from other sources is not used."""

from __future__ import annotations

import shutil
from collections.abc import Iterator
from pathlib import Path

import pytest

from tcs_hil import native
from tcs_hil.errors import ConfigError
from tcs_hil.native.sources import checksum

ROOM = Path(native.__file__).parent


@pytest.fixture
def checkout(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """A copy of the room, which the loader takes for its own."""
    (tmp_path / "setup.py").touch()
    room = shutil.copytree(ROOM, tmp_path / "tcs_hil" / "native")
    monkeypatch.setattr(native, "__file__", str(room / "__init__.py"))
    native.core.cache_clear()
    yield room
    native.core.cache_clear()


def test_the_sources_it_was_built_from_are_accepted(checkout: Path) -> None:
    assert native.core().lib.sources_checksum == checksum(checkout)


@pytest.mark.parametrize("file", ["interface.h", "src/sqp.h", "src/sqp.c"])
def test_a_change_of_the_sources_names_what_mends_it(checkout: Path, file: str) -> None:
    with (checkout / file).open("a") as text:
        text.write("/* changed */\n")
    with pytest.raises(ConfigError, match="run pip install"):
        native.core()


def test_an_installation_is_not_searched_for_sources(checkout: Path) -> None:
    (checkout.parent.parent / "setup.py").unlink()
    shutil.rmtree(checkout / "src")
    assert native.core().lib.sources_checksum
