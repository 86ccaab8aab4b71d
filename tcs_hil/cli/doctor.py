"""``tcs-hil doctor``."""

from __future__ import annotations

from typing import Any

import click
import msgspec

from tcs_hil.cli.options import json_option
from tcs_hil.console import NAME
from tcs_hil.runtime.doctor.examine import examine
from tcs_hil.runtime.doctor.finding import Finding, Verdict
from tcs_hil.runtime.doctor.machine import ThisMachine

STYLES: dict[Verdict, dict[str, Any]] = {
    Verdict.OK: {"fg": "green"},
    Verdict.WARN: {"fg": "yellow"},
    Verdict.FAIL: {"fg": "red", "bold": True},
}


@click.command()
@click.option(
    "--channel", type=NAME, default="vcan0", show_default=True, help="CAN interface to look at."
)
@click.option(
    "--seconds",
    type=click.IntRange(1, 3600),
    default=2,
    show_default=True,
    help="How long to measure the wake jitter.",
)
@json_option
@click.pass_context
def command(context: click.Context, channel: str, seconds: int, as_json: bool) -> None:
    """Examine whether this machine keeps a 2 ms tick, with the command that mends what does not.

    Exit status 1 when a hard requirement is missing, 0 else.

    Example: tcs-hil doctor --channel can0
    """
    findings = list(examine(ThisMachine(), channel, seconds))
    if as_json:
        click.echo(msgspec.json.encode([finding._asdict() for finding in findings]))
    else:
        for finding in findings:
            _print(finding)
    if any(finding.verdict is Verdict.FAIL for finding in findings):
        context.exit(1)


def _print(finding: Finding) -> None:
    """Print lines, not a table: a command must be whole to be copied."""
    verdict = click.style(f"{finding.verdict.value:4}", **STYLES[finding.verdict])
    click.echo(f"{verdict}  {finding.what}: {finding.found}")
    if finding.remedy:
        click.echo(f"      {finding.remedy}")
