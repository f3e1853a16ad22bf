"""Velocity, speed, heading and turning rate on tracks with known answers."""

from __future__ import annotations

import numpy as np
import pytest

import cellcrawl as cc
from tests.conftest import check_start
from tests.runs import circle_on_track, circling, straight


def test_rigid_circle_has_the_velocity_it_is_moved_with():
    velocity = cc.observables.centroid_velocity(straight((0.12, 0.16)))
    assert velocity.dims == ("time", "component")
    assert velocity.attrs["units"] == "R_0 k_off0"
    np.testing.assert_allclose(velocity.sel(component="x"), 0.12, rtol=1e-12)
    np.testing.assert_allclose(velocity.sel(component="y"), 0.16, rtol=1e-12)


def test_speed_and_heading_are_those_of_the_velocity():
    run = straight((-0.12, 0.16))
    np.testing.assert_allclose(cc.observables.speed(run), 0.2, rtol=1e-12)
    np.testing.assert_allclose(cc.observables.heading(run), np.arctan2(0.16, -0.12), rtol=1e-12)
    np.testing.assert_allclose(cc.observables.turning_rate(run), 0.0, atol=1e-12)


def test_velocity_of_a_simulated_cell_is_the_rate_of_change_of_its_centroid(zigzag_parameters):
    run = cc.simulate(
        zigzag_parameters,
        1.0,
        start=check_start(zigzag_parameters),
        solver="paper",
        nodes=400,
        dt=1e-3,
        save_every=0.01,
    )
    velocity = cc.observables.centroid_velocity(run).values
    for column, name in enumerate(("centroid_x", "centroid_y")):
        moved = np.gradient(run[name].values, run["time"].values)
        np.testing.assert_allclose(velocity[1:-1, column], moved[1:-1], atol=1e-3)
    assert np.abs(velocity).max() > 0.1


@pytest.mark.parametrize("rate", [0.4, -0.4])
def test_turning_rate_of_a_circling_cell_is_the_rate_of_its_track(rate):
    run = circling(rate)
    np.testing.assert_allclose(cc.observables.turning_rate(run), rate, rtol=1e-9)
    turned = cc.observables.heading(run).values
    assert turned[-1] - turned[0] == pytest.approx(rate * 40.0)  # well beyond a full turn
    np.testing.assert_allclose(cc.observables.speed(run), 3.0 * abs(rate), rtol=1e-12)


def test_turning_rate_does_not_need_even_times():
    times = np.sort(np.random.default_rng(0).uniform(0.0, 20.0, 200))
    run = circle_on_track(
        times, lambda t: ((np.sin(t), -np.cos(t)), (float(np.cos(t)), float(np.sin(t))))
    )
    np.testing.assert_allclose(cc.observables.turning_rate(run), 1.0, rtol=1e-9)


def test_a_cell_at_rest_has_no_heading():
    stops = circle_on_track(
        np.arange(6.0), lambda t: ((0.0, 0.0), (0.2, 0.0) if t < 3.0 else (0.0, 0.0))
    )
    heading = cc.observables.heading(stops)
    np.testing.assert_array_equal(np.isnan(heading), [False] * 3 + [True] * 3)
    never = circle_on_track(np.arange(3.0), lambda t: ((0.0, 0.0), (0.0, 0.0)))
    assert np.isnan(cc.observables.heading(never)).all()


def test_a_rest_does_not_break_the_unwrapping():
    run = circling(1.0, records=101).copy(deep=True)
    run["normal_velocity"][40:43] = 0.0
    heading = cc.observables.heading(run).values
    np.testing.assert_allclose(heading[[39, 43]], np.array([3.9, 4.3]) + 0.5 * np.pi, rtol=1e-12)


@pytest.mark.parametrize(
    ("measure", "run", "said"),
    [
        (cc.observables.speed, 3, "a run is a Dataset; a track needs times, x and y"),
        (cc.observables.speed, straight().drop_vars("x"), "this dataset has no 'x'"),
        (cc.observables.speed, straight().isel(time=[]), "0 records"),
        (cc.observables.turning_rate, straight().isel(time=[0]), "at least 2 records needed"),
        (cc.observables.circularity, straight().isel(time=0), r"\.isel\(time=\[0\]\)"),
    ],
)
def test_a_dataset_that_is_no_run_is_refused_in_one_line(measure, run, said):
    with pytest.raises(cc.InputError, match=said) as error:
        measure(run)
    assert "\n" not in str(error.value)
