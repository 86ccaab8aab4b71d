"""Dictionaries of the Koopman predictor side by side: size, errors, conditioning.

    python -m benchmarks.dictionaries            a table
    python -m benchmarks.dictionaries --json     the same, for programs

Every row is identified from the paper's data set and judged on the runs of its
figure 1 (20 km/h, 100 steps), which it has not seen: once under torque redrawn
in every sample, as in the data, and once held for 20 ms, as nobody identified it.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import click

from benchmarks.options import json_option
from benchmarks.section import markdown, tell
from tcs_hil.cli.progress import progress_bar
from tcs_hil.model.edmd import IdentificationSettings, identify
from tcs_hil.model.evaluation import PredictionErrors, prediction_errors

ROWS = [
    *(("monomials", order) for order in (1, 2, 3, 4, 5)),
    *(("thin-plate", order) for order in (2, 4, 5)),
    *(("gaussian", order) for order in (2, 4, 5)),
]
HEADINGS = (
    *("dictionary", "order", "nz", "s m/s", "omega rad/s", "kappa"),
    *("kappa held", "radius", "condition"),
)
HELD_PERIODS = 10


@dataclass(frozen=True)
class Row:
    """One dictionary of one order; torque free, and held for 20 ms."""

    dictionary: str
    order: int
    nz: int
    free: PredictionErrors
    held: PredictionErrors

    def cells(self) -> list[str]:
        """In the order of ``HEADINGS``."""
        free = self.free
        return [
            *(self.dictionary, f"{self.order}", f"{self.nz}"),
            *(f"{free.s_mps:.4f}", f"{free.omega_radps:.3f}", f"{free.slip_ratio:.4f}"),
            *(f"{self.held.slip_ratio:.4f}", f"{free.spectral_radius:.5f}"),
            f"{free.condition_number:.3g}",
        ]


def judged() -> Iterator[Row]:
    """Every row, identified and judged, with progress on stderr."""
    with progress_bar("identifying") as advance:
        for done, (name, order) in enumerate(ROWS):
            advance(done / len(ROWS), f"{name} {order}")
            predictor = identify(IdentificationSettings(dictionary=name, order=order))
            free = prediction_errors(predictor)
            held = prediction_errors(predictor, hold=HELD_PERIODS)
            yield Row(name, order, predictor.nz, free, held)


@click.command()
@json_option
def main(machine_readable: bool) -> None:
    """Compare the dictionaries and their orders."""
    rows = list(judged())
    table = markdown(HEADINGS, [row.cells() for row in rows])
    tell("benchmarks.dictionaries", table, None, rows if machine_readable else None)


if __name__ == "__main__":
    main()
