"""Outlines from a microscope, with retraction fibres and faults, start runs all the same."""

from __future__ import annotations

import math

import numpy as np
import pytest

import cellcrawl as cc
from cellcrawl.errors import OutlineChangedWarning
from cellcrawl.microscopy.label_images import pieces


def cell(width=0.0, length=0.0, angle=0.0):
    """The outline in pixels of an ellipse of axes 30 and 45 with a straight fibre."""
    rows, columns = np.mgrid[:200, :260]
    right, down = columns - 80, rows - 100
    inside = (right / 30) ** 2 + (down / 45) ** 2 < 1
    along = right * math.cos(angle) + down * math.sin(angle)
    across = np.abs(down * math.cos(angle) - right * math.sin(angle))
    inside |= (along > 0) & (along < length + 35) & (across < width / 2 + 1e-9) & (width > 0)
    return next(pieces(inside.astype(np.uint8))).xy


@pytest.mark.parametrize("smoothing", [0.003, 0.01, 0.03])
@pytest.mark.parametrize(("width", "length", "angle"), [(1, 60, 0.0), (1.5, 60, 0.5), (3, 80, 1.0)])
def test_a_fibre_is_taken_off_and_told(width, length, angle, smoothing):
    bare = cc.FromOutline(cell(), radius=1.0)
    assert bare.changes == ()
    with pytest.warns(OutlineChangedWarning, match="thin fibres: opened with a disk"):
        start = cc.FromOutline(cell(width, length, angle), radius=1.0, smoothing=smoothing)
    assert len(start.changes) == 1
    with_fibre, without = (s.state(cc.Parameters(), 256).curve for s in (start, bare))
    assert with_fibre.length == pytest.approx(without.length, rel=0.03)
    np.testing.assert_allclose(with_fibre.centroid, without.centroid, atol=1.0)
    run = cc.simulate(cc.Parameters(), 0.5, save_every=0.25, start=start)
    assert run.attrs["status"] == "completed"


def test_a_fibre_without_width_walked_there_and_back_is_taken_off():
    xy = cell()
    tip = int(np.argmax(xy[:, 0]))
    way = xy[tip] + np.column_stack([np.arange(1, 61), np.zeros(60)])
    spiked = np.concatenate([xy[: tip + 1], way, way[-2::-1], xy[tip:]])
    with pytest.warns(OutlineChangedWarning, match="crosses or touches itself: opened"):
        start = cc.FromOutline(spiked, radius=1.0)
    curve = start.state(cc.Parameters(), 256).curve
    bare = cc.FromOutline(xy, radius=1.0).state(cc.Parameters(), 256).curve
    assert curve.length == pytest.approx(bare.length, rel=0.02)


def test_a_spike_of_a_few_pixels_is_taken_off_or_smoothed_away():
    with pytest.warns(OutlineChangedWarning, match="thin fibres"):
        start = cc.FromOutline(cell(1, 0), radius=1.0)
    for one in (start, cc.FromOutline(cell(1, 0), radius=1.0, smoothing=0.03)):
        run = cc.simulate(cc.Parameters(), 0.5, save_every=0.25, start=one)
        assert run.attrs["status"] == "completed"


def test_a_broad_tail_and_sharp_corners_stay_as_they_are():
    for xy in (cell(12, 60), cell(), np.array([[0, 0], [1, 0], [1, 1], [0, 1.0]])):
        assert cc.FromOutline(xy, radius=1.0).changes == ()
    thin = np.column_stack([10 * np.cos(t := np.linspace(0, 2 * np.pi, 400)[:-1]), np.sin(t)])
    assert cc.FromOutline(thin).changes == ()


def test_a_figure_of_eight_is_still_refused():
    t = 2 * math.pi * np.arange(300) / 300
    eight = np.column_stack([np.sin(t), np.sin(2 * t)])
    with pytest.raises(cc.InputError, match="crosses or touches itself"):
        cc.FromOutline(eight)


def test_an_outline_that_was_read_is_a_start_as_it_is(tmp_path):
    file = tmp_path / "a.geojson"
    cc.write_outlines(file, [cc.microscopy.Outline(cell(), y_down=True)])
    outline = cc.read_outlines(file)[0]
    start = cc.FromOutline(outline, radius=1.0)
    np.testing.assert_array_equal(start.xy, outline.xy)
    run = cc.simulate(cc.Parameters(), 0.1, save_every=0.1, start=start)
    assert float(run["area"][0]) == pytest.approx(math.pi, rel=1e-6)
