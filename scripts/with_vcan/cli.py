"""The command line of `with-vcan`."""

from __future__ import annotations

import argparse
import math
import os
import sys
from pathlib import Path

from . import job, kernels, native, uml

PLACE_VARIABLE = "WITH_VCAN"  # tells the command where it runs: native, uml or simulated-time

_EPILOG = """\
exit status: the command's own; 128+N if signal N ended it; 124 after the timeout; 125 when no
vcan0 could be had; 126 or 127 when the command cannot be executed or found.

example: scripts/with-vcan --rw build -- .venv/bin/python -m pytest tests/vcan
"""


def main(arguments: list[str]) -> int:
    """Run the command the arguments name and return its exit status."""
    options = _parse(arguments)
    if not options.kernel and not options.time_travel and native.available():
        return native.run(_job(options, "native", None), options.timeout)
    kernel = kernels.find(options.kernel)
    if kernel is None:
        return _refuse(
            f"{options.kernel} is not a kernel that can be executed"
            if options.kernel
            else "this kernel has no CAN and there is no User-Mode-Linux kernel; "
            "apt-get install user-mode-linux or run scripts/build-vcan-kernel"
        )
    if options.time_travel and not kernel.simulated_time:
        return _refuse(f"{kernel.path} cannot simulate time; run scripts/build-vcan-kernel")
    where = "simulated-time" if options.time_travel else "uml"
    modules = str(kernel.modules) if kernel.modules else None
    wishes = uml.Wishes(kernel, options.time_travel, options.timeout)
    return uml.run(_job(options, where, modules), wishes)


def _parse(arguments: list[str]) -> argparse.Namespace:
    parser = argparse.ArgumentParser(
        prog="with-vcan",
        description="Runs COMMAND where a real SocketCAN interface vcan0 exists: in a network "
        "namespace of this kernel if it can, else in a User-Mode-Linux guest on this machine's "
        "own files, whose changes are thrown away.",
        epilog=_EPILOG,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument(
        "--rw", action="append", default=[], metavar="DIR", help="let changes in DIR reach the host"
    )
    parser.add_argument("--timeout", type=float, metavar="S", help="end COMMAND after S seconds")
    parser.add_argument(
        "--time-travel",
        action="store_true",
        help="simulated time: the clock jumps whenever everything sleeps, computing takes none",
    )
    parser.add_argument("--kernel", metavar="FILE", help="User-Mode-Linux kernel to boot")
    parser.add_argument("command", nargs=argparse.REMAINDER, metavar="COMMAND")
    options = parser.parse_args(arguments)
    if options.command[:1] == ["--"]:
        del options.command[0]
    if not options.command:
        parser.error("no COMMAND given")
    if options.timeout is not None and not 0.0 < options.timeout < math.inf:
        parser.error(f"--timeout {options.timeout}: not a time to wait")
    for folder in options.rw:
        if not Path(folder).is_dir():
            parser.error(f"--rw {folder}: not a folder")
    return options


def _job(options: argparse.Namespace, where: str, modules: str | None) -> job.Job:
    return job.Job(
        argv=options.command,
        cwd=str(Path.cwd()),
        env={**os.environ, PLACE_VARIABLE: where},
        writable=[os.path.realpath(folder) for folder in options.rw],
        modules=modules,
    )


def _refuse(sentence: str) -> int:
    print(f"with-vcan: {sentence}", file=sys.stderr)
    return job.NO_PLACE
