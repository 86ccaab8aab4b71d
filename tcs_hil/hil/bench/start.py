"""From the start of a fresh interpreter to the first tick on record."""

from __future__ import annotations

import os
import socket
import subprocess
import sys
import tempfile
import time
from contextlib import ExitStack
from pathlib import Path

import msgspec

from tcs_hil.control.backend import Backend
from tcs_hil.control.settings import ControlSettings
from tcs_hil.errors import TcsError
from tcs_hil.hil.bench.candidates import PREDICTIVE, backends
from tcs_hil.hil.bench.effort import Effort, Progress
from tcs_hil.hil.processes.interruption import uninterrupted
from tcs_hil.hil.toml import write_toml
from tcs_hil.runtime.recording import read
from tcs_hil.service.settings import BusSettings, RecorderSettings, ServiceConfig

PATIENCE_S = 60.0
SETTLE_S = 0.05  # some ticks
STOP_S = 10.0


class StartError(TcsError):
    """The service did not start."""


class StartRow(msgspec.Struct, frozen=True):
    """Times from ``tcs-hil run`` to the end of its first tick, each in a new process."""

    law: str
    preset: str
    code: str
    seconds: list[float]


def measure_starts(effort: Effort, progress: Progress) -> list[StartRow]:
    """Start each default law on the embedded bus, as often as the effort says."""
    work = [(kind, backend) for kind in PREDICTIVE for backend in backends(kind, "default")]
    rows = []
    for done, (kind, backend) in enumerate(work):
        progress(done / len(work), f"start of {kind.name}, {backend}")
        seconds = [round(_start_s(kind.name.lower(), backend), 3) for _ in range(effort.starts)]
        rows.append(StartRow(kind.name, "default", backend, seconds))
    return rows


def _start_s(law: str, backend: Backend) -> float:
    with tempfile.TemporaryDirectory(prefix="tcs-hil.") as name:
        folder = Path(name)
        config = ServiceConfig(
            controller=law,  # type: ignore[arg-type]
            control=ControlSettings(backend=backend),
            bus=BusSettings(interface="embedded", channel=f"start-{os.getpid()}"),
            recorder=RecorderSettings(path=str(folder / "flight")),
        )
        write_toml(folder / "service.toml", config)
        begin_ns = time.monotonic_ns()
        _run_until_ready(folder)
        first_ns = int(read(folder / "flight")["sent_ns"][0])
    return (first_ns - begin_ns) * 1e-9


def _run_until_ready(folder: Path) -> None:
    """Start the service, let it tick a little, and stop it."""
    with ExitStack() as cleanup:
        listener = cleanup.enter_context(socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM))
        listener.bind(str(folder / "notify"))
        listener.settimeout(PATIENCE_S)
        with uninterrupted():
            service = subprocess.Popen(
                (sys.executable, "-m", "tcs_hil", "run", "--config", str(folder / "service.toml")),
                env=os.environ | {"NOTIFY_SOCKET": str(folder / "notify")},
                stdout=subprocess.DEVNULL,
                stderr=subprocess.DEVNULL,
            )
            cleanup.callback(service.wait, STOP_S)
            cleanup.callback(service.terminate)
        try:
            listener.recv(4096)
        except TimeoutError as error:
            raise StartError(f"the service was not ready after {PATIENCE_S:g} s") from error
        time.sleep(SETTLE_S)
