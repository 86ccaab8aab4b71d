"""`scripts/with-vcan` hands a command through unchanged, and its changes to files not at all."""

import os
import signal
import subprocess
import time
from pathlib import Path

import pytest
from needs import needs

WITH_VCAN = Path(__file__).resolve().parent.parent / "scripts" / "with-vcan"
NO_PLACE = 125
LIMIT_S = 60.0


def run(*arguments: str | Path) -> subprocess.CompletedProcess[str]:
    command = [WITH_VCAN, *arguments]
    return subprocess.run(command, capture_output=True, text=True, timeout=LIMIT_S, check=False)


@pytest.fixture(scope="module", autouse=True)
def _place() -> None:
    tried = run("true")
    needs(tried.returncode != NO_PLACE, f"a vcan0: {tried.stderr}")
    assert tried.returncode == 0, tried.stderr


def test_output_and_exit_status_are_the_commands() -> None:
    ran = run("sh", "-c", "echo to stdout; echo to stderr >&2; exit 7")
    assert (ran.stdout, ran.stderr, ran.returncode) == ("to stdout\n", "to stderr\n", 7)


def test_the_command_finds_vcan0_up() -> None:
    assert int(run("cat", "/sys/class/net/vcan0/flags").stdout, 16) & 1


def test_a_command_that_does_not_exist_is_named() -> None:
    ran = run("no-such-command")
    assert ran.returncode == 127
    assert "no-such-command" in ran.stderr


def test_a_time_limit_ends_the_command() -> None:
    assert run("--timeout", "0.5", "sleep", "600").returncode == 124


def test_only_writable_folders_change(tmp_path: Path) -> None:
    kept, lost = tmp_path / "kept", tmp_path / "lost"
    for folder in (kept, lost):
        folder.mkdir()
    ran = run("--rw", kept, "sh", "-c", f"echo $WITH_VCAN; touch {kept}/file {lost}/file")
    if ran.stdout == "native\n":
        pytest.skip("a namespace of this kernel has the machine's own files")
    assert (ran.returncode, ran.stderr) == (0, "")
    assert [path.name for path in tmp_path.rglob("file")] == ["file"]
    assert (kept / "file").exists()


def test_a_signal_reaches_the_command() -> None:
    # A shell obeys a trap between two commands only: each must be short.
    script = "trap 'exit 3' USR1; echo ready; while :; do sleep 0.05; done"
    with subprocess.Popen([WITH_VCAN, "sh", "-c", script], stdout=subprocess.PIPE) as launcher:
        assert launcher.stdout is not None
        launcher.stdout.readline()
        launcher.send_signal(signal.SIGUSR1)
        assert launcher.wait(LIMIT_S) == 3


def test_nothing_survives_a_killed_launcher(tmp_path: Path) -> None:
    script = "echo ready; sleep 600"
    env = {**os.environ, "TMPDIR": str(tmp_path)}
    command = [WITH_VCAN, "sh", "-c", script]
    with subprocess.Popen(command, stdout=subprocess.PIPE, env=env) as launcher:
        assert launcher.stdout is not None
        launcher.stdout.readline()
        launcher.kill()
    deadline_s = time.monotonic() + LIMIT_S
    while list(tmp_path.iterdir()):  # the folder goes last, after every process of the guest
        assert time.monotonic() < deadline_s
        time.sleep(0.01)  # nobody is left who could tell: it has to be looked at
