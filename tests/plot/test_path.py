"""Which contours lie along a path."""

from __future__ import annotations

import numpy as np
import pytest
from matplotlib.collections import LineCollection

import cellcrawl as cc
from cellcrawl.plot.path import default_every
from tests.runs import straight


def contour_centres(ax) -> np.ndarray:
    """Where the contours on an axes are."""
    edges = [shown for shown in ax.collections if isinstance(shown, LineCollection)]
    return np.array([np.mean([path.vertices[1] for path in e.get_paths()], axis=0) for e in edges])


def test_contours_stand_where_the_cell_was():
    centres = contour_centres(cc.plot.path(straight((0.1, 0.2), records=21), every=5.0))
    np.testing.assert_allclose(
        centres, np.outer([0.0, 5.0, 10.0, 15.0, 20.0], [0.1, 0.2]), atol=1e-9
    )


def test_each_piece_of_a_contour_has_the_colour_of_its_node():
    run = straight(records=3)
    ax = cc.plot.path(run, every=2.0)
    edges = [shown for shown in ax.collections if isinstance(shown, LineCollection)]
    np.testing.assert_array_equal(edges[-1].get_array(), run["bound_fraction"].values[2])
    nodes = np.array([path.vertices[1] for path in edges[-1].get_paths()])
    np.testing.assert_array_equal(nodes[:, 0], run["x"].values[2])


@pytest.mark.parametrize("speed", [0.03, 0.055, 0.19, 0.2, 3.0])
def test_usual_contours_hardly_overlap_and_are_not_far_apart(speed):
    run = straight((speed, 0.0), records=1001, step=0.1)
    apart = speed * default_every(run) / 2.0  # in diameters
    assert 0.7 < apart < 1.6


def test_a_run_that_ended_early_shows_its_last_shape():
    torn = straight((0.2, 0.0), records=14).assign_attrs(status="fragmented")
    np.testing.assert_allclose(
        contour_centres(cc.plot.path(torn, every=10.0))[:, 0], [0.0, 2.6], atol=1e-9
    )
    np.testing.assert_allclose(
        contour_centres(cc.plot.path(torn, every=8.0))[:, 0], [0.0, 1.6, 2.6], atol=1e-9
    )


def test_contours_count_from_the_first_record_of_a_selection():
    late = straight((0.2, 0.0), records=21).sel(time=slice(7, 20))
    np.testing.assert_allclose(
        contour_centres(cc.plot.path(late, every=10.0))[:, 0], [1.4, 3.4], atol=1e-9
    )
