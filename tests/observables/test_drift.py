"""Motion that all tracks share is found, and only that."""

from __future__ import annotations

import numpy as np
import pytest

import cellcrawl as cc
from cellcrawl.microscopy import Track, Tracks

shared, without = cc.observables.shared_drift, cc.observables.without_drift


def cells(count: int, drift, seed: int = 0, lost: float = 0.0) -> Tracks:
    """Cells at rest with noise, moved by ``drift`` (2, 60)."""
    random = np.random.default_rng(seed)
    found = []
    for i in range(count):
        kept = random.random(60) >= lost
        place = drift + 0.05 * random.normal(size=(2, 60)) + random.uniform(0, 100, (2, 1))
        found.append(Track(np.arange(60.0)[kept], *place[:, kept], id=f"cell {i}"))
    return Tracks.of(found)


STEADY = np.stack([0.1 * np.arange(60), 0.03 * np.arange(60)])
SWINGING = np.stack([5.0 * np.sin(2.0 * np.pi * np.arange(60) / 59.0), np.zeros(60)])


@pytest.mark.parametrize("lost", [0.0, 0.3])
@pytest.mark.parametrize("drift", [STEADY, SWINGING])
def test_a_stage_that_drifts_is_found_and_taken_off(drift, lost):
    tracks = cells(8, drift, lost=lost)
    found = shared(tracks)
    assert found.noticed
    assert "drift: all 8 tracks share" in str(found)
    np.testing.assert_allclose(found.x, drift[0] - drift[0, 0], atol=0.25)
    still = without(tracks)
    assert [cc.classify_track(one.t, one.x, one.y).mode for one in still] == ["stationary"] * 8
    assert "taken off" in still.source.notes[-1]
    assert still.ids == tracks.ids


def test_cells_that_go_their_own_ways_share_nothing():
    random = np.random.default_rng(3)
    t = np.arange(40.0)
    noticed = 0
    for _ in range(100):
        angles = random.uniform(0.0, 2.0 * np.pi, 8)
        noticed += shared([Track(t, t * np.cos(a), t * np.sin(a)) for a in angles]).noticed
    assert noticed <= 4  # one in a hundred by chance


def test_few_tracks_cannot_tell():
    assert not shared(cells(4, STEADY)).noticed
    with pytest.raises(cc.InputError, match="no tracks"):
        shared([])
