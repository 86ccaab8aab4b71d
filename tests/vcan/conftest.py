"""The tests here need a real SocketCAN vcan0: loud where there is none, an error in CI.

The bus also carries strangers: candump and cansend, which share no code with us.
"""

import os
import shutil
import subprocess
import time
from collections.abc import Callable, Iterator
from contextlib import ExitStack
from pathlib import Path

import pytest

CHANNEL = "vcan0"
HERE = Path(__file__).parent
IN_CI = os.environ.get("CI") == "true"
PLACE = os.environ.get("WITH_VCAN", "this host")  # set by scripts/with-vcan
PATIENCE_S = 20.0  # how long a stranger may take before a test gives up on it


def pytest_configure(config: pytest.Config) -> None:
    config.addinivalue_line("markers", "simulated_time: needs `scripts/with-vcan --time-travel`")


@pytest.hookimpl(tryfirst=True)  # before -m selects by the marker
def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    ours = [item for item in items if HERE in item.path.parents]
    missing = _missing()
    if missing and IN_CI:
        raise pytest.UsageError(f"CI must run tests/vcan, but {missing}")
    for item in ours:
        item.add_marker("vcan")
        if missing:
            item.add_marker(pytest.mark.skip(reason=missing))
        elif item.get_closest_marker("simulated_time") and PLACE != "simulated-time":
            item.add_marker(pytest.mark.skip(reason="needs scripts/with-vcan --time-travel"))


def pytest_terminal_summary(terminalreporter: pytest.TerminalReporter) -> None:
    missing = _missing()
    if missing:
        line = f"NO TEST OF tests/vcan RAN: {missing}"
        terminalreporter.write_sep("!", line, red=True, bold=True)
        return
    passed = terminalreporter.stats.get("passed", [])
    count = sum("vcan" in report.keywords for report in passed)
    terminalreporter.write_line(f"vcan tests passed on a real SocketCAN ({PLACE}): {count}")


def _missing() -> str | None:
    """What keeps these tests from running here, in words; None where they can run."""
    if not Path("/sys/class/net", CHANNEL).exists():
        return f"there is no {CHANNEL} (run scripts/with-vcan -- python -m pytest tests/vcan)"
    for program in ("candump", "cansend", "ip"):
        if shutil.which(program) is None:
            return f"{program} is not installed (apt-get install can-utils iproute2)"
    return None


class Interface:
    """The link of vcan0, to be pulled and put back."""

    def down(self) -> None:
        _ip_link("set", CHANNEL, "down")

    def up(self) -> None:
        _ip_link("set", CHANNEL, "up")

    def remove(self) -> None:
        _ip_link("delete", CHANNEL)

    def add(self) -> None:
        _ip_link("add", CHANNEL, "type", "vcan")
        self.up()


def _ip_link(*words: str) -> None:
    subprocess.run(["ip", "link", *words], check=True)


@pytest.fixture
def vcan0() -> Iterator[Interface]:
    """The interface; it is there and up again after the test."""
    interface = Interface()
    yield interface
    if Path("/sys/class/net", CHANNEL).exists():
        interface.up()
    else:
        interface.add()


class Candump:
    """A running candump that ends after a number of frames."""

    def __init__(self, count: int) -> None:
        self.process = subprocess.Popen(
            ["candump", "-L", "-n", str(count), CHANNEL], stdout=subprocess.PIPE, text=True
        )

    def await_listening(self) -> None:
        """Return once no frame can escape it any more."""
        deadline_s = time.monotonic() + PATIENCE_S
        while not _waits_at_a_socket(self.process.pid):
            assert time.monotonic() < deadline_s, "candump does not listen"
            time.sleep(0.001)  # /proc has to be looked at: it tells of no change

    def lines(self) -> list[str]:
        """Wait for all frames; each line reads `(seconds) vcan0 ID#DATA`."""
        return self.process.communicate(timeout=PATIENCE_S)[0].splitlines()

    def frames(self) -> list[str]:
        """Wait for all frames and return them as `ID#DATA`."""
        return [line.split()[2] for line in self.lines()]


def _waits_at_a_socket(pid: int) -> bool:
    """Whether a process sleeps with a socket open: candump does so only to wait for frames."""
    process = Path("/proc", str(pid))
    state = (process / "stat").read_text().rpartition(")")[2].split()[0]
    return state == "S" and any(
        link.readlink().name.startswith("socket:") for link in (process / "fd").iterdir()
    )


@pytest.fixture
def candump() -> Iterator[Callable[[int], Candump]]:
    """Start a candump that listens, once this returns, for the given number of frames."""
    with ExitStack() as stack:

        def start(count: int) -> Candump:
            dump = Candump(count)
            stack.enter_context(dump.process)
            stack.callback(dump.process.kill)
            dump.await_listening()
            return dump

        yield start


@pytest.fixture
def cansend() -> Callable[[str], None]:
    """Send one frame, written as `123#DEADBEEF`, by the program of that name."""

    def send(frame: str) -> None:
        subprocess.run(["cansend", CHANNEL, frame], check=True)

    return send
