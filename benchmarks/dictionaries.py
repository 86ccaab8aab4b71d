"""Dictionaries of the Koopman predictor side by side: size, errors, conditioning.

    python -m benchmarks.dictionaries            a table
    python -m benchmarks.dictionaries --json     the same, for programs

Every row is identified from the paper's data set and judged on the runs of its
figure 1 (20 km/h, 100 steps), which it has not seen: once under torque redrawn
in every sample, as in the data, and once held for 20 ms, as nobody identified it.
"""

from __future__ import annotations

import json

import click
from rich.console import Console
from rich.table import Table

from tcs_hil.cli.progress import progress_bar
from tcs_hil.model.edmd import IdentificationSettings, identify
from tcs_hil.model.evaluation import PredictionErrors, prediction_errors

ROWS = [
    *(("monomials", order) for order in (1, 2, 3, 4, 5)),
    *(("thin-plate", order) for order in (2, 4, 5)),
    *(("gaussian", order) for order in (2, 4, 5)),
]
HELD_PERIODS = 10


@click.command()
@click.option("--json", "as_json", is_flag=True, help="Print JSON instead of a table.")
def main(as_json: bool) -> None:
    """Compare the dictionaries and their orders."""
    rows = []
    with progress_bar("identifying") as advance:
        for done, (name, order) in enumerate(ROWS):
            advance(done / len(ROWS), f"{name} {order}")
            predictor = identify(IdentificationSettings(dictionary=name, order=order))
            free = prediction_errors(predictor)
            held = prediction_errors(predictor, hold=HELD_PERIODS)
            rows.append((name, order, predictor.nz, free, held))
    if as_json:
        click.echo(json.dumps([_as_dict(*row) for row in rows]))
        return
    table = Table(title="median RMSE over 100 steps; torque free and held for 20 ms")
    for heading in ("dictionary", "order", "nz", "s m/s", "omega rad/s", "kappa"):
        table.add_column(heading, justify="right")
    for heading in ("kappa held", "radius", "condition"):
        table.add_column(heading, justify="right")
    for name, order, nz, free, held in rows:
        table.add_row(name, str(order), str(nz), *_cells(free, held))
    Console().print(table)


def _cells(free: PredictionErrors, held: PredictionErrors) -> tuple[str, ...]:
    return (
        f"{free.s_mps:.4f}",
        f"{free.omega_radps:.3f}",
        f"{free.slip_ratio:.4f}",
        f"{held.slip_ratio:.4f}",
        f"{free.spectral_radius:.5f}",
        f"{free.condition_number:.3g}",
    )


def _as_dict(
    name: str, order: int, nz: int, free: PredictionErrors, held: PredictionErrors
) -> dict[str, object]:
    return {
        "dictionary": name,
        "order": order,
        "nz": nz,
        "s_mps": free.s_mps,
        "omega_radps": free.omega_radps,
        "slip_ratio": free.slip_ratio,
        "slip_ratio_held": held.slip_ratio,
        "spectral_radius": free.spectral_radius,
        "condition_number": free.condition_number,
    }


if __name__ == "__main__":
    main()
