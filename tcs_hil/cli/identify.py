"""``tcs-hil identify``."""

from __future__ import annotations

from pathlib import Path

import click
import msgspec
from rich.console import Console
from rich.table import Table

from tcs_hil.cli.options import json_option
from tcs_hil.cli.progress import progress_bar
from tcs_hil.config import read_toml
from tcs_hil.errors import ConfigError
from tcs_hil.model.edmd import DEFAULT_SEED, IdentificationSettings, identify
from tcs_hil.model.evaluation import PredictionErrors, figure1, prediction_errors
from tcs_hil.model.predictor import KoopmanPredictor


@click.command()
@click.option(
    "--output",
    type=click.Path(dir_okay=False, path_type=Path),
    default=Path("model.npz"),
    show_default=True,
    help="Model file to write.",
)
@click.option(
    "--settings",
    "settings_path",
    type=click.Path(dir_okay=False, path_type=Path),
    help="TOML file with vehicle, data set, dictionary and order; the paper's without it.",
)
@click.option("--seed", type=click.IntRange(min=0), help="Seed of the data set.")
@click.option(
    "--figure",
    type=click.Path(dir_okay=False, path_type=Path),
    help="Also draw the paper's figure 1 into this PNG.",
)
@json_option
def command(
    output: Path, settings_path: Path | None, seed: int | None, figure: Path | None, as_json: bool
) -> None:
    """Identify a Koopman predictor: data set, lifting, least squares, model file.

    Example: tcs-hil identify --output model.npz --figure prediction.png
    """
    if not output.absolute().parent.is_dir():
        raise ConfigError(f"{output}: there is no such folder to write the model file into")
    settings = (
        read_toml(settings_path, IdentificationSettings)
        if settings_path
        else IdentificationSettings()
    )
    with progress_bar("simulating the data set") as advance:
        predictor = identify(settings, DEFAULT_SEED if seed is None else seed, advance)
    predictor.save(output)
    if figure:
        from tcs_hil.hil.figures import save_prediction_figure  # noqa: PLC0415 - slow to load

        save_prediction_figure(figure, figure1(predictor))
    show(predictor, prediction_errors(predictor), output, as_json)


def show(
    predictor: KoopmanPredictor, errors: PredictionErrors, output: Path, as_json: bool
) -> None:
    """Print the figures that tell a good predictor from a bad one."""
    if as_json:
        provenance = msgspec.to_builtins(predictor.provenance)
        click.echo(
            msgspec.json.encode({"errors": errors, "provenance": provenance, "file": str(output)})
        )
        return
    table = Table(
        title=f"{output}: {predictor.provenance.dictionary}, {len(predictor.a)} observables"
    )
    table.add_column("figure")
    table.add_column("value", justify="right")
    for name, value in (
        ("samples", f"{predictor.provenance.fit.samples}"),
        (f"RMSE of s over {errors.steps} steps", f"{errors.s_mps:.4f} m/s"),
        (f"RMSE of omega over {errors.steps} steps", f"{errors.omega_radps:.3f} rad/s"),
        (f"RMSE of kappa over {errors.steps} steps", f"{errors.slip_ratio:.4f}"),
        ("spectral radius of A", f"{errors.spectral_radius:.5f}"),
        ("condition number of the regressor", f"{errors.condition_number:.3g}"),
    ):
        table.add_row(name, value)
    Console().print(table)
    click.echo(f"errors are medians over {errors.draws} random torque sequences it has not seen")
