"""``tcs-hil campaign``."""

from __future__ import annotations

import shlex
import sys
from pathlib import Path
from typing import Any

import click
import msgspec
from msgspec import to_builtins
from msgspec.structs import replace
from rich.console import Console
from rich.table import Table as Page

from plant_emulator.session import check_own_car
from tcs_hil.cli.progress import progress_bar
from tcs_hil.config import convert
from tcs_hil.console import counted, refuse
from tcs_hil.errors import ConfigError
from tcs_hil.hil.processes.interruption import interrupted_by_sigterm
from tcs_hil.hil.study.design import corners, points
from tcs_hil.hil.study.plan import Plan, Study, read_plan
from tcs_hil.hil.study.trial import Row, job, run
from tcs_hil.hil.toml import write_toml
from tcs_hil.loading import loading

WORST = 8
FIGURES = ("rmse_ratio", "peak_slip_ratio", "gain_ratio", "spin_s", "limit_cycle_hz", "error")


@click.command()
@click.argument("study", type=click.Path(dir_okay=False, path_type=Path))
@click.option(
    "--out",
    type=click.Path(file_okay=False, path_type=Path),
    help="Folder of the results; what it already holds is not driven again. [runs/NAME]",
)
@click.option("--points", type=click.IntRange(1), help="Instead of the study's own.")
@click.option("--seed", type=click.IntRange(0), help="Instead of the study's own.")
@click.option("-j", "--jobs", type=click.IntRange(1), help="Processes on this machine. [its cores]")
@click.option("--scheduler", metavar="tcp://HOST:PORT", help="Drive on this Dask cluster instead.")
@click.option(
    "--only", type=click.IntRange(0), help="Drive one point again, and keep its scenario."
)
@click.option("--json", "as_json", is_flag=True, help="Print every row as JSON.")
def command(study: Path, out: Path | None, only: int | None, as_json: bool, **options: Any) -> None:
    """Vary a scenario over a space of parameters, on every core or on a cluster.

    STUDY is a TOML file: a scenario, what varies, and what counts as success. An
    interrupted campaign goes on where it was when it is started again.

    Example: tcs-hil campaign plants.toml --points 200 --out runs/plants
    """
    changes = {name: options[name] for name in ("points", "seed") if options[name] is not None}
    plan = _with(read_plan(study), changes)
    if plan.study.design == "grid":
        refuse(options, ["points", "seed"], "the steps of a grid make its points")
    if options["scheduler"] is not None:
        refuse(options, ["jobs"], "the cluster's workers do the work")
    folder = out or Path("runs") / study.stem
    if only is not None:
        refuse(options, ["jobs", "scheduler"], "--only drives one point, here")
        _again(plan, only, folder, as_json)
        return
    with interrupted_by_sigterm():
        rows, page = _campaign(plan, folder, options["jobs"], options["scheduler"])
    if as_json:
        click.echo(msgspec.json.encode(rows).decode())
    else:
        _show(rows, _again_with(study, folder, changes), page)


def _with(plan: Plan, changes: dict[str, int]) -> Plan:
    study = replace(plan.study, **changes)
    # Bounds are looked at again, as those of the file were.
    return Plan(convert(to_builtins(study), Study, "command line"), plan.scenario)


def _campaign(
    plan: Plan, folder: Path, jobs: int | None, scheduler: str | None
) -> tuple[list[Row], list[str]]:
    # Dask, Arrow and Matplotlib are for this alone: `--only` does without.
    with loading():
        from tcs_hil.hil.study.cluster import drive, workers  # noqa: PLC0415
        from tcs_hil.hil.study.figure import save_study_figure  # noqa: PLC0415
        from tcs_hil.hil.study.table import Table  # noqa: PLC0415

    everything = list(enumerate(points(plan.study)))
    for corner in corners(plan.study):  # what does not exist or fit is refused before anything runs
        check_own_car(job(plan, corner, 0).scenario)
    table = Table(folder, plan)
    tasks = [(index, point) for index, point in everything if index not in table.done]
    if tasks:
        try:
            with workers(scheduler, jobs) as client, progress_bar(plan.study.scenario) as advance:
                for rows in drive(client, plan, tasks):
                    table.add(rows)
                    advance(len(table.done) / len(everything))
        except KeyboardInterrupt:
            _say_how_to_go_on(len(table.done), len(everything))
            raise
        table.finish()
    figure = folder / "campaign.png"
    save_study_figure(figure, plan.study, table.rows)
    return table.rows, [f"Table: {table.path}", f"Figure: {figure}"]


def _say_how_to_go_on(done: int, points: int) -> None:
    same = shlex.join(("tcs-hil", *sys.argv[1:]))
    click.echo(f"interrupted; {done} of {points} points are kept, go on with: {same}", err=True)


def _again(plan: Plan, index: int, folder: Path, as_json: bool) -> None:
    chosen = points(plan.study)
    if index >= len(chosen):
        raise ConfigError(f"--only {index}: the study has {len(chosen)} points, from 0")
    row = run(plan, chosen[index], index)
    driven = job(plan, chosen[index], index)
    path, service = folder / f"point-{index}.toml", folder / f"point-{index}.service.toml"
    path.parent.mkdir(parents=True, exist_ok=True)
    write_toml(path, driven.scenario)
    write_toml(service, driven.config)
    if as_json:
        click.echo(msgspec.json.encode(row).decode())
        return
    for key, value in row.items():
        click.echo(f"{key}: {value}")
    click.echo(f"Again on the bench: tcs-hil hil {path} --config {service}")


def _again_with(study: Path, folder: Path, changes: dict[str, int]) -> str:
    said = [f"--{name} {value}" for name, value in changes.items()]
    return " ".join(["tcs-hil campaign", str(study), *said, f"--out {folder}", "--only"])


def _show(rows: list[Row], again: str, lines: list[str]) -> None:
    from tcs_hil.hil.study.worst import success_share, worst  # noqa: PLC0415

    click.echo(f"{counted(len(rows), 'run')}, success {success_share(rows):.1%}")
    page = Page(title="Worst runs", title_justify="left")
    for name in ("index", *FIGURES):
        page.add_column(name, justify="right")
    chosen = worst(rows, WORST)
    for row in chosen:
        page.add_row(str(row["index"]), *(_cell(row[name]) for name in FIGURES))
    Console().print(page)
    click.echo(f"Drive one again: {again} {chosen[0]['index']}")
    click.echo("\n".join(lines))


def _cell(value: float | str) -> str:
    return value if isinstance(value, str) else f"{value:.3f}"
