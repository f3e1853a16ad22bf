"""Outlines measured as an edge: rasterised circles and ellipses have what they were drawn with."""

from __future__ import annotations

import math

import numpy as np
import pytest

import cellcrawl as cc
from tests.runs import circling

edges = cc.observables.edge_series


def pixels_of(size: float, aspect: float, angle: float, centre: tuple[float, float]) -> np.ndarray:
    """The way round the pixels whose middles lie within an ellipse, along their sides."""
    a, b = 0.5 * size * math.sqrt(aspect), 0.5 * size / math.sqrt(aspect)
    wide = int(2.0 * a) + 8
    y, x = np.mgrid[:wide, :wide] - 0.5 * wide
    x, y = x - centre[0], y - centre[1]
    c, s = math.cos(angle), math.sin(angle)
    inside = ((c * x + s * y) / a) ** 2 + ((c * y - s * x) / b) ** 2 <= 1.0
    after = {}
    for row, column in np.argwhere(inside).tolist():
        corners = [(column, row), (column + 1, row), (column + 1, row + 1), (column, row + 1)]
        beside = [(row - 1, column), (row, column + 1), (row + 1, column), (row, column - 1)]
        for k in range(4):
            if not inside[beside[k]]:
                after[corners[k]] = corners[(k + 1) % 4]
    way = [next(iter(after))]
    while after[way[-1]] != way[0]:
        way.append(after[way[-1]])
    return np.array(way) - 0.5 - 0.5 * wide - np.array(centre)


def true_length(a: float, b: float) -> float:
    t = np.linspace(0.0, 2.0 * np.pi, 20001)
    return float(np.sum(np.hypot(np.diff(a * np.cos(t)), np.diff(b * np.sin(t)))))


@pytest.mark.parametrize(
    ("size", "area", "length", "bend"),
    [(20, 2e-2, 2e-2, 0.15), (40, 1e-2, 1e-2, 0.1), (80, 3e-3, 5e-3, 0.06)],
)
@pytest.mark.parametrize("aspect", [1.0, 1.5, 2.0])
def test_rasterised_shapes_have_their_area_length_and_curvature(size, area, length, bend, aspect):
    random = np.random.default_rng(size)
    a, b = 0.5 * size * math.sqrt(aspect), 0.5 * size / math.sqrt(aspect)
    missed = []
    for _ in range(6):
        angle = random.uniform(0.0, math.pi)
        found = edges([pixels_of(size, aspect, angle, tuple(random.uniform(0.0, 1.0, 2)))])
        z = (found["x"][0].values + 1j * found["y"][0].values) * np.exp(-1j * angle)
        t = np.arctan2(z.imag / b, z.real / a)
        right = a * b / ((a * np.sin(t)) ** 2 + (b * np.cos(t)) ** 2) ** 1.5
        off = found["curvature"][0].values - right
        missed.append(
            (
                float(found["area"][0]) / (math.pi * a * b) - 1.0,
                float(found["length"][0]) / true_length(a, b) - 1.0,
                math.sqrt(np.mean(off**2)) / right.mean(),
            )
        )
        assert float(cc.observables.aspect_ratio(found)[0]) == pytest.approx(aspect, rel=0.06)
        assert float(cc.observables.circularity(found)[0]) <= 1.0 + 1e-9
    worst = np.abs(missed).max(axis=0)
    assert np.abs(missed).mean(axis=0)[0] < 0.5 * area  # the pixels' own area scatters
    assert worst[0] < area
    assert worst[1] < length
    assert worst[2] < bend


def test_a_smooth_outline_left_alone_is_kept_and_its_curvature_exact():
    t = np.linspace(0.0, 2.0 * np.pi, 400, endpoint=False)
    found = edges([np.column_stack([3.0 * np.cos(t), 3.0 * np.sin(t)])], tolerance=0.0)
    np.testing.assert_allclose(found["curvature"], 1.0 / 3.0, rtol=2e-2)
    assert float(found["smoothing_length"][0]) == 0.0


def test_a_cell_that_moves_keeps_its_origin_and_its_velocity_is_that_along_the_normal():
    t = np.linspace(0.0, 2.0 * np.pi, 300, endpoint=False)
    oval = np.column_stack([2.0 * np.cos(t), np.sin(t)])
    shifted = [np.roll(oval, 37 * k, axis=0) + k * np.array([0.3, 0.1]) for k in range(5)]
    found = edges(shifted, 2.0 * np.arange(5))
    for axis, moved in (("x", 0.3), ("y", 0.1)):
        np.testing.assert_allclose(found[axis].diff("time"), moved, atol=0.02)
    normal = found["theta"].values - 0.5 * np.pi
    along = 0.15 * np.cos(normal) + 0.05 * np.sin(normal)
    np.testing.assert_allclose(found["normal_velocity"], along, atol=0.01)
    assert float(cc.observables.speed(found)[2]) == pytest.approx(math.hypot(0.15, 0.05), rel=1e-3)
    growing = edges([oval * (1.0 + 0.01 * k) for k in range(4)])
    assert (growing["normal_velocity"] > 0.0).all()


def test_observables_of_a_run_are_those_of_its_outlines():
    run = circling(0.4, radius=3.0)
    outlines = [
        np.column_stack(pair) for pair in zip(run["x"].values, run["y"].values, strict=True)
    ]
    seen = edges(outlines, run["time"].values, tolerance=0.0, nodes=run.sizes["node"])
    for name in ("circularity", "aspect_ratio", "speed", "heading"):
        measure = getattr(cc.observables, name)
        np.testing.assert_allclose(measure(seen)[2:-2], measure(run)[2:-2], rtol=2e-2, atol=2e-2)
    assert cc.observables.kymograph(seen, "curvature").dims == ("time", "arclength")
    assert np.isfinite(cc.observables.front_rear_asymmetry(seen, "curvature")).all()


def test_outlines_keep_the_units_of_their_file_in_every_observable(tmp_path):
    run = circling(0.4, radius=3.0)
    file = cc.observe(run, pixel=0.2).write(tmp_path / "run.tif")
    given = cc.read_outlines(file, pixel_size="0.65 um", frame_interval="30 s")
    seen = edges(given)
    for name in ("circularity", "aspect_ratio", "speed", "heading", "turning_rate"):
        assert np.isfinite(getattr(cc.observables, name)(seen)).all()
    assert seen["area"].attrs["units"] == "µm^2"
    assert cc.observables.speed(seen).attrs["units"] == "µm/s"
    assert np.isfinite(cc.observables.kymograph(seen, "curvature", origin="material")).all()
    assert np.isfinite(cc.observables.front_rear_asymmetry(seen, "curvature")).all()


def test_mistakes_are_one_line():
    square = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])
    for call, said in (
        (lambda: edges([]), "no outlines"),
        (lambda: edges([square, square], [1.0, 1.0]), "t must rise"),
        (lambda: edges([square[:2]]), "outline 0 encloses no area"),
        (lambda: edges("cells"), "sequence of arrays"),
    ):
        with pytest.raises(cc.InputError, match=said):
            call()
