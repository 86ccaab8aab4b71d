"""`tcs-hil metrics` as a process, asked over HTTP as Prometheus does."""

from __future__ import annotations

import signal
import subprocess
import sys
import urllib.request
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest
from click.testing import CliRunner
from runtime.fakes import RUN, numbered

from tcs_hil.cli.metrics import command
from tcs_hil.errors import ConfigError, TcsError
from tcs_hil.runtime.recorder import FlightRecorder


@contextmanager
def serving(recording: Path) -> Iterator[tuple[subprocess.Popen[str], str]]:
    arguments = ("-m", "tcs_hil", "metrics", str(recording), "--listen", "127.0.0.1:0")
    with subprocess.Popen(
        [sys.executable, "-u", *arguments], stdout=subprocess.PIPE, text=True
    ) as child:
        try:
            assert child.stdout is not None
            yield child, child.stdout.readline().strip()
        finally:
            child.kill()


def asked(url: str) -> str:
    with urllib.request.urlopen(url, timeout=10.0) as answer:  # noqa: S310 - our own server
        text: str = answer.read().decode()
    return text


def test_a_recording_that_comes_later_is_served_and_a_signal_ends_it(tmp_path: Path) -> None:
    path = tmp_path / "flight"
    with serving(path) as (child, url):
        assert "tcs_hil_up 0.0" in asked(url)
        with FlightRecorder(path, RUN, 8) as recorder:
            recorder.write(numbered(0))
            text = asked(url)
        assert "tcs_hil_ticks_total 1.0" in text
        assert 'tcs_hil_run_info{bus="virtual:test",controller="nmpc"} 1.0' in text
        child.send_signal(signal.SIGTERM)
        assert child.wait(10.0) == 0


def test_a_file_that_is_no_recording_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "drive.blf"
    path.write_bytes(b"LOGG and more of it" * 100)
    error = CliRunner().invoke(command, [str(path)]).exception
    assert isinstance(error, TcsError)
    assert str(error) == f"{path}: not a flight recording"


@pytest.mark.parametrize("content", [b"", bytes(8192)])
def test_a_recording_that_is_just_being_made_is_waited_for(tmp_path: Path, content: bytes) -> None:
    path = tmp_path / "flight"
    path.write_bytes(content)
    with serving(path) as (_, url):
        assert "tcs_hil_up 0.0" in asked(url)


@pytest.mark.parametrize("listen", ["9555", ":9555", "127.0.0.1:", "127.0.0.1:99999"])
def test_an_address_that_is_none_is_refused(tmp_path: Path, listen: str) -> None:
    result = CliRunner().invoke(command, [str(tmp_path / "flight"), "--listen", listen])
    assert isinstance(result.exception, ConfigError)
    assert f"--listen {listen}: is not HOST:PORT" in str(result.exception)


def test_an_address_of_another_machine_is_one_sentence(tmp_path: Path) -> None:
    result = CliRunner().invoke(command, [str(tmp_path / "flight"), "--listen", "192.0.2.1:9555"])
    assert isinstance(result.exception, ConfigError)
    assert "cannot listen" in str(result.exception)
