"""Measures of shape against shapes with known values."""

from __future__ import annotations

import numpy as np
import pytest

import cellcrawl as cc
from cellcrawl.curve import from_path
from tests.runs import straight


def ellipse(ratio: float, angle: float):
    """A run whose cell is an ellipse with half axes ``ratio`` and 1."""
    around = 2.0 * np.pi * np.arange(512) / 512
    path = np.exp(1j * angle) * (ratio * np.cos(around) + 1j * np.sin(around))
    curve, _ = from_path(path, 256)
    run = straight(nodes=256)
    x, y = curve.points.T
    edge = {"x": x, "y": y, "theta": curve.theta}
    return run.assign(
        {name: run[name] * 0.0 + values for name, values in edge.items()}
        | {name: run[name] * 0.0 for name in ("centroid_x", "centroid_y")}
        | {"length": run["length"] * 0.0 + curve.length}
    )


def test_circularity_of_a_circle_is_one():
    measured = cc.observables.circularity(straight())
    np.testing.assert_allclose(measured, 1.0, rtol=1e-12)
    assert measured.dims == ("time",)
    assert measured.attrs["units"] == "1"


def test_circularity_of_a_square_is_a_quarter_of_pi():
    run = straight().copy(deep=True)
    run["area"][:], run["length"][:] = 9.0, 12.0
    np.testing.assert_allclose(cc.observables.circularity(run), 0.25 * np.pi, rtol=1e-12)


@pytest.mark.parametrize("ratio", [1.0, 1.5, 3.0])
@pytest.mark.parametrize("angle", [0.0, 0.4, 2.0])
def test_ellipse_has_the_ratio_of_its_axes(ratio, angle):
    run = ellipse(ratio, angle)
    np.testing.assert_allclose(cc.observables.aspect_ratio(run), ratio, rtol=1e-6)


def test_aspect_ratio_does_not_depend_on_size_or_place():
    run = ellipse(2.0, 0.3)
    moved = run.assign(
        {name: 5.0 * run[name] + 100.0 for name in ("x", "y", "centroid_x", "centroid_y")}
    ).assign(length=5.0 * run["length"], area=25.0 * run["area"])
    np.testing.assert_allclose(cc.observables.aspect_ratio(moved), 2.0, rtol=1e-6)
