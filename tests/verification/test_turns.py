"""Turns found on cells whose motion is known exactly."""

from __future__ import annotations

import numpy as np
import pytest

from cellcrawl.verification.turns import period, side_difference, turns
from tests.runs import circle_on_track, straight

STEP = 0.05


def swaying(times: np.ndarray, swings: float, way_out: bool):
    """A cell whose heading swings (or steps on) smoothly around every multiple of 8 in time."""

    def heading(t: float) -> float:
        done = [np.tanh((t - at) / 0.5) for at in range(8, 80, 8)]
        signs = [(-1.0) ** i if swings else 1.0 for i in range(len(done))]
        return float(sum(s * d for s, d in zip(signs, done, strict=True)) * (1 if way_out else -1))

    def track(t: float):
        angle = heading(t)
        return (0.0, 0.0), (0.2 * np.cos(angle), 0.2 * np.sin(angle))

    return circle_on_track(times, track, nodes=64)


@pytest.mark.parametrize("left_first", [True, False])
def test_turns_are_found_with_their_ways(left_first):
    run = swaying(np.arange(0.0, 80.0, STEP), swings=True, way_out=left_first)
    found = turns(run)
    assert [turn.time for turn in found] == pytest.approx(list(range(8, 80, 8)), abs=2 * STEP)
    first = 1 if left_first else -1
    assert [turn.way for turn in found] == [first * (-1) ** i for i in range(len(found))]


def test_a_cell_that_circles_in_steps_turns_one_way():
    run = swaying(np.arange(0.0, 80.0, STEP), swings=False, way_out=True)
    assert {turn.way for turn in turns(run)} == {1}


def test_a_cell_alike_on_both_sides_has_no_side_difference():
    assert np.abs(side_difference(straight(velocity=(0.2, 0.0), nodes=50))).max() < 1e-12


def test_more_linkers_on_the_left_are_counted_positive():
    run = straight(velocity=(0.2, 0.0))
    left = (run["y"] - run["centroid_y"]).transpose("time", "node").values
    for slope in (0.1, -0.1):
        linkers = run["bound_fraction"].copy(data=run["bound_fraction"].values + slope * left)
        difference = side_difference(run.assign(bound_fraction=linkers))
        assert np.all(np.sign(slope) * difference > 0.1)


def test_period_is_that_of_a_sine():
    run = straight(records=801, step=0.1)
    assert period(run, np.sin(2.0 * np.pi * run["time"].values / 7.0)) == pytest.approx(
        7.0, abs=0.1
    )
    assert np.isnan(period(run, np.arange(801.0)))
