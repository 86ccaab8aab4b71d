"""Paths in a configuration file: relative to the file, wherever the service is started."""

from __future__ import annotations

from pathlib import Path

import pytest

from tcs_hil.service.settings import BusSettings, RecorderSettings, ServiceConfig, read_service

TEXT = """
model = "models/bank.npz"
bus = { database = "../my.dbc" }
recorder = { path = "/var/lib/flight" }
"""


def test_paths_of_a_file_are_relative_to_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "conf").mkdir()
    (tmp_path / "conf" / "service.toml").write_text(TEXT)
    monkeypatch.chdir(tmp_path)
    config = read_service(Path("conf/service.toml"))
    assert config.model == str(tmp_path / "conf/models/bank.npz")
    assert config.bus.database == str(tmp_path / "conf/../my.dbc")
    assert config.recorder.path == "/var/lib/flight"


def test_what_is_not_given_stays_the_one_that_ships() -> None:
    assert ServiceConfig().beside(Path("/etc")) == ServiceConfig()


def test_a_place_once_found_does_not_move() -> None:
    config = ServiceConfig(
        model="bank.npz",
        bus=BusSettings(database="my.dbc"),
        recorder=RecorderSettings(path="flight"),
    ).beside(Path("/here"))
    assert config.beside(Path("/there")) == config
