"""The front: where the ray along the velocity leaves the cell."""

from __future__ import annotations

import numpy as np
import pytest

import cellcrawl as cc
from tests.runs import NODES, circle_on_track, circling, straight

TURN = 2.0 * np.pi


@pytest.mark.parametrize("direction", [0.0, 1.0, 2.0, 3.1, 4.0, 6.2])
@pytest.mark.parametrize("node_0", [0.0, 2.5])
def test_front_of_a_gliding_circle_is_in_the_direction_of_motion(direction, node_0):
    run = straight((0.1 * np.cos(direction), 0.1 * np.sin(direction)), node_0=node_0)
    front = cc.observables.front_position(run)
    missed = (front - (direction - node_0) / TURN + 0.5) % 1.0 - 0.5
    assert np.abs(missed).max() < 0.1 / NODES**2  # the chord between nodes is not the arc
    assert ((front >= 0.0) & (front < 1.0)).all()


def test_front_goes_round_with_a_circling_cell():
    front = cc.observables.front_position(circling(0.5)).values
    turned = np.unwrap(TURN * front)
    assert turned[-1] - turned[0] == pytest.approx(0.5 * 40.0, abs=1e-3)


def test_the_farthest_crossing_counts():
    """A ray to the right leaves a hook-shaped cell at x = 1, enters its tip at 2, leaves at 3."""
    outline = np.array(
        [(-1, -1), (3, -1), (3, 1), (2, 1), (2, -0.5), (1, -0.5), (1, 1), (-1, 1)], dtype=float
    )
    run = straight((0.1, 0.0), records=1, nodes=8).copy(deep=True)
    run["x"][0], run["y"][0] = outline.T
    run["length"][0] = 22.0  # between corners the nodes are not equally spaced
    # No physical velocity: only the ray matters, and the mean of this one points right.
    run["normal_velocity"][0] = outline[:, 0] - outline[:, 0].mean()
    velocity = cc.observables.centroid_velocity(run).values[0]
    slope = velocity[1] / velocity[0]
    assert velocity[0] > 0.0
    assert abs(slope) < 0.3
    expected = (1.0 + (3.0 * slope + 1.0) / 2.0) / 8.0
    assert cc.observables.front_position(run).values[0] == pytest.approx(expected)


def test_records_at_rest_take_the_last_front_and_the_first_ones_the_next():
    moves = {2: (0.1, 0.0), 3: (0.0, 0.1)}
    run = circle_on_track(np.arange(6.0), lambda t: ((0.0, 0.0), moves.get(int(t), (0.0, 0.0))))
    front = cc.observables.front_position(run).values
    np.testing.assert_allclose(front, [0.0, 0.0, 0.0, 0.25, 0.25, 0.25], atol=1e-12)


def test_a_cell_that_never_moves_has_no_front():
    run = circle_on_track(np.arange(3.0), lambda t: ((0.0, 0.0), (0.0, 0.0)))
    assert np.isnan(cc.observables.front_position(run)).all()
