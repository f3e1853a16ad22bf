"""Persistence of motion whose memory is known."""

from __future__ import annotations

import math

import numpy as np
import pytest

import cellcrawl as cc
from tests.tracks import circle_track, straight_track


def persistent_random_walk(memory: float, duration: float, seed: int, step: float = 0.05):
    """Unit speed; the heading diffuses so that its correlation is exp(-lag / memory)."""
    random = np.random.default_rng(seed)
    t = step * np.arange(int(duration / step) + 1)
    heading = np.cumsum(math.sqrt(2.0 * step / memory) * random.normal(size=t.size))
    return t, step * np.cumsum(np.cos(heading)), step * np.cumsum(np.sin(heading))


@pytest.mark.parametrize("kind", ["direction", "velocity"])
def test_persistent_random_walk_has_its_memory_as_persistence(kind):
    memory, duration, walks = 2.0, 1000.0, 12
    found = [
        cc.observables.persistence(*persistent_random_walk(memory, duration, seed), kind=kind)
        for seed in range(walks)
    ]
    error = math.sqrt(2.0 * memory / duration / walks)  # as the docstring says
    assert np.mean([f.time for f in found]) == pytest.approx(memory, rel=4.0 * error)
    assert np.mean([f.speed for f in found]) == pytest.approx(1.0, rel=0.05)
    for f in found:
        assert f.length == pytest.approx(f.time * f.speed)


def test_localisation_error_does_not_end_the_persistence():
    t, x, y = persistent_random_walk(5.0, 1000.0, 3)
    noise = 0.05 * np.random.default_rng(4).normal(size=(2, t.size))
    clean = cc.observables.persistence(t, x, y).time
    noisy = cc.observables.persistence(t, x + noise[0], y + noise[1]).time
    assert noisy == pytest.approx(clean, rel=0.15)


def test_a_straight_line_persists_for_ever():
    found = cc.observables.persistence(*straight_track(speed=0.2))
    assert found.time == math.inf
    assert found.speed == pytest.approx(0.2)


def test_a_circle_forgets_within_a_radian_and_a_bit():
    found = cc.observables.persistence(*circle_track(rate=0.2, radius=2.0))
    assert found.time == pytest.approx(math.acos(math.exp(-1.0)) / 0.2, rel=1e-2)


@pytest.mark.parametrize("kind", ["direction", "velocity"])
def test_correlation_of_a_circle_is_the_cosine(kind):
    found = cc.observables.velocity_correlation(*circle_track(rate=0.2), kind=kind)
    np.testing.assert_allclose(found, np.cos(0.2 * found["lag"]), atol=2e-3)
    assert float(found[0]) == 1.0


def test_mistakes_are_one_line():
    with pytest.raises(cc.InputError, match="kind = 'velocty' is not known"):
        cc.observables.persistence(*straight_track(), kind="velocty")
    with pytest.raises(cc.InputError, match="at least 8 needed"):
        cc.observables.persistence(*straight_track(records=7))
