"""``tcs-hil identify``: presets, recordings, figures for programs, and options that do not fit."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from cli.ended import TcsHil
from click.testing import CliRunner, Result

from tcs_hil.cli.identify import command
from tcs_hil.errors import ConfigError
from tcs_hil.hil.drives import CSV_COLUMNS
from tcs_hil.model.bank import KoopmanBank, default_bank_path
from tcs_hil.model.excitation import ExcitationSettings, excite
from tcs_hil.model.fleet import Fleet, FleetSettings
from tcs_hil.model.predictor import KoopmanPredictor
from tcs_hil.model.vehicle import Vehicle

SMALL_PAPER = "[dataset]\ntrajectories = 40\nsamples = 50\n"
SMALL_BANK = "[bands]\ncount = 2\n[excitation]\nruns = 8\nsamples = 40\n"


def identify(*arguments: str | Path) -> Result:
    return CliRunner().invoke(command, [str(argument) for argument in arguments])


@pytest.fixture
def drive(tmp_path: Path) -> Path:
    """A CSV of one excited wheel."""
    rng = np.random.default_rng(7)
    car = Fleet.draw(Vehicle(), FleetSettings(), 1, rng)
    runs = excite(car, ExcitationSettings(samples=2000), np.array([5.0]), 0.002, rng)
    signals = runs.sample
    columns = (
        runs.speed_mps,
        signals.wheel_speed_radps,
        signals.motor_speed_radps * Vehicle().gear_ratio,
        signals.motor_torque_nm,
        np.vstack((runs.command_nm, runs.command_nm[-1:])),
    )
    path = tmp_path / "drive.csv"
    header = ",".join(CSV_COLUMNS)
    np.savetxt(path, np.hstack(columns), delimiter=",", header=header, comments="")
    return path


def test_the_default_preset_makes_the_bank_that_is_shipped(tmp_path: Path) -> None:
    result = identify("--preset", "default", "--output", tmp_path / "bank.npz", "--json")
    bank = KoopmanBank.load(tmp_path / "bank.npz", 0.002)
    shipped = KoopmanBank.load(default_bank_path(), 0.002)
    np.testing.assert_allclose(bank.a, shipped.a, rtol=1e-7, atol=1e-7)
    errors = json.loads(result.stdout)["errors"]
    assert errors[0]["speed_mps"] == [0.2, 0.5]
    assert all(error["many_steps"] < error["held"] for error in errors)


def test_a_table_shows_the_errors_by_speed(tmp_path: Path) -> None:
    settings = tmp_path / "small.toml"
    settings.write_text(SMALL_BANK)
    chosen = ("--preset", "default", "--settings", settings)
    result = identify(*chosen, "--output", tmp_path / "bank.npz")
    assert "144-216 km/h" in result.stdout


def test_dictionary_and_order_are_options_of_the_paper(tmp_path: Path) -> None:
    settings = tmp_path / "small.toml"
    settings.write_text(SMALL_PAPER)
    output = tmp_path / "p.npz"
    chosen = ("--dictionary", "gaussian", "--order", "3", "--settings", settings)
    result = identify(*chosen, "--output", output)
    provenance = KoopmanPredictor.load(output, 0.002).provenance
    assert (provenance.dictionary, provenance.order) == ("gaussian", 3)
    assert "gaussian, 11 observables" in " ".join(result.stdout.split())  # however it is wrapped


def test_a_recorded_drive_refines_the_bank(drive: Path, tmp_path: Path) -> None:
    output = tmp_path / "mine.npz"
    result = identify("--preset", "default", "--from", drive, "--output", output, "--json")
    assert json.loads(result.stdout)["provenance"]["source"] == "recorded"
    sources = {fit.source for fit in KoopmanBank.load(output, 0.002).provenance.fits}
    assert sources == {"simulated", "recorded"}


@pytest.mark.parametrize(
    ("arguments", "complaint"),
    [
        (("--preset", "paper", "--from", "drive.csv"), "--from: has no effect here; it refines"),
        (("--preset", "default", "--order", "2"), "--order: has no effect here; it is for"),
        (
            ("--preset", "default", "--from", "d.csv", "--seed", "1"),
            "--seed: has no effect here; --from",
        ),
        (("--preset", "default", "--from", "nowhere.csv"), "nowhere.csv: cannot be read"),
    ],
)
def test_options_that_do_not_fit_together_are_refused(
    arguments: tuple[str, ...], complaint: str
) -> None:
    error = identify(*arguments).exception
    assert isinstance(error, ConfigError)
    assert complaint in str(error)


def test_a_run_of_the_bench_becomes_a_bank_that_drives(tcs_hil: TcsHil, tmp_path: Path) -> None:
    """From the bus log and from its MF4, which hold the same frames on different clocks."""
    (tmp_path / "pedal.toml").write_text(pedal())
    out = ("--mode", "in-process", "-j", "1", "--out", str(tmp_path))
    assert tcs_hil("hil", str(tmp_path / "pedal.toml"), *out).status == 0
    run, bank = tmp_path / "runs" / "pedal" / "off", tmp_path / "bank.npz"
    assert tcs_hil("export", str(run), "-o", str(tmp_path / "drive.mf4")).status == 0
    banks = []
    for drive in (run / "bus.blf", tmp_path / "drive.mf4"):
        refine = ("identify", "--preset", "default", "--from", str(drive), "--output", str(bank))
        refined = json.loads(tcs_hil(*refine, "--json").out)
        errors = [pair for pair in refined["errors"] if pair["after"]["predictions"]]
        assert all(p["after"]["many_steps"] < p["before"]["many_steps"] for p in errors)
        assert errors
        banks.append(bank.read_bytes())
    assert banks[0] == banks[1]
    (tmp_path / "mine.toml").write_text('model = "bank.npz"')
    mine = ("--config", str(tmp_path / "mine.toml"), "--controller", "kmpc")
    assert tcs_hil("hil", str(tmp_path / "pedal.toml"), *mine, *out).status == 0


def pedal() -> str:
    """A scenario whose pedal jumps every 30 ms: what a band learns from must move by itself."""
    steps = np.random.default_rng(3).uniform(40.0, 140.0, 100).round(1).tolist()
    points = [[round(0.03 * k + t, 3), nm] for k, nm in enumerate(steps) for t in (0.0, 0.029)]
    return (
        'description = "a restless foot"\nduration_s = 3.0\nstart_speed_kmph = 15.0\n'
        f'controller = {{ kind = "off" }}\nroad = [{{ mu = 0.6 }}]\n'
        f"driver = {{ request = {points} }}\n"
    )
