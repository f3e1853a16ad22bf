"""Mean squared displacement of tracks with known answers."""

from __future__ import annotations

import numpy as np
import pytest

import cellcrawl as cc
from tests.runs import straight
from tests.tracks import circle_track, straight_track

msd = cc.observables.mean_squared_displacement


def test_straight_line_has_the_square_of_speed_times_lag():
    found = msd(*straight_track(speed=0.2))
    np.testing.assert_allclose(found, 0.04 * found["lag"] ** 2, rtol=1e-12)


@pytest.mark.parametrize("uneven", [False, True])
def test_circle_comes_back_after_a_turn(uneven):
    """MSD = 2 R^2 (1 - cos(rate lag))."""
    t, x, y = circle_track(rate=0.2, radius=2.0)
    if uneven:
        t = np.sort(np.random.default_rng(0).uniform(0.0, 100.0, 2001))
        x, y = 2.0 * np.cos(0.2 * t), 2.0 * np.sin(0.2 * t)
    found = msd(t, x, y, longest=40.0)
    known = 8.0 * (1.0 - np.cos(0.2 * found["lag"]))
    np.testing.assert_allclose(found, known, rtol=2e-2 if uneven else 1e-9, atol=1e-3 * uneven)


def test_uneven_pairs_are_averaged_at_their_mean_lag():
    t = np.array([0.0, 1.0, 3.0, 4.0])
    found = msd(t, 2.0 * t, 0.0 * t, longest=4.0)
    np.testing.assert_allclose(found["lag"], [1.0, 2.0, 3.0, 4.0])
    np.testing.assert_allclose(found, 4.0 * np.array([1.0, 4.0, 9.0, 16.0]))
    np.testing.assert_array_equal(found["windows"], [2, 1, 2, 1])


def test_lags_end_at_a_quarter_unless_said():
    assert float(msd(*straight_track())["lag"][-1]) == pytest.approx(25.0)
    assert float(msd(*straight_track(), longest=100.0)["lag"][-1]) == pytest.approx(100.0)


def test_localisation_error_adds_four_times_its_variance():
    t, x, y = straight_track(speed=0.0, records=20001)
    noise = 0.3 * np.random.default_rng(1).normal(size=(2, t.size))
    found = msd(t, x + noise[0], y + noise[1], longest=5.0)
    np.testing.assert_allclose(found, 4.0 * 0.3**2, rtol=0.03)


def test_stated_error_is_the_scatter_among_brownian_tracks():
    """Qian, Sheetz & Elson 1991: of overlapping windows, for few and for many of them."""
    random = np.random.default_rng(2)
    t = np.arange(65.0)
    values = np.array(
        [msd(t, *random.normal(size=(2, 65)).cumsum(axis=1), longest=64.0) for _ in range(500)]
    )
    stated = msd(t, *random.normal(size=(2, 65)), longest=64.0)["relative_error"].values
    scatter = values.std(axis=0) / (2.0 * np.arange(1, 65))
    np.testing.assert_allclose(stated[[0, 3, 15, 40, 60]], scatter[[0, 3, 15, 40, 60]], rtol=0.12)
    assert stated[15] == pytest.approx(0.45, abs=0.02)  # at a quarter of the duration


def test_a_run_has_units_and_the_track_of_its_centroid():
    run = straight((0.12, 0.16), records=41)
    found = msd(run)
    np.testing.assert_allclose(found, 0.04 * found["lag"] ** 2, rtol=1e-12)
    assert found.attrs["units"] == "R_0^2"
    assert found["lag"].attrs["units"] == "1/k_off0"


@pytest.mark.parametrize(
    ("call", "said"),
    [
        (lambda: msd(*straight_track(), longest=0.1), "below the interval between records"),
        (lambda: msd(*straight_track(), longest=200.0), "longest = 200"),
        (lambda: msd([0.0, 1.0], [0.0, 1.0], [0.0, 1.0]), "2 records in time"),
        (lambda: msd(straight(), [0.0]), "give a run alone"),
    ],
)
def test_mistakes_are_one_line(call, said):
    with pytest.raises(cc.InputError, match=said) as error:
        call()
    assert "\n" not in str(error.value)
