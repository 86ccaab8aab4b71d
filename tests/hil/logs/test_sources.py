"""Which files a run left."""

from pathlib import Path

import pytest
from hil.logs.made_run import made_run

from tcs_hil.errors import ConfigError
from tcs_hil.hil.logs.sources import Sources, find_sources


def test_a_folder_and_its_files_given_one_by_one_are_the_same_run(tmp_path: Path) -> None:
    files = made_run(tmp_path / "run", lockstep=True)
    expected = Sources(files.bus, files.flight, files.truth)
    assert find_sources([files.folder]) == expected
    assert find_sources([files.truth, files.bus, files.flight]) == expected


def test_a_configuration_beside_the_log_is_part_of_the_run(tmp_path: Path) -> None:
    files = made_run(tmp_path / "run", lockstep=True)
    files.config.write_text("")
    assert find_sources([files.folder]).config == files.config


def test_two_runs_at_once_are_refused(tmp_path: Path) -> None:
    for name in ("a", "b"):
        made_run(tmp_path / name, lockstep=True)
    with pytest.raises(ConfigError, match=r"a/bus\.blf and .*b/bus\.blf are both the bus"):
        find_sources([tmp_path / "a", tmp_path / "b"])


def test_a_folder_without_a_run_is_refused(tmp_path: Path) -> None:
    (tmp_path / "service.toml").write_text("")
    with pytest.raises(ConfigError, match="holds no run"):
        find_sources([tmp_path])


def test_a_path_that_leads_nowhere_is_refused_by_name(tmp_path: Path) -> None:
    with pytest.raises(ConfigError, match=r"nowhere\.blf: cannot be read"):
        find_sources([tmp_path / "nowhere.blf"])
