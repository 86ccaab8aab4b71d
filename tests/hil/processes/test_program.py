import os
import select
import signal
import subprocess
import sys
import textwrap
from concurrent.futures import ProcessPoolExecutor
from contextlib import suppress
from pathlib import Path

import pytest

from tcs_hil.hil.processes.interruption import uninterrupted
from tcs_hil.hil.processes.program import ProcessError, fork_server, program

PATIENCE_S = 20.0


@pytest.fixture
def script(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    """Write a module that the bench can start by name."""

    def write(body: str) -> str:
        (tmp_path / "child_program.py").write_text(textwrap.dedent(body))
        monkeypatch.syspath_prepend(tmp_path)
        monkeypatch.setenv("PYTHONPATH", os.pathsep.join([str(tmp_path), str(Path.cwd())]))
        return "child_program"

    return write


OBEY = "import signal, sys; signal.signal(15, lambda *_: sys.exit(0))\n"
READY = "from tcs_hil.runtime.notify import notify; notify('READY=1')\n"


def wait_until_dead(pid: int) -> None:
    """Wait for the end of a process that is on its way out, whose child it may be."""
    with suppress(ProcessLookupError):  # gone altogether
        process = os.pidfd_open(pid)
        ended, _, _ = select.select([process], [], [], PATIENCE_S)
        os.close(process)
        assert ended, f"process {pid} lives on"


def test_what_the_bench_forks_off_leaves_ctrl_c_to_it() -> None:
    with ProcessPoolExecutor(1, mp_context=fork_server()) as pool:
        with uninterrupted():
            asked = pool.submit(signal.raise_signal, signal.SIGINT)
        assert asked.result(PATIENCE_S) is None


def test_a_program_is_ready_when_it_says_so_and_stops_when_asked(script, tmp_path: Path) -> None:
    name = script(OBEY + READY + "signal.pause()")
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
        pytest.raises(ProcessError, match="ended with status 1: broken"),
        program(name, log=tmp_path / "log") as child,
    ):
        child.wait(PATIENCE_S)


def test_a_program_that_died_unnoticed_is_an_error_at_the_end(script, tmp_path: Path) -> None:
    name = script(READY + "import os, signal; os.kill(os.getpid(), signal.SIGKILL)")
    with (
        pytest.raises(ProcessError, match="ended with status -9"),
        program(name, log=tmp_path / "log") as child,
        suppress(ProcessError),
    ):
        child.wait(PATIENCE_S)


def test_a_program_does_not_outlive_a_bench_that_is_killed(script, tmp_path: Path) -> None:
    name = script("import os; print(os.getpid(), flush=True)\n" + OBEY + READY + "signal.pause()")
    log = tmp_path / "log"
    bench = textwrap.dedent(f"""
        from pathlib import Path
        import os, signal
        from tcs_hil.hil.processes.program import program
        with program({name!r}, log=Path({str(log)!r})):
            os.kill(os.getpid(), signal.SIGKILL)
    """)
    killed = subprocess.run([sys.executable, "-c", bench], check=False)
    assert killed.returncode == -signal.SIGKILL
    wait_until_dead(int(log.read_text()))


def test_a_program_that_never_ends_is_given_up(script, tmp_path: Path) -> None:
    name = script(OBEY + READY + "signal.pause()")
    with (
        program(name, log=tmp_path / "log") as child,
        pytest.raises(ProcessError, match="still runs"),
    ):
        child.wait(0.01)
