"""Turns of tracks made of known turns."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

import cellcrawl as cc
from cellcrawl.observables.turns import swings_of
from tests.tracks import circle_track, straight_track


def track_of(heading: np.ndarray, t: np.ndarray):
    return t, np.cumsum(np.cos(heading)), np.cumsum(np.sin(heading))


def test_each_turn_has_its_time_angle_and_side():
    t = np.linspace(0.0, 100.0, 2001)
    angles, times = np.radians([90.0, -60.0, 120.0]), np.array([20.0, 45.0, 80.0])
    heading = (0.5 * angles * (1.0 + np.tanh((t[:, None] - times) / 1.5))).sum(axis=1)
    found = cc.observables.turning_events(*track_of(heading, t))
    np.testing.assert_allclose(found["time"], times, atol=0.1)
    np.testing.assert_allclose(found["angle"], angles, rtol=0.1)
    np.testing.assert_array_equal(found["sign"], [1, -1, 1])
    assert (found["start"] < found["time"]).all()
    assert (found["time"] < found["end"]).all()


def test_turns_below_the_smallest_do_not_count():
    t = np.linspace(0.0, 100.0, 2001)
    heading = 0.5 * 0.5 * np.tanh(t - 50.0)
    track = track_of(heading, t)
    assert cc.observables.turning_events(*track).sizes["turn"] == 1
    assert cc.observables.turning_events(*track, smallest=0.7).sizes["turn"] == 0
    assert cc.observables.turning_events(*straight_track()).sizes["turn"] == 0


def test_a_circle_is_one_turn_as_long_as_the_track():
    found = cc.observables.turning_events(*circle_track(rate=-0.2))
    assert found.sizes["turn"] == 1
    assert float(found["angle"][0]) == pytest.approx(-20.0, rel=1e-2)


@given(arrays(float, st.integers(2, 60), elements=st.floats(-10.0, 10.0)), st.floats(0.01, 5.0))
def test_swings_alternate_and_are_large_enough_and_join(heading, smallest):
    swings = swings_of(heading, smallest)
    assert (np.abs(swings.angle) >= smallest).all()
    assert (swings.angle[1:] * swings.angle[:-1] < 0.0).all()
    np.testing.assert_array_equal(swings.start[1:], swings.end[:-1])
    np.testing.assert_array_equal(swings.angle, heading[swings.end] - heading[swings.start])
    # nothing is left out: the largest rise and fall are in
    if heading.max() - heading.min() >= smallest:
        assert swings.angle.size
        assert np.ptp(heading[[*swings.start, swings.end[-1]]]) == pytest.approx(np.ptp(heading))


def test_a_smallest_angle_must_be_above_0():
    with pytest.raises(cc.InputError, match="smallest = 0"):
        cc.observables.turning_events(*straight_track(), smallest=0)


@pytest.mark.parametrize("noise", [0.0, 1e-7])
def test_a_rest_before_and_after_a_straight_way_is_no_turn(noise):
    t = 0.1 * np.arange(601)
    along = np.clip(0.2 * (t - 20.0), 0.0, 4.0)  # at rest up to 20 and from 40 on
    back = -1e-4 * np.minimum(t, 20.0)  # and drifting the other way before
    x, y = np.random.default_rng(1).normal(scale=noise or 1e-300, size=(2, t.size))
    found = cc.observables.turning_events(t, along + back + x, y)
    assert found.sizes["turn"] == 0
