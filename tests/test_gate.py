import math
from collections.abc import Sequence
from itertools import pairwise

import msgspec
import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from tcs_hil.gate import BEYOND_ANY_REQUEST_NM, Gate, Permission
from tcs_hil.safety_settings import GateSettings
from tcs_hil.signals import NO_LIMIT

PERIOD_S = 0.002
FOLLOW, SLOWLY, HOLD, RELEASE = Permission

# Steps of 20 Nm up, 100 Nm down and 1 Nm released a tick; 50 Nm within five ticks;
# lifted three ticks after the request fell below a ceiling.
SETTINGS = GateSettings(
    rise_rate_nmps=10_000.0,
    fall_rate_nmps=50_000.0,
    release_rate_nmps=500.0,
    window_s=0.010,
    window_rise_nm=50.0,
    slack_nm=0.05,
    lift_s=0.006,
)
STEP_NM = {FOLLOW: 20.0, SLOWLY: 1.0, HOLD: 0.0, RELEASE: 1.0}
LAX = msgspec.structs.replace(SETTINGS, window_rise_nm=1e6)

ANY_FLOAT = st.floats(allow_nan=True, allow_infinity=True, allow_subnormal=True)
CALLS = st.lists(
    st.tuples(
        ANY_FLOAT | st.floats(0.0, 300.0),
        ANY_FLOAT | st.floats(0.0, 300.0),
        st.sampled_from(Permission),
    ),
    max_size=60,
)


def holding(torque_nm: float, settings: GateSettings = SETTINGS) -> Gate:
    """A gate that has long held this torque against a request of 250 Nm."""
    gate = Gate(settings, PERIOD_S)
    for _ in range(10):
        gate.limit(torque_nm, 250.0, FOLLOW)
    return gate


def limits(gate: Gate, wanted_nm: float, request_nm: float, who: Permission, n: int) -> list[float]:
    return [gate.limit(wanted_nm, request_nm, who) for _ in range(n)]


def test_a_proposal_below_the_request_becomes_the_ceiling() -> None:
    assert Gate(SETTINGS, PERIOD_S).limit(180.0, 250.0, FOLLOW) == 180.0


@pytest.mark.parametrize("wanted_nm", [249.95, 250.0, 300.0, 1e308])
@pytest.mark.parametrize("who", Permission)
def test_a_motor_that_is_not_held_stays_free(wanted_nm: float, who: Permission) -> None:
    assert limits(Gate(SETTINGS, PERIOD_S), wanted_nm, 250.0, who, 9) == [NO_LIMIT] * 9


def test_a_proposal_below_the_slack_binds() -> None:
    assert Gate(SETTINGS, PERIOD_S).limit(249.9, 250.0, FOLLOW) == 249.9


def test_a_drop_takes_the_ticks_its_rate_asks_for_beginning_at_the_request() -> None:
    assert limits(Gate(SETTINGS, PERIOD_S), 20.0, 250.0, FOLLOW, 4) == [150.0, 50.0, 20.0, 20.0]


def test_a_rise_takes_the_ticks_its_rate_asks_for() -> None:
    assert limits(holding(80.0, LAX), 135.0, 250.0, FOLLOW, 4) == [100.0, 120.0, 135.0, 135.0]


@pytest.mark.parametrize("who", [SLOWLY, HOLD, RELEASE])
def test_trust_comes_back_without_a_step(who: Permission) -> None:
    gate = holding(80.0)
    before_nm = gate.limit(90.0, 250.0, who)
    back = limits(gate, before_nm + 2.5, 250.0, FOLLOW, 4)
    assert back == [before_nm + rise for rise in (1.0, 2.0, 2.5, 2.5)]
    assert gate.limit(before_nm + 12.5, 250.0, FOLLOW) == before_nm + 12.5


def test_a_wish_below_the_ceiling_is_met_at_once() -> None:
    gate = holding(80.0)
    gate.limit(90.0, 250.0, HOLD)
    assert gate.limit(70.0, 250.0, FOLLOW) == 70.0
    assert gate.limit(90.0, 250.0, FOLLOW) == 90.0


def test_a_wish_that_is_no_number_meets_nothing() -> None:
    gate = holding(80.0)
    gate.limit(90.0, 250.0, HOLD)
    assert gate.limit(math.nan, 250.0, FOLLOW) == 80.0
    assert gate.limit(90.0, 250.0, FOLLOW) == 81.0


def test_a_negative_proposal_is_a_ceiling_of_zero() -> None:
    assert limits(holding(80.0), -5.0, 250.0, FOLLOW, 2) == [0.0, 0.0]


