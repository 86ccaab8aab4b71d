"""Settings: the paper's by default, bounded, and strict about unknown keys."""

from __future__ import annotations

import msgspec
import pytest

from tcs_hil.control.settings import ControlSettings


def test_the_defaults_are_table_ii_of_the_paper() -> None:
    settings = ControlSettings()
    kmpc, nmpc = settings.kmpc, settings.nmpc
    assert (settings.period_s, settings.slip_reference) == (0.002, 0.1)
    assert (kmpc.horizon, nmpc.horizon) == (5, 5)
    assert (kmpc.weight_slip, kmpc.weight_integral, kmpc.weight_reduction) == (0.75, 500.0, 1e-6)
    assert (nmpc.weight_slip, nmpc.weight_integral, nmpc.weight_reduction) == (1e3, 1e5, 1.6e-7)


def test_a_service_nobody_told_otherwise_runs_the_laws_for_a_real_bus() -> None:
    assert ControlSettings().preset == "default"


@pytest.mark.parametrize(
    "table",
    [
        {"slip_reference": 0.0},
        {"slip_reference": 0.6},
        {"period_s": 0.0},
        {"kmpc": {"horizon": 0}},
        {"kmpc": {"weight_reduction": 0.0}},
        {"nmpc": {"weight_slip": -1.0}},
        {"nmpc": {"substeps": 3}},
        {"nmpc": {"max_iterations": 0}},
        {"pi": {"integral_time_s": 0.0}},
        {"pi": {"entry_ratio": 1.5}},
        {"nmpc": {"horison": 5}},
        {"preset": "wild"},
        {"default": {"delay": {"delay_s": 0.1}}},
        {"default": {"nmpc": {"blocks": [1, 3]}}},
        {"default": {"driveline": {"motor_lag_s": 0.0}}},
    ],
)
def test_a_value_out_of_bounds_or_an_unknown_key_is_refused(table: dict[str, object]) -> None:
    with pytest.raises(msgspec.ValidationError):
        msgspec.convert(table, ControlSettings)
