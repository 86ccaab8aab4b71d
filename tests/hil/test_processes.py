import os
import textwrap
from pathlib import Path

import pytest

from tcs_hil.hil.processes import ProcessError, program


@pytest.fixture
def script(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    """Write a module that the bench can start by name."""

    def write(body: str) -> str:
        (tmp_path / "child_program.py").write_text(textwrap.dedent(body))
        monkeypatch.setenv("PYTHONPATH", os.pathsep.join([str(tmp_path), str(Path.cwd())]))
        return "child_program"

    return write


READY = "from tcs_hil.runtime.notify import notify; notify('READY=1')\n"


def test_a_program_is_ready_when_it_says_so_and_stops_when_asked(script, tmp_path: Path) -> None:
    name = script(READY + "import signal; signal.pause()")
    with program(name, log=tmp_path / "log") as child:
        assert child.running
    assert not child.running


def test_a_program_that_ends_before_it_is_ready_is_quoted(script, tmp_path: Path) -> None:
    name = script("import sys; sys.exit('no such bus')")
    with (
        pytest.raises(ProcessError, match="ended before it was ready: no such bus"),
        program(name, log=tmp_path / "log"),
    ):
        pass


def test_a_program_that_fails_in_the_run_is_quoted(script, tmp_path: Path) -> None:
    name = script(READY + "import sys; sys.exit('broken')")
    with (
        program(name, log=tmp_path / "log") as child,
        pytest.raises(ProcessError, match="ended with status 1: broken"),
    ):
        child.wait(20.0)


def test_a_program_that_never_ends_is_given_up(script, tmp_path: Path) -> None:
    name = script(READY + "import signal; signal.pause()")
    with (
        program(name, log=tmp_path / "log") as child,
        pytest.raises(ProcessError, match="still runs"),
    ):
        child.wait(0.01)