@pytest.mark.parametrize("wanted_nm", [math.nan, math.inf, -math.inf])
@pytest.mark.parametrize("who", [FOLLOW, SLOWLY, HOLD])
def test_a_proposal_that_is_no_number_leaves_the_ceiling(wanted_nm: float, who: Permission) -> None:
    assert limits(holding(80.0), wanted_nm, 250.0, who, 9) == [80.0] * 9


def test_slow_following_cuts_at_once_and_raises_like_a_release() -> None:
    gate = holding(80.0)
    assert gate.limit(60.0, 250.0, SLOWLY) == 60.0
    assert limits(gate, 250.0, 250.0, SLOWLY, 3) == [61.0, 62.0, 63.0]


def test_hold_cuts_but_never_raises() -> None:
    gate = holding(80.0)
    assert gate.limit(60.0, 250.0, HOLD) == 60.0
    assert limits(gate, 250.0, 250.0, HOLD, 99) == [60.0] * 99


def test_hold_lifts_nothing() -> None:
    gate = holding(80.0)
    assert limits(gate, 80.0, 50.0, HOLD, 99) == [50.0] * 99
    assert gate.limit(80.0, 250.0, HOLD) == 50.0


def test_release_asks_nobody() -> None:
    assert limits(holding(80.0), 0.0, 250.0, RELEASE, 3) == [81.0, 82.0, 83.0]


def test_release_ends_at_the_request_and_is_lifted_there() -> None:
    ramp = limits(holding(247.5), math.nan, 250.0, RELEASE, 4)
    assert ramp == [248.5, 249.5, NO_LIMIT, NO_LIMIT]


def test_the_window_bounds_what_many_ticks_add_up_to() -> None:
    gate = holding(80.0)
    rise = limits(gate, 250.0, 250.0, FOLLOW, 9)
    # After five ticks the first of the rise, then the next, becomes the lowest in the window.
    assert rise == [100.0, 120.0, 130.0, 130.0, 130.0, 150.0, 170.0, 180.0, 180.0]


def test_the_window_forgets_when_the_ceiling_is_lifted() -> None:
    gate = holding(10.0)
    assert gate.limit(10.0, 10.0, FOLLOW) == NO_LIMIT
    assert gate.limit(180.0, 250.0, FOLLOW) == 180.0
    assert gate.limit(190.0, 250.0, FOLLOW) == 190.0


def test_a_ceiling_that_reaches_the_request_is_lifted() -> None:
    assert holding(240.0).limit(249.94, 250.0, FOLLOW) == 249.94
    assert holding(240.0).limit(249.95, 250.0, FOLLOW) == NO_LIMIT


def test_a_ceiling_that_the_request_fell_below_is_lifted_after_a_while() -> None:
    gate = holding(80.0)
    assert limits(gate, 80.0, 20.0, FOLLOW, 3) == [20.0, 20.0, 20.0]
    assert gate.limit(80.0, 19.0, FOLLOW) == 19.0
    assert limits(gate, 80.0, 19.0, FOLLOW, 3) == [19.0, 19.0, NO_LIMIT]


def test_a_request_that_dips_lowers_the_ceiling_which_then_rises_at_its_rate() -> None:
    gate = holding(80.0)
    assert gate.limit(80.0, 20.0, FOLLOW) == 20.0
    assert limits(gate, 80.0, 250.0, FOLLOW, 4) == [40.0, 60.0, 70.0, 70.0]


@pytest.mark.parametrize("request_nm", [-1e-300, -20.0, -1e308])
def test_a_motor_that_is_asked_to_brake_is_soon_not_held(request_nm: float) -> None:
    assert limits(holding(80.0), 0.0, request_nm, FOLLOW, 4) == [0.0, 0.0, 0.0, NO_LIMIT]


@pytest.mark.parametrize("request_nm", [math.nan, math.inf, -math.inf])
def test_an_unknown_request_leaves_the_ceiling_where_it_is(request_nm: float) -> None:
    assert limits(holding(80.0), math.inf, request_nm, FOLLOW, 9) == [80.0] * 9
    assert Gate(SETTINGS, PERIOD_S).limit(math.inf, request_nm, FOLLOW) == NO_LIMIT


def test_release_ends_although_the_request_is_unknown() -> None:
    ramp = limits(holding(0.0), math.nan, math.nan, RELEASE, 1003)
    assert ramp[:3] == [1.0, 2.0, 3.0]
    assert ramp[998:1000] == [BEYOND_ANY_REQUEST_NM - 1.0, NO_LIMIT]


def test_a_gate_without_patience_lifts_at_once() -> None:
    gate = holding(80.0, msgspec.structs.replace(SETTINGS, lift_s=0.0))
    assert gate.limit(80.0, 20.0, FOLLOW) == NO_LIMIT


