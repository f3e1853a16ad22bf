"""The fitted walk is the one that was drawn, with the error of its positions."""

from __future__ import annotations

import math

import numpy as np
import pytest

import cellcrawl as cc
from cellcrawl.microscopy import Track, Tracks
from tests.tracks import straight_track

fit = cc.observables.persistent_walk
MEMORY, SPEED = 4.0, 1.5


def walk(records: int, error: float, seed: int, exposure: float = 0.0, fine: int = 25):
    """An Ornstein-Uhlenbeck velocity, integrated; each position a mean over the exposure."""
    random = np.random.default_rng(seed)
    step, size = 1.0 / fine, records * fine
    kept = math.exp(-step / MEMORY)
    kicks = math.sqrt(1.0 - kept**2) * random.normal(size=(2, size))
    velocity = np.empty((2, size))
    velocity[:, 0] = random.normal(size=2)
    for i in range(1, size):
        velocity[:, i] = kept * velocity[:, i - 1] + kicks[:, i]
    path = np.cumsum(SPEED / math.sqrt(2.0) * velocity * step, axis=1)
    wide = max(1, round(exposure * fine))
    means = np.lib.stride_tricks.sliding_window_view(path, wide, axis=1).mean(axis=2)
    places = means[:, ::fine][:, :records]
    return np.arange(places.shape[1], dtype=float), *(
        places + error * random.normal(size=places.shape)
    )


@pytest.mark.parametrize(("error", "exposure"), [(0.0, 0.0), (0.4, 0.0), (0.4, 1.0)])
def test_a_walk_is_found_with_its_localisation_error(error, exposure):
    tracks = Tracks.of([Track(*walk(150, error, seed, exposure)) for seed in range(6)])
    found = fit(tracks, exposure=exposure)
    for estimate, right in (
        (found.time, MEMORY),
        (found.speed, SPEED),
        (found.localisation_error, error),
    ):
        assert estimate.low - 1e-9 <= right <= estimate.high * 1.05
    assert found.time.value == pytest.approx(MEMORY, rel=0.3)
    assert found.speed.value == pytest.approx(SPEED, rel=0.12)
    assert found.localisation_error.value == pytest.approx(error, abs=0.06)


def test_dropped_frames_do_not_bias_the_fit():
    t, x, y = walk(900, 0.3, 11)
    kept = np.random.default_rng(1).random(t.size) < 0.5
    found = fit(t[kept], x[kept], y[kept])
    assert found.time.low < MEMORY < found.time.high
    assert found.speed.low < SPEED < found.speed.high


def test_units_scale_the_fit():
    t, x, y = walk(200, 0.3, 2)
    plain, scaled = fit(t, x, y), fit(60.0 * t, 0.5 * x, 0.5 * y)
    assert scaled.time.value == pytest.approx(60.0 * plain.time.value, rel=1e-2)
    assert scaled.speed.value == pytest.approx(plain.speed.value / 120.0, rel=1e-2)
    assert "Johnson" in plain.estimator


def test_the_displacement_of_the_fit_is_fuerths():
    found = fit(*walk(200, 0.3, 2))
    lags = np.array([1e-4, 1e4]) * found.time.value
    short, long = found.mean_squared_displacement(lags) - 4.0 * found.localisation_error.value**2
    assert short == pytest.approx((found.speed.value * lags[0]) ** 2, rel=1e-2)
    assert long == pytest.approx(4.0 * found.diffusion_coefficient * lags[1], rel=1e-3)


def test_mistakes_are_one_line():
    with pytest.raises(cc.InputError, match="never moves"):
        fit(np.arange(30.0), np.zeros(30), np.zeros(30))
    with pytest.raises(cc.InputError, match="at least 20 needed"):
        fit(*straight_track(records=15))
    with pytest.raises(cc.InputError, match="exposure = 3"):
        fit(*straight_track(records=30, step=1.0), exposure=3.0)
