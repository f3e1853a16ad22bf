"""The microscope: a run, as a camera would have seen it."""

from __future__ import annotations

import dataclasses
import math

import numpy as np
import pytest
import xarray as xr

import cellcrawl as cc


def moving_circle(speed=(0.3, 0.2), turning=0.0, records=41, every=0.25):
    """A circle of radius 1 as a run would hold it."""
    t = every * np.arange(records)
    angle = 2 * math.pi * np.arange(200) / 200
    if turning:
        x, y = np.cos(turning * t) / turning, np.sin(turning * t) / turning
    else:
        x, y = speed[0] * t, speed[1] * t
    fields = {"x": x[:, None] + np.cos(angle), "y": y[:, None] + np.sin(angle)}
    variables = {name: (("time", "node"), value) for name, value in fields.items()}
    return xr.Dataset(variables, {"time": t})


def test_the_image_shows_the_cell_where_it_is():
    seen = cc.observe(moving_circle(), pixel=0.1, frame=0.5)
    assert seen.labels.shape[0] == 21
    np.testing.assert_allclose(seen.labels.sum(axis=(1, 2)) * 0.01, math.pi, rtol=0.04)
    left, top = seen.origin
    track = seen.tracks[0]
    np.testing.assert_allclose(track.t, 0.5 * np.arange(21))
    np.testing.assert_allclose(left + track.x, 0.3 * track.t, atol=0.01)
    np.testing.assert_allclose(top - track.y, 0.2 * track.t, atol=0.01)
    assert track.y_down


def test_a_left_turn_is_a_left_turn_on_the_screen():
    run = moving_circle(turning=0.5, records=81)
    track = cc.observe(run, pixel=0.1, frame=0.5).tracks[0]
    said = cc.classify_track(track.t, track.x, track.y)
    assert said.mode == "rotational"
    assert said.measures.turned < 0.0  # from x towards y, which points down
    assert "turns left" in said.summary(y_down=track.y_down)


def test_the_error_is_that_of_the_position():
    run = moving_circle(speed=(0.0, 0.0), records=401)
    seen = cc.observe(run, pixel=0.05, error=0.2, frame=0.25, seed=4)
    track = seen.tracks[0]
    for values in (track.x, track.y):
        assert values.std() == pytest.approx(0.2, rel=0.12)
    again = cc.observe(run, pixel=0.05, error=0.2, frame=0.25, seed=4)
    np.testing.assert_array_equal(again.labels, seen.labels)
    other = cc.observe(run, pixel=0.05, error=0.2, seed=5).tracks[0]
    assert not np.allclose(other.x - other.x.mean(), track.x - track.x.mean())


def test_the_edge_is_rough_by_its_own_error():
    run = moving_circle(speed=(0.0, 0.0), records=5)
    smooth, rough = (
        cc.observe(run, pixel=0.02, edge_error=error).outlines[0] for error in (0.0, 0.05)
    )
    spread = [np.hypot(*(one.xy - one.centroid).T).std() for one in (smooth, rough)]
    assert spread[0] < 0.01
    assert spread[1] == pytest.approx(0.05, rel=0.2)
    assert rough.area == pytest.approx(math.pi, rel=0.05)


def test_a_run_through_the_microscope_and_a_file_comes_back(tmp_path):
    run = cc.simulate(cc.Parameters(), 2.0, save_every=0.25, nodes=64)
    seen = cc.observe(run, pixel=0.1, error=0.05, frame=0.5)
    file = seen.write(tmp_path / "run.tif")
    back = cc.read_outlines(file)
    assert back.source.length_units == "R_0"
    assert len(back) == len(seen.outlines) == 5
    for one, other in zip(back, seen.outlines, strict=True):
        np.testing.assert_allclose(one.xy, other.xy, atol=1e-9)
        assert one.t == pytest.approx(other.t)
    area = back.dataset["area"].values.ravel()
    np.testing.assert_allclose(area, run["area"].values[::2], rtol=0.03)


@pytest.mark.parametrize("length", ["µm", "\N{GREEK SMALL LETTER MU}m", "um"])
def test_micrometres_are_written_as_imagej_reads_them(tmp_path, length):
    pytest.importorskip("tifffile")
    seen = dataclasses.replace(cc.observe(moving_circle()), length_units=length, time_units="s")
    read = cc.read_outlines(seen.write(tmp_path / "cell.tif"))
    assert read[0].length_units == "µm"


@pytest.mark.parametrize(
    ("options", "says"),
    [
        ({"pixel": 0.0}, "pixel = 0"),
        ({"error": -1.0}, "error"),
        ({"frame": 0.0}, "frame = 0"),
        ({"pixel": 1e-4}, "too many"),
        ({"seed": 1.5}, "seed"),
    ],
)
def test_what_no_microscope_does_is_refused(options, says):
    with pytest.raises(cc.InputError, match=says):
        cc.observe(moving_circle(), **options)
    with pytest.raises(cc.InputError, match="observe needs a run"):
        cc.observe(moving_circle().drop_vars("x"))
