import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tcs_hil.gate import Gate, GateSettings, Permission
from tcs_hil.signals import NO_LIMIT

ANY_FLOAT = st.floats(allow_nan=True, allow_infinity=True, allow_subnormal=True)


@pytest.fixture
def gate() -> Gate:
    return Gate(GateSettings(release_rate_nmps=500.0), period_s=0.002)


def test_a_proposal_below_the_request_becomes_the_ceiling(gate: Gate) -> None:
    assert gate.limit(80.0, 250.0, Permission.FOLLOW) == 80.0


def test_a_proposal_that_touches_the_request_is_no_limit(gate: Gate) -> None:
    assert gate.limit(250.0, 250.0, Permission.FOLLOW) == NO_LIMIT
    assert gate.limit(300.0, 250.0, Permission.FOLLOW) == NO_LIMIT


def test_a_negative_proposal_is_a_ceiling_of_zero(gate: Gate) -> None:
    assert gate.limit(-5.0, 250.0, Permission.FOLLOW) == 0.0


def test_a_proposal_that_is_no_number_leaves_the_ceiling_where_it_was(gate: Gate) -> None:
    gate.limit(80.0, 250.0, Permission.FOLLOW)
    assert gate.limit(math.nan, 250.0, Permission.FOLLOW) == 80.0


def test_hold_allows_a_cut_but_never_a_raise(gate: Gate) -> None:
    gate.limit(80.0, 250.0, Permission.FOLLOW)
    assert gate.limit(60.0, 250.0, Permission.HOLD) == 60.0
    assert gate.limit(200.0, 250.0, Permission.HOLD) == 60.0


def test_hold_survives_a_request_that_dips_below_the_ceiling(gate: Gate) -> None:
    gate.limit(80.0, 250.0, Permission.FOLLOW)
    assert gate.limit(80.0, 20.0, Permission.HOLD) == 20.0
    assert gate.limit(200.0, 250.0, Permission.HOLD) == 80.0


def test_release_ramps_to_the_request_and_then_lifts(gate: Gate) -> None:
    gate.limit(247.5, 250.0, Permission.FOLLOW)
    ramp = [gate.limit(math.nan, 250.0, Permission.RELEASE) for _ in range(4)]
    assert ramp == [248.5, 249.5, NO_LIMIT, NO_LIMIT]


def test_release_of_an_unheld_motor_stays_no_limit(gate: Gate) -> None:
    assert gate.limit(math.nan, 250.0, Permission.RELEASE) == NO_LIMIT


def test_release_ramps_on_when_the_request_is_unknown(gate: Gate) -> None:
    gate.limit(0.0, 250.0, Permission.FOLLOW)
    ramp = [gate.limit(math.nan, math.nan, Permission.RELEASE) for _ in range(3)]
    assert ramp == [1.0, 2.0, 3.0]


@given(st.lists(st.tuples(ANY_FLOAT, ANY_FLOAT, st.sampled_from(Permission)), max_size=30))
def test_any_input_gives_a_ceiling_within_the_request_or_none(
    calls: list[tuple[float, float, Permission]],
) -> None:
    gate = Gate(GateSettings(), period_s=0.002)
    for wanted_nm, request_nm, permission in calls:
        limit_nm = gate.limit(wanted_nm, request_nm, permission)
        assert limit_nm >= 0.0
        if limit_nm < NO_LIMIT and not math.isnan(request_nm):
            assert limit_nm <= max(request_nm, 0.0)


@given(st.lists(st.tuples(ANY_FLOAT, ANY_FLOAT), min_size=1, max_size=30))
def test_hold_never_raises_the_ceiling(calls: list[tuple[float, float]]) -> None:
    gate = Gate(GateSettings(), period_s=0.002)
    ceiling_nm = gate.limit(100.0, 250.0, Permission.FOLLOW)
    for wanted_nm, request_nm in calls:
        limit_nm = gate.limit(wanted_nm, request_nm, Permission.HOLD)
        assert limit_nm <= ceiling_nm
