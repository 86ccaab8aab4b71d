"""Toothed rings and the unit that makes speeds of their edges."""

import math

import numpy as np
import pytest

from plant_emulator.encoder import (
    MISSING,
    SEEN,
    SpeedUnit,
    WheelMotion,
    make_encoder,
    pass_edges,
)

PITCH = 2 * math.pi / 96


def rolling(omega, angle=0.123):
    return WheelMotion(np.full(4, angle), np.full(4, float(omega)))


def watch(speed, duration_s, pitch_error=0.0, missing=-1, dropout_s=0.25, teeth=48):
    """Speed of wheel 0 shown every 2 ms while it turns with ``speed(t)``, in steps of 0.1 ms."""
    start = rolling(speed(0.0))
    encoder = make_encoder(teeth, pitch_error, start, np.random.default_rng(3))
    encoder.numbers[0, MISSING] = missing
    unit = SpeedUnit(encoder, start, dropout_s)
    angle, shown = start.angle_rad[0], []
    for step in range(round(duration_s / 1e-4)):
        time_s = step * 1e-4
        after = angle + speed(time_s + 5e-5) * 1e-4
        pass_edges(encoder, 0, angle, after, time_s, 1e-4)
        angle = after
        if step % 20 == 19:
            shown.append(unit.sample(time_s + 1e-4)[0])
    return np.array(shown), encoder


@pytest.mark.parametrize("omega", [1.75, 10.0, 60.0, 175.0, 500.0])
def test_a_constant_speed_is_read_exactly_with_a_perfect_ring(omega):
    shown, encoder = watch(lambda _: omega, 1.0)
    assert shown == pytest.approx(omega, rel=1e-6)
    assert encoder.numbers[0, SEEN] == pytest.approx(omega / PITCH, abs=1)


def test_an_edge_takes_37_ms_at_2_km_h():
    omega = 2 / 3.6 / 0.318
    assert pytest.approx(0.037, abs=0.001) == PITCH / omega


def test_a_wheel_that_speeds_up_is_seen_late_by_up_to_an_edge():
    shown, _ = watch(lambda t: 2.0 + 10.0 * t, 1.0)
    truth = 2.0 + 10.0 * np.arange(1, 501) * 0.002
    lag_s = (truth - shown) / 10.0
    assert lag_s[50:].min() > 0.0
    assert np.all(lag_s[50:] < 2.1 * PITCH / truth[50:] + 0.002)


def test_a_stopping_wheel_is_capped_by_the_silence_and_then_reads_zero():
    shown, _ = watch(lambda t: 10.0 if t < 0.1 else 0.0, 0.6)
    times = np.arange(1, 301) * 0.002
    silent = times > 0.12
    assert np.all(shown[silent] <= PITCH / (times[silent] - 0.1) + 1e-9)
    assert shown[times < 0.34][-1] > 0.0
    assert not shown[times > 0.36].any()


def test_pitch_errors_ripple_within_their_bound():
    shown, _ = watch(lambda _: 20.0, 1.0, pitch_error=0.02)
    assert 0.0 < np.ptp(shown) / 20.0 < 2 * 2 * 0.02 / 1.0 + 0.01
    assert shown.mean() == pytest.approx(20.0, rel=0.005)


def test_a_missing_tooth_makes_a_dip_once_a_turn():
    shown, encoder = watch(lambda _: 20.0, 2 * math.pi / 20.0 * 3, missing=5)
    assert encoder.numbers[0, SEEN] == pytest.approx(3 * (96 - 2), abs=1)
    dips = np.flatnonzero(np.diff((shown < 19.0).astype(int)) == 1)
    assert len(dips) == 3


def test_backward_rolling_reads_as_forward():
    shown, _ = watch(lambda _: -20.0, 0.5)
    assert shown[20:] == pytest.approx(20.0, rel=1e-6)


def test_turning_round_on_an_edge_counts_it_twice():
    encoder = make_encoder(48, 0.0, rolling(1.0, angle=0.4 * PITCH), np.random.default_rng(0))
    pass_edges(encoder, 0, 0.4 * PITCH, 0.6 * PITCH, 0.0, 1e-4)
    pass_edges(encoder, 0, 0.6 * PITCH, 0.4 * PITCH, 1e-4, 1e-4)
    assert encoder.numbers[0, SEEN] == 2


@pytest.mark.parametrize("jump", [math.nan, math.inf, 1e9])
def test_an_angle_that_jumps_passes_nothing(jump):
    encoder = make_encoder(48, 0.0, rolling(1.0), np.random.default_rng(0))
    pass_edges(encoder, 0, 0.123, jump, 0.0, 1e-4)
    assert encoder.numbers[0, SEEN] == 0
