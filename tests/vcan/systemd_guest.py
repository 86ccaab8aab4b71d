"""A real systemd with our units, as the first process of a PID namespace in the guest.

Only for the User-Mode-Linux guest of scripts/with-vcan: units, program and
permissions are changed on its root, whose changes are thrown away.
"""

from __future__ import annotations

import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

PROJECT = Path(__file__).resolve().parents[2]
SYSTEMD = Path("/lib/systemd/systemd")
UNITS = Path("/etc/systemd/system")
PROGRAM = Path("/opt/tcs-hil/bin/tcs-hil")
PATIENCE_S = 60.0
BOOT = f"""
set -e
mount --make-rprivate /
mount -t proc proc /proc
mount -t tmpfs tmpfs /run
mount -t cgroup2 cgroup2 /sys/fs/cgroup
exec env container=uml {SYSTEMD} --system --unit=bare.target --log-target=null --show-status=no
"""
BARE_TARGET = "[Unit]\nDefaultDependencies=no\n"
# Without a distribution's basic.target; Python or this checkout may live in a home or in /tmp.
DROP_IN = """[Unit]
DefaultDependencies=no
[Service]
ProtectHome=no
BindReadOnlyPaths={checkout} {environment}
StandardOutput=append:/run/{unit}.log
StandardError=append:/run/{unit}.log
"""


def install(*units: str) -> None:
    """Install everything as a user would, but the program, which is this checkout."""
    subprocess.run(["make", "--silent", "-C", PROJECT, "install-service", "DESTDIR=/"], check=True)
    PROGRAM.parent.mkdir(parents=True)
    PROGRAM.write_text(
        f'#!/bin/sh\nPYTHONPATH={PROJECT} exec {sys.executable} -m tcs_hil "$@"\n', encoding="utf-8"
    )
    PROGRAM.chmod(0o755)
    (UNITS / "bare.target").write_text(BARE_TARGET, encoding="utf-8")
    for unit in units:
        folder = UNITS / f"{unit}.service.d"
        folder.mkdir()
        (folder / "test.conf").write_text(
            DROP_IN.format(unit=unit, checkout=PROJECT, environment=sys.prefix), encoding="utf-8"
        )
    for path in (Path(sys.executable).resolve(), PROJECT):
        for parent in path.parents:
            parent.chmod(parent.stat().st_mode | 0o011)


class Manager:
    """The running systemd, spoken to from inside its namespaces."""

    def __init__(self, init_pid: int) -> None:
        self._init_pid = str(init_pid)

    def run(self, *command: str) -> str:
        """Run a command next to systemd and return what it prints; it must succeed."""
        inside = ["nsenter", "--mount", "--pid", "--target", self._init_pid, *command]
        return subprocess.run(
            inside, check=True, capture_output=True, text=True, timeout=PATIENCE_S
        ).stdout

    def show(self, unit: str, name: str) -> str:
        return self.run("systemctl", "show", f"{unit}.service", "--value", "-p", name).strip()

    def await_restart(self, unit: str, count: int) -> None:
        """Return once the unit runs after its restart number ``count``."""
        deadline_s = time.monotonic() + PATIENCE_S
        while (self.show(unit, "NRestarts"), self.show(unit, "ActiveState")) != (
            str(count),
            "active",
        ):
            assert time.monotonic() < deadline_s, f"{unit} was not restarted"
            time.sleep(0.1)

    def is_up(self) -> bool:
        try:
            return self.run("systemctl", "is-system-running").strip() == "running"
        except subprocess.CalledProcessError:
            return False


@contextmanager
def booted() -> Iterator[Manager]:
    """Boot systemd and end it, with everything it has started."""
    outside = subprocess.Popen(
        ["unshare", "--pid", "--fork", "--kill-child", "--mount", "sh", "-c", BOOT]
    )
    try:
        manager = Manager(_only_child(outside.pid))
        deadline_s = time.monotonic() + PATIENCE_S
        while not manager.is_up():
            assert time.monotonic() < deadline_s, "systemd does not come up"
            time.sleep(0.1)
        yield manager
    finally:
        outside.kill()
        outside.wait()


def _only_child(pid: int) -> int:
    children = ("pgrep", "--parent", str(pid))
    deadline_s = time.monotonic() + PATIENCE_S
    while not (text := subprocess.run(children, check=False, capture_output=True).stdout):
        assert time.monotonic() < deadline_s, "unshare does not start systemd"
        time.sleep(0.01)
    return int(text)
