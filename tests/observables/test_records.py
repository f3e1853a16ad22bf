"""Records that have no heading do not count: pauses, repeats, wrong links, masked values."""

from __future__ import annotations

import math

import numpy as np
import pytest

import cellcrawl as cc
from cellcrawl.observables.records import sound, wild_records
from cellcrawl.observables.track import as_track
from tests.tracks import circle_track, sine_track, straight_track


def stop_and_go(angle: float, on: int, off: int, noise: float, records: int = 160):
    moving = np.arange(records) % (on + off) < on
    along = np.cumsum(moving) - 1.0
    random = np.random.default_rng(on * 100 + off)
    error = noise * random.normal(size=(2, records))
    return (
        np.arange(records),
        along * math.cos(angle) + error[0],
        along * math.sin(angle) + error[1],
    )


@pytest.mark.parametrize("noise", [0.0, 0.02, 0.05])
@pytest.mark.parametrize(("on", "off"), [(6, 6), (9, 4), (20, 2), (15, 8)])
@pytest.mark.parametrize("degrees", [0.0, 30.0, 90.0, 133.0, 180.0, 270.0])
def test_a_straight_path_with_pauses_glides_whatever_its_direction(degrees, on, off, noise):
    track = stop_and_go(math.radians(degrees), on, off, noise)
    assert cc.classify_track(*track).mode == "gliding"
    assert cc.observables.turning_events(*track).sizes["turn"] == 0


def test_time_stands_still_in_a_pause():
    found = sound(as_track(*stop_and_go(0.3, 15, 8, 0.02, records=230)))
    assert found.at_rest == pytest.approx(8 / 23, abs=0.08)
    assert np.ptp(np.diff(found.clock)) <= 1.0 + 1e-9


@pytest.mark.parametrize("track", [straight_track(), circle_track(), sine_track()])
def test_a_track_without_pauses_keeps_all_its_records(track):
    given = as_track(*track)
    found = sound(given)
    assert found.track is given
    assert found.wild == ()


@pytest.mark.parametrize("held", [1, 2, 5])
@pytest.mark.parametrize(
    ("track", "mode"),
    [
        (straight_track(records=60), "gliding"),
        (circle_track(records=60, step=1.0), "rotational"),
        (sine_track(records=120, step=1.0), "zigzag"),
    ],
)
def test_a_position_that_is_held_makes_no_turn(track, mode, held):
    t, x, y = track
    for last in (40, t.size):
        x, y = x.copy(), y.copy()
        x[last - held : last], y[last - held : last] = x[last - held - 1], y[last - held - 1]
    assert cc.classify_track(t, x, y).mode == mode


@pytest.mark.parametrize("where", [0, 30, 45, 59])
@pytest.mark.parametrize(
    ("track", "mode"),
    [
        (straight_track(records=60), "gliding"),
        (circle_track(records=60, step=1.0), "rotational"),
        (sine_track(records=60, step=1.0), "zigzag"),
    ],
)
def test_one_wild_record_is_named_and_changes_no_mode(track, mode, where):
    t, x, y = track
    step = float(np.hypot(x[1] - x[0], y[1] - y[0]))
    wild = x.copy()
    wild[where] += 25.0 * step
    found = cc.classify_track(t, wild, y)
    assert found.mode == mode
    assert f"record {where} (t = {t[where]:g}) left out" in found.doubt


def test_no_record_of_a_random_walk_or_of_noise_is_wild():
    for seed in range(40):
        steps = np.random.default_rng(seed).normal(size=(2, 60))
        assert wild_records(*steps).size == 0
        assert wild_records(*steps.cumsum(axis=1)).size == 0


def test_masked_records_are_left_out():
    t, x, y = circle_track(records=60, step=1.0)
    hidden = np.ma.array(x, mask=np.arange(60) % 7 == 3)
    hidden.data[hidden.mask] = 1e6
    clean = ~hidden.mask
    assert cc.classify_track(t, hidden, y) == cc.classify_track(t[clean], x[clean], y[clean])
    np.testing.assert_array_equal(
        cc.observables.mean_squared_displacement(t, hidden, y),
        cc.observables.mean_squared_displacement(t[clean], x[clean], y[clean]),
    )
    with pytest.raises(cc.InputError, match="masked at index"):
        cc.FromOutline(np.ma.array(np.eye(3, 2), mask=np.eye(3, 2) > 0))
