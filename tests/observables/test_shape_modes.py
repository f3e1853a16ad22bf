"""Shape modes are the directions in which shapes were made to vary."""

from __future__ import annotations

import numpy as np
import pytest

import cellcrawl as cc
from tests.runs import straight

modes = cc.observables.shape_modes
T = np.linspace(0.0, 2.0 * np.pi, 160, endpoint=False)


def shapes(count: int, seed: int, size: float = 1.0) -> list[np.ndarray]:
    """Ovals of several lengths and a little triangle, turned, moved and begun anywhere."""
    random = np.random.default_rng(seed)
    found = []
    for _ in range(count):
        stretch, corner = np.exp(0.25 + 0.12 * random.normal()), 0.1 + 0.02 * random.normal()
        z = stretch * np.cos(T) + corner * np.cos(2.0 * T) + 1j * np.sin(T) / stretch
        z = np.roll(z * np.exp(1j * random.uniform(0.0, 6.28)), random.integers(160))
        place = random.uniform(-9.0, 9.0, 2)
        found.append(size * (np.column_stack([z.real, z.imag]) + place))
    return found


def test_the_first_modes_are_those_that_were_drawn():
    found = modes(shapes(60, 1), shapes(60, 2, size=30.0))
    assert found.explained[0] > 0.8
    assert found.explained[:2].sum() > 0.95
    flat = found.modes.reshape(found.modes.shape[0], -1)
    np.testing.assert_allclose(flat @ flat.T, np.eye(len(flat)), atol=1e-9)
    assert [len(one) for one in found.scores] == [60, 60]
    # one space: the two series differ in size only, and size is taken off
    assert abs(found.scores[0][:, 0].mean() - found.scores[1][:, 0].mean()) < 0.2


def test_place_turn_size_and_first_point_do_not_matter():
    given = shapes(20, 3)
    found = modes(given)
    turned = [np.roll(one @ np.array([[0.6, 0.8], [-0.8, 0.6]]), 50, axis=0) * 7.0 for one in given]
    # the first point falls between two of the 100, whence the slack
    np.testing.assert_allclose(found.project(turned), found.scores[0], atol=0.05)


def test_an_outline_is_its_scores_along_the_modes():
    found = modes(shapes(30, 4), modes=6)
    again = found.shape(found.scores[0][5])
    assert again.shape == found.mean.shape
    # six modes hold nearly all of it; what is drawn anew is sampled and smoothed anew
    np.testing.assert_allclose(found.project([again])[0], found.scores[0][5], atol=0.2)
    np.testing.assert_array_equal(found.shape(np.zeros(3)), found.mean)


def test_mirror_images_are_one_shape_on_request():
    given = shapes(20, 5)
    skewed = [one + 0.15 * np.column_stack([np.sin(2.0 * T), np.zeros(160)]) for one in given]
    mirrored = [one[::-1] * [1.0, -1.0] for one in skewed]
    apart = modes(skewed, mirrored)
    together = modes(skewed, mirrored, reflect=True)
    assert together.variances.sum() < apart.variances.sum()


def test_runs_and_outlines_share_a_space():
    run = straight(records=6)
    found = modes(run, shapes(10, 6))
    assert found.scores[0].shape[0] == 6


def test_mistakes_are_one_line():
    with pytest.raises(cc.InputError, match="two outlines at least"):
        modes(shapes(1, 0))
    with pytest.raises(cc.InputError, match="a series of shapes is"):
        modes(cc.observables.speed(straight(records=5)).to_dataset())
