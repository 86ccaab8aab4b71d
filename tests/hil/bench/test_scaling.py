"""Horizon and order, one at a time."""

from __future__ import annotations

from tcs_hil.hil.bench.effort import QUICK
from tcs_hil.hil.bench.scaling import measure_scaling


def test_each_law_is_stretched_and_only_the_koopman_one_lifted_higher() -> None:
    effort = QUICK._replace(questions=60, horizons=(1, 3), orders=(2,))
    rows = measure_scaling(effort, lambda _share, _what: None)
    seen = {(row.law, row.axis, row.value) for row in rows}
    assert seen == {
        *(("KMPC", "horizon", n) for n in (1, 3)),
        *(("NMPC", "horizon", n) for n in (1, 3)),
        ("KMPC", "order", 2),
    }
    assert all(row.cost.cpu.samples > 0 for row in rows)
