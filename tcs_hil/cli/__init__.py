"""argv to configuration to wiring.  Each command imports what it needs when it is called."""

from __future__ import annotations

import importlib
import os
import sys

import click

from tcs_hil import console
from tcs_hil.loading import loading

COMMANDS = {
    "run": "Run the traction control service on a bus.",
    "identify": "Identify a Koopman predictor and write it as a model file.",
    "demo": "Run the paper's experiment between two processes and show it.",
    "hil": "Drive scenarios against the service, judge them and write a report.",
    "record": "Record a bus into a BLF, ASC or candump log file.",
    "export": "Write a run as MF4, Parquet, CSV or candump log.",
    "replay": "Let the service live through a recorded run again and compare.",
    "signals": "Print the contract of the bus as a Markdown table.",
    "faults": "Print every fault code and the reaction to it as a Markdown table.",
    "map": "Check or propose a signal map for another car's DBC.",
    "campaign": "Vary a scenario over a space of parameters, on every core or a cluster.",
    "doctor": "Examine whether this machine keeps a 2 ms tick.",
    "bench": "Time the laws beside their peers, whole ticks, and the service on a bus.",
    "report": "Show latency, jitter and states of a flight recording.",
    "monitor": "Watch a bus or a flight recording live, and drive the emulator by hand.",
    "metrics": "Serve Prometheus metrics of a running service.",
}


class LazyGroup(click.Group):
    """A group whose commands live in modules of their own: ``run --help`` needs no CasADi."""

    def list_commands(self, ctx: click.Context) -> list[str]:  # noqa: ARG002 - click's signature
        """Names in the order a newcomer needs them."""
        return list(COMMANDS)

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:  # noqa: ARG002 - click's signature
        """Import the one module that was asked for."""
        if cmd_name not in COMMANDS:
            return None
        if cmd_name == "run":
            # python-can imports whatever reads recordings, and pandas with it: not into the tick.
            sys.modules.setdefault("asammdf", None)  # type: ignore[arg-type]
            # Ten rows need no threads that spin beside the tick, nor 80 MB locked for them.
            os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
        with loading():
            command: click.Command = importlib.import_module(f"{__name__}.{cmd_name}").command
        return command

    def format_commands(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:  # noqa: ARG002 - click's signature
        """List the commands without importing any."""
        with formatter.section("Commands"):
            formatter.write_dl(list(COMMANDS.items()))


@click.group(cls=LazyGroup, context_settings={"help_option_names": ["-h", "--help"]})
@click.version_option(package_name="tcs-hil")
def cli() -> None:
    """Traction control on a CAN bus: Koopman and nonlinear MPC every 2 ms.

    Begin with `tcs-hil demo`.
    """


def main() -> None:
    """Entry point of ``tcs-hil``."""
    sys.exit(console.run(cli, "tcs-hil"))