def test_a_window_shorter_than_a_tick_still_looks_at_the_last_one() -> None:
    settings = msgspec.structs.replace(SETTINGS, window_s=1e-4, window_rise_nm=5.0)
    assert limits(holding(80.0, settings), 250.0, 250.0, FOLLOW, 2) == [85.0, 90.0]


@pytest.mark.parametrize("window_s", [0.010, 0.012])
def test_the_window_is_as_long_as_it_was_set(window_s: float) -> None:
    gate = holding(80.0, msgspec.structs.replace(SETTINGS, window_s=window_s))
    rise = limits(gate, 250.0, 250.0, FOLLOW, 9)
    assert rise.index(150.0) == round(window_s / PERIOD_S)


def test_the_shipped_rates_are_those_of_the_documentation() -> None:
    assert msgspec.to_builtins(GateSettings()) == {
        "rise_rate_nmps": 20_000.0,
        "fall_rate_nmps": 125_000.0,
        "release_rate_nmps": 500.0,
        "window_s": 0.1,
        "window_rise_nm": 200.0,
        "slack_nm": 0.05,
        "lift_s": 0.02,
    }


@pytest.mark.parametrize(
    "table",
    [
        {"rise_rate_nmps": 0.0},
        {"fall_rate_nmps": 2e6},
        {"release_rate_nmps": -1.0},
        {"window_s": 0.0},
        {"window_s": 1.1},
        {"window_rise_nm": 0.0},
        {"slack_nm": -0.1},
        {"slack_nm": 5.1},
        {"lift_s": -0.1},
        {"lift_s": 1.1},
        {"unheard_of": 1.0},
    ],
)
def test_a_setting_out_of_bounds_is_refused(table: dict[str, float]) -> None:
    with pytest.raises(msgspec.ValidationError):
        msgspec.convert(table, GateSettings)


def run(calls: Sequence[tuple[float, float, Permission]]) -> list[float]:
    gate = Gate(SETTINGS, PERIOD_S)
    return [gate.limit(*call) for call in calls]


@given(CALLS)
@example([(5e-324, 5e-324, FOLLOW), (0.0, 5e-324, FOLLOW), (math.nan, -0.0, RELEASE)])
@example([(0.0, 1e308, FOLLOW), (1e308, 1.7e308, FOLLOW)])
def test_any_input_gives_a_ceiling_within_the_request_or_none(
    calls: list[tuple[float, float, Permission]],
) -> None:
    for limit_nm, (_, request_nm, _) in zip(run(calls), calls, strict=True):
        assert limit_nm >= 0.0
        if limit_nm < NO_LIMIT and math.isfinite(request_nm):
            assert limit_nm <= max(request_nm, 0.0)


@given(CALLS)
def test_nothing_raises_a_ceiling_faster_than_its_permission_allows(
    calls: list[tuple[float, float, Permission]],
) -> None:
    for (before, limit), (_, _, permission) in zip(pairwise(run(calls)), calls[1:], strict=True):
        if limit < NO_LIMIT and before < NO_LIMIT:
            assert limit <= before + STEP_NM[permission]


@given(CALLS)
def test_a_ceiling_is_lifted_only_where_it_could_have_reached_the_request(
    calls: list[tuple[float, float, Permission]],
) -> None:
    for (before, limit), (_, request_nm, permission) in zip(
        pairwise(run(calls)), calls[1:], strict=True
    ):
        if before < NO_LIMIT and limit == NO_LIMIT:
            assert permission is not HOLD
            most_nm = max(request_nm, 0.0) if math.isfinite(request_nm) else BEYOND_ANY_REQUEST_NM
            assert before <= most_nm
            assert most_nm - SETTINGS.slack_nm <= before + STEP_NM[permission]


@given(CALLS)
def test_no_window_sees_more_than_its_rise(calls: list[tuple[float, float, Permission]]) -> None:
    ceilings = run(calls)
    for tick, limit in enumerate(ceilings):
        window = ceilings[max(tick - 5, 0) : tick]
        if limit < NO_LIMIT and NO_LIMIT not in window and window:
            # The sum of the two may be rounded up.
            assert limit <= (min(window) + SETTINGS.window_rise_nm) * (1.0 + 1e-15)


@given(CALLS, st.floats(0.0, 300.0))
def test_a_release_always_ends_without_a_limit(
    calls: list[tuple[float, float, Permission]], request_nm: float
) -> None:
    gate = Gate(SETTINGS, PERIOD_S)
    for call in calls:
        gate.limit(*call)
    assert limits(gate, math.nan, request_nm, RELEASE, 310)[-1] == NO_LIMIT
