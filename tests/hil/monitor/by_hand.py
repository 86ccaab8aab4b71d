"""A car on a bus, a service, and a monitor without a terminal that drives it."""

import asyncio
from collections.abc import Callable, Iterator
from contextlib import closing, contextmanager
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from tcs_hil.canbus.database import load_database
from tcs_hil.canbus.port import open_port
from tcs_hil.hil.monitor.snapshot import Snapshot
from tcs_hil.hil.monitor.sources import BusSource
from tcs_hil.hil.monitor.view import Monitor
from tcs_hil.hil.processes.program import program

PATIENCE_S = 30.0
LOOK_S = 0.05
ENDLESS = """
description = "An hour that nobody drives but by hand"
duration_s = 3600.0
start_speed_kmph = 10.0
[driver]
request = [[0.0, 0.0]]
"""


@contextmanager
def car_and_service(folder: Path, channel: str, mode: str, *options: str) -> Iterator[Path]:
    """Start both on ``channel``; yields where the truth will be once they have ended."""
    scenario, truth = folder / "endless.toml", folder / "truth.npz"
    scenario.write_text(ENDLESS)
    config = folder / "service.toml"  # small: a User-Mode-Linux guest locks few pages
    config.write_text("[recorder]\nticks = 5_000\n")
    trigger = "lockstep" if mode == "lockstep" else "timer"
    service = ("tcs_hil", "run", "--config", str(config), "--controller", "pi")
    car = ("plant_emulator", "run", "--scenario", str(scenario), "--record", str(truth))
    with (
        program(*service, "--channel", channel, "--trigger", trigger, log=folder / "service.log"),
        program(*car, "--channel", channel, "--mode", mode, *options, log=folder / "car.log"),
    ):
        yield truth


def drive(channel: str, steps: list[tuple[list[str], Callable[[Snapshot], bool]]]) -> None:
    """Press the keys of each step, then wait for what it is to bring."""
    port, name = open_port("auto", channel)
    with closing(BusSource(port, name, load_database(), in_control=True)) as source:
        asyncio.run(_press_and_see(source, steps))


async def _press_and_see(
    source: BusSource, steps: list[tuple[list[str], Callable[[Snapshot], bool]]]
) -> None:
    app = Monitor(source, in_control=True)
    async with app.run_test(size=(80, 24)):
        for keys, arrived in steps:
            for key in keys:  # the pilot would wait for an idle process, which a live bus never is
                app.simulate_key(key)
            async with asyncio.timeout(PATIENCE_S):
                while (snapshot := source.look()[0]) is None or not arrived(snapshot):
                    await asyncio.sleep(LOOK_S)


def read_truth(path: Path) -> NDArray[np.void]:
    """What really was, one row per 2 ms."""
    with np.load(path) as file:
        truth: NDArray[np.void] = file["truth"]
        return truth
