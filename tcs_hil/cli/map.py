"""``tcs-hil map``."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import click

from tcs_hil.canbus.database import parse_dbc
from tcs_hil.canbus.mapping.findings import Finding, Weight
from tcs_hil.canbus.mapping.plan import KINDS, MappedInput, MappedMessage, Plan, RangeRule, Rule
from tcs_hil.canbus.mapping.propose import propose
from tcs_hil.cli.options import json_option
from tcs_hil.service.bus_end import examine_map
from tcs_hil.service.settings import read_service

STYLES: dict[Weight, dict[str, Any]] = {
    Weight.NOTE: {"dim": True},
    Weight.WARNING: {"fg": "yellow"},
    Weight.ERROR: {"fg": "red", "bold": True},
}
ORDER = (Weight.ERROR, Weight.WARNING, Weight.NOTE)
Row = dict[str, str]


@click.group()
def command() -> None:
    """Let the service run on another car's DBC: propose a signal map, and check one.

    Example: tcs-hil map check mycar.toml
    """


@command.command()
@click.argument("config_path", metavar="CONFIG", type=click.Path(dir_okay=False, path_type=Path))
@json_option
@click.pass_context
def check(context: click.Context, config_path: Path, as_json: bool) -> None:
    """Say what the signal map in CONFIG maps, what it lacks and what does not fit.

    Exit status 1 when the service could not run with it, 0 else.

    Example: tcs-hil map check mycar.toml
    """
    plan, findings = examine_map(read_service(config_path))
    runs = not findings.errors
    if as_json:
        click.echo(json.dumps(_as_dict(plan, findings.found, runs), indent=2))
    else:
        _print(plan, findings.found, runs)
    if not runs:
        context.exit(1)


@command.command()
@click.argument("dbc_path", metavar="DBC", type=click.Path(dir_okay=False, path_type=Path))
def init(dbc_path: Path) -> None:
    """Print a configuration with a signal map, guessed from the names and units in DBC.

    Example: tcs-hil map init mycar.dbc > mycar.toml
    """
    # Nobody knows where the output goes: a bare name alone is meant to stay beside it.
    named = dbc_path if dbc_path.parent == Path() else dbc_path.absolute()
    click.echo(propose(parse_dbc(dbc_path)[1], str(named)), nl=False)


def _as_dict(plan: Plan, found: list[Finding], runs: bool) -> dict[str, Any]:
    return {
        "runs": runs,
        "inputs": _inputs(plan),
        "outputs": _outputs(plan),
        "findings": [
            {"weight": finding.weight.value, "key": finding.key, "sentence": finding.sentence}
            for finding in found
        ],
    }


def _print(plan: Plan, found: list[Finding], runs: bool) -> None:
    """Print lines, not a table: names of signals are long and want to be copied."""
    for row in _inputs(plan):
        click.echo(
            f"read     {row['input']}: {row['signal']} in {row['unit']}, steps of {row['step']}, "
            f"every {row['cycle']}, {row['believed']}"
        )
    for row in _outputs(plan):
        click.echo(f"sent     {row['output']}: {row['signal']}, every {row['cycle']}")
    for finding in sorted(found, key=lambda finding: ORDER.index(finding.weight)):
        weight = click.style(f"{finding.weight.value:7}", **STYLES[finding.weight])
        click.echo(f"{weight}  {finding.key}: {finding.sentence}")
    click.echo("The service can run with this map." if runs else "The service cannot run with it.")


def _inputs(plan: Plan) -> list[Row]:
    return [
        {
            "input": name,
            "signal": f"{mapped.message}.{mapped.value.name}",
            "unit": mapped.unit,
            "step": f"{abs(mapped.value.scale):.3g} {KINDS[name].value}",
            "believed": _believed(mapped),
            "cycle": _cycle(plan.messages.get(mapped.message)),
        }
        for name, mapped in plan.inputs.items()
    ]


def _outputs(plan: Plan) -> list[Row]:
    return [
        {
            "output": field.key,
            "signal": f"{field.message}.{field.signal.name}",
            "cycle": _cycle(output.message),
        }
        for output in plan.outputs
        for field in output.fields
    ]


def _believed(mapped: MappedInput) -> str:
    rules = (*mapped.page, *mapped.rules)
    words = " and ".join(_in_words(rule, mapped) for rule in rules)
    return f"while {words}" if words else "always"


def _in_words(rule: Rule, mapped: MappedInput) -> str:
    if isinstance(rule, RangeRule):
        return f"from {rule.low:g} to {rule.high:g}"
    own = rule.signal.name == mapped.value.name
    values = ", ".join(map(str, sorted(rule.values)))
    return f"{'raw' if own else rule.signal.name} is {'' if rule.wanted else 'not '}{values}"


def _cycle(message: MappedMessage | None) -> str:
    return "unknown" if message is None else f"{message.cycle_ms:g} ms"
