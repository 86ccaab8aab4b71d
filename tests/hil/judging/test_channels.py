"""Names of what can be limited."""

from __future__ import annotations

import pytest

from tcs_hil.errors import ConfigError
from tcs_hil.hil.judging.channels import namespace

NAMES = namespace(None)


def test_there_is_one_namespace_over_bus_service_and_truth() -> None:
    assert NAMES.find("bus.TorqueLimitL").unit == "Nm"
    assert NAMES.find("service.slip_ratio_fl").unit == ""
    assert NAMES.find("truth.motor_torque_fr_nm").unit == "Nm"
    assert NAMES.find("truth.speed_mps").unit == "m/s"


def test_a_name_that_is_unique_needs_no_prefix() -> None:
    assert str(NAMES.find("TorqueLimitL")) == "bus.TorqueLimitL"
    assert str(NAMES.find("mu_rl")) == "truth.mu_rl"
    assert str(NAMES.find("latency_us")) == "service.latency_us"


def test_a_name_that_two_sources_have_is_refused_with_both() -> None:
    with pytest.raises(ConfigError, match=r"truth\.slip_ratio_fl or service\.slip_ratio_fl"):
        NAMES.find("slip_ratio_fl")


@pytest.mark.parametrize(
    ("misspelt", "meant"),
    [
        ("truth.slip_ratoi_fl", "truth.slip_ratio_fl"),
        ("torquelimitl", "TorqueLimitL"),
        ("service.overun", "service.overrun"),
    ],
)
def test_a_misspelt_name_is_refused_with_what_may_have_been_meant(
    misspelt: str, meant: str
) -> None:
    with pytest.raises(ConfigError, match=f"no signal '{misspelt}'; did you mean .*{meant}"):
        NAMES.find(misspelt)


def test_states_are_known_by_their_labels() -> None:
    assert NAMES.find("service.state").labels["FAULT"] == 5.0
    assert NAMES.find("bus.TcsState").labels["ACTIVE"] == 3.0


@pytest.mark.parametrize("name", ["latency_us", "service.overrun", "service.wake_jitter_us"])
def test_times_of_the_machine_need_a_clock(name: str) -> None:
    assert NAMES.find(name).clocked
    assert not NAMES.find("service.state").clocked
