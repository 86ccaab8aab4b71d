"""``tcs-hil identify``."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click
from msgspec.structs import replace

from tcs_hil.cli.identified import show_bank, show_predictor, show_refined
from tcs_hil.cli.options import check_folder, json_option
from tcs_hil.cli.progress import progress_bar
from tcs_hil.config import read_toml
from tcs_hil.console import refuse
from tcs_hil.control.settings import ControlSettings
from tcs_hil.hil.drives import read_drive
from tcs_hil.model.bank import KoopmanBank, default_bank_path
from tcs_hil.model.bank_evaluation import simulated_errors
from tcs_hil.model.bank_identification import BANK_SEED, identify_bank
from tcs_hil.model.bank_provenance import BankSettings
from tcs_hil.model.edmd import DEFAULT_SEED, IdentificationSettings, identify
from tcs_hil.model.evaluation import figure1, prediction_errors
from tcs_hil.model.lifting import DICTIONARIES
from tcs_hil.model.recorded_identification import refine

PAPER_ONLY = ("figure", "dictionary", "order")


@click.command()
@click.option(
    "--preset",
    type=click.Choice(["paper", "default"]),
    default="paper",
    show_default=True,
    help="paper: one predictor of the quarter car; default: a bank over 0 to 200 km/h.",
)
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
    help="TOML file with what to identify from what; the preset's own without it.",
)
@click.option("--seed", type=click.IntRange(min=0), help="Seed of the data set.")
@click.option("--dictionary", type=click.Choice(DICTIONARIES), help="Observables (preset paper).")
@click.option("--order", type=int, help="Order of the dictionary (preset paper).")
@click.option(
    "--figure",
    type=click.Path(dir_okay=False, path_type=Path),
    help="Also draw the paper's figure 1 into this PNG (preset paper).",
)
@click.option(
    "--from",
    "recordings",
    type=click.Path(dir_okay=False, path_type=Path),
    multiple=True,
    help="Refine the shipped bank on a recorded drive, .blf or .csv; may be repeated "
    "(preset default).",
)
@json_option
def command(preset: str, output: Path, as_json: bool, **options: Any) -> None:
    """Identify a Koopman predictor: data set, lifting, least squares, model file.

    Errors are judged on data the regression has not seen.

    Example: tcs-hil identify --preset default --from drive.blf --output model.npz
    """
    check_folder(output)
    check_folder(options["figure"])
    identification = {"paper": _paper, "default": _default}[preset]
    if preset == "default" and options["recordings"]:
        identification = _recorded
    identification(output, as_json, **options)


def _paper(output: Path, as_json: bool, **options: Any) -> None:
    refuse({"from": options["recordings"]}, ["from"], "it refines the bank of --preset default")
    settings = _paper_settings(options)
    seed = DEFAULT_SEED if options["seed"] is None else options["seed"]
    with progress_bar("simulating the data set") as advance:
        predictor = identify(settings, seed, advance)
    predictor.save(output)
    if options["figure"]:
        from tcs_hil.hil.figures import save_prediction_figure  # noqa: PLC0415 - slow to load

        save_prediction_figure(options["figure"], figure1(predictor))
    show_predictor(predictor, prediction_errors(predictor), output, as_json)


def _paper_settings(options: dict[str, Any]) -> IdentificationSettings:
    path = options["settings_path"]
    settings = read_toml(path, IdentificationSettings) if path else IdentificationSettings()
    said = {key: options[key] for key in ("dictionary", "order") if options[key] is not None}
    return replace(settings, **said)


def _default(output: Path, as_json: bool, **options: Any) -> None:
    refuse(options, PAPER_ONLY, "it is for --preset paper")
    path = options["settings_path"]
    settings = read_toml(path, BankSettings) if path else BankSettings()
    seed = BANK_SEED if options["seed"] is None else options["seed"]
    with progress_bar("simulating and fitting the bands") as advance:
        bank = identify_bank(settings, seed, advance)
    bank.save(output)
    show_bank(bank, simulated_errors(bank), output, as_json)


def _recorded(output: Path, as_json: bool, **options: Any) -> None:
    said = options | {"settings": options["settings_path"]}
    refuse(said, (*PAPER_ONLY, "seed", "settings"), "--from refines the bank that is shipped")
    control = ControlSettings()
    bank = KoopmanBank.load(default_bank_path(), control.period_s)
    vehicle = bank.provenance.settings.vehicle
    recordings, drives = options["recordings"], []
    with progress_bar("reading") as advance:
        for done, path in enumerate(recordings):
            advance(done / len(recordings), f"reading {path}")
            drives.append(read_drive(path, control, vehicle))
    refined = refine(bank, drives)
    refined.bank.save(output)
    show_refined(refined, output, as_json)
