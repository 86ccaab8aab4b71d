"""The figures of an identification on the screen."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

import click
import msgspec
from rich.console import Console
from rich.table import Table

from tcs_hil.model.bank import KoopmanBank
from tcs_hil.model.bank_evaluation import STEPS, BinError
from tcs_hil.model.evaluation import PredictionErrors
from tcs_hil.model.predictor import KoopmanPredictor
from tcs_hil.model.recorded_identification import Refined


def show_predictor(
    predictor: KoopmanPredictor, errors: PredictionErrors, output: Path, as_json: bool
) -> None:
    """Print the figures that tell a good predictor from a bad one."""
    provenance = predictor.provenance
    if as_json:
        _print_json(errors, provenance, output)
        return
    table = Table(title=f"{output}: {provenance.dictionary}, {len(predictor.a)} observables")
    table.add_column("figure")
    table.add_column("value", justify="right")
    for name, value in (
        ("samples", f"{provenance.fit.samples}"),
        (f"RMSE of s over {errors.steps} steps", f"{errors.s_mps:.4f} m/s"),
        (f"RMSE of omega over {errors.steps} steps", f"{errors.omega_radps:.3f} rad/s"),
        (f"RMSE of kappa over {errors.steps} steps", f"{errors.slip_ratio:.4f}"),
        ("spectral radius of A", f"{errors.spectral_radius:.5f}"),
        ("condition number of the regressor", f"{errors.condition_number:.3g}"),
    ):
        table.add_row(name, value)
    Console().print(table)
    click.echo(f"errors are medians over {errors.draws} random torque sequences it has not seen")


def show_bank(bank: KoopmanBank, errors: list[BinError], output: Path, as_json: bool) -> None:
    """Print the errors of a bank by speed."""
    if as_json:
        _print_json(errors, bank.provenance, output)
        return
    _print_bins(
        f"{output}: {len(bank.centre_mps)} bands; RMSE of kappa on simulated cars it has not seen",
        ("1 step", f"{STEPS} steps", "if held"),
        ((error, (error.one_step, error.many_steps, error.held)) for error in errors),
    )


def show_refined(refined: Refined, output: Path, as_json: bool) -> None:
    """Print what the recordings changed, by speed."""
    if as_json:
        pairs = [{"before": pair.before, "after": pair.after} for pair in refined.errors]
        _print_json(pairs, refined.bank.provenance, output)
        return
    recorded = sum(fit.source == "recorded" for fit in refined.bank.provenance.fits)
    _print_bins(
        f"{output}: {recorded} of {len(refined.bank.centre_mps)} bands refined; "
        f"RMSE of kappa after {STEPS} steps on blocks it has not seen",
        ("before", "after", "if held"),
        (
            (pair.after, (pair.before.many_steps, pair.after.many_steps, pair.after.held))
            for pair in refined.errors
        ),
    )


def _print_bins(
    title: str,
    headings: tuple[str, ...],
    rows: Iterable[tuple[BinError, tuple[float, ...]]],
) -> None:
    table = Table(title=title)
    for heading in ("speed", "predictions", *headings):
        table.add_column(heading, justify="right")
    for error, figures in rows:
        low, high = (3.6 * edge for edge in error.speed_mps)
        cells = (f"{figure:.4f}" if error.predictions else "-" for figure in figures)
        table.add_row(f"{low:.0f}-{high:.0f} km/h", str(error.predictions), *cells)
    Console().print(table)


def _print_json(errors: object, provenance: object, output: Path) -> None:
    content = {"errors": errors, "provenance": provenance, "file": str(output)}
    click.echo(msgspec.json.encode(content))
