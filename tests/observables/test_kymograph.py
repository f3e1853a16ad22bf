"""Kymographs: what is at which arclength."""

from __future__ import annotations

import numpy as np
import pytest

import cellcrawl as cc
from tests.runs import NODES, circle_on_track, circling, straight

TURN = 2.0 * np.pi


def test_material_origin_is_the_stored_order():
    run = circling(0.3)
    shown = cc.observables.kymograph(run, "off_rate", origin="material")
    np.testing.assert_array_equal(shown.values, run["off_rate"].values)
    np.testing.assert_allclose(shown["arclength"], np.arange(NODES) / NODES)
    assert shown.dims == ("time", "arclength")
    assert shown.attrs["units"] == run["off_rate"].attrs["units"]


def test_front_origin_puts_the_front_in_the_middle_whatever_the_direction():
    run = circling(0.3)
    shown = cc.observables.kymograph(run, "bound_fraction", origin="front")
    arclength = shown["arclength"].values
    assert arclength[0] == -0.5
    assert arclength[NODES // 2] == 0.0
    expected = 0.5 + 0.2 * np.cos(TURN * arclength)
    np.testing.assert_allclose(shown.values, np.tile(expected, (401, 1)), atol=2e-5)


@pytest.mark.parametrize("nodes", [64, 65])
def test_front_origin_rolls_by_whole_nodes_without_a_change(nodes):
    towards = TURN * 7 / nodes  # the front is at node 7
    run = straight((np.cos(towards), np.sin(towards)), nodes=nodes)
    rng = np.random.default_rng(3)
    run["bound_fraction"][:] = rng.uniform(size=run["bound_fraction"].shape)
    shown = cc.observables.kymograph(run, "bound_fraction")
    rolled = np.roll(run["bound_fraction"].values, nodes // 2 - 7, axis=1)
    np.testing.assert_allclose(shown.values, rolled, atol=1e-9)
    assert shown["arclength"].values[nodes // 2] == 0.0


def test_left_of_the_cell_is_at_positive_arclength():
    run = straight((0.1, 0.0))
    run["bound_fraction"][:] = run["y"].values - run["centroid_y"].values[:, None]
    shown = cc.observables.kymograph(run, "bound_fraction")
    assert (shown.sel(arclength=0.25, method="nearest") > 0.9).all()
    assert (shown.sel(arclength=-0.25, method="nearest") < -0.9).all()


def test_tangent_angle_stays_continuous_and_gains_one_turn():
    shown = cc.observables.kymograph(circling(0.3), "theta")
    np.testing.assert_allclose(np.diff(shown.values, axis=1), TURN / NODES, atol=1e-9)


@pytest.mark.parametrize(
    ("field", "origin", "said"),
    [
        ("bound_fractoin", "front", "did you mean 'bound_fraction'"),
        ("tension", "front", "no field 'tension' on the edge"),
        ("curvature", "frnt", "did you mean 'front'"),
    ],
)
def test_unknown_names_are_refused(field, origin, said):
    with pytest.raises(cc.InputError, match=said):
        cc.observables.kymograph(straight(), field, origin=origin)


def test_a_cell_without_a_front_is_told_of_the_other_origin():
    run = circle_on_track(np.arange(3.0), lambda t: ((0.0, 0.0), (0.0, 0.0)))
    with pytest.raises(cc.InputError, match='origin="material"'):
        cc.observables.kymograph(run, "bound_fraction", origin="front")
    assert cc.observables.kymograph(run, "bound_fraction", origin="material").shape == (3, NODES)
