"""Outlines of label images."""

from __future__ import annotations

import math

import numpy as np
import pytest

import cellcrawl as cc
from cellcrawl.curve import simple_polygon
from cellcrawl.microscopy.label_images import pieces
from cellcrawl.microscopy.polygons import area_of, centroid_of
from cellcrawl.microscopy.raster import opened, rasterised


def disk(radius, size=60, at=(29.3, 30.6)):
    rows, columns = np.mgrid[:size, :size]
    return (np.hypot(columns - at[0], rows - at[1]) < radius).astype(np.uint8)


@pytest.mark.parametrize("radius", [4.0, 10.2, 20.0, 27.5])
def test_an_outline_encloses_half_a_pixel_less_than_was_counted(radius):
    (piece,) = pieces(disk(radius))
    assert area_of(piece.xy) == pytest.approx(piece.pixels - 0.5)
    np.testing.assert_allclose(centroid_of(piece.xy), (29.3, 30.6), atol=0.2)
    assert area_of(piece.xy) == pytest.approx(math.pi * radius**2, rel=0.05)


def test_outlines_of_any_pixels_are_simple_polygons():
    rng = np.random.default_rng(0)
    for _ in range(60):
        image = (rng.random((12, 12)) < 0.6).astype(np.uint8)
        for piece in pieces(image):
            assert area_of(piece.xy) == pytest.approx(piece.pixels - 0.5)
            simple_polygon(piece.xy)


def test_the_largest_piece_counts_and_what_was_done_is_told():
    image = 3 * disk(15).astype(int)
    image[28:32, 28:32] = 0
    image[0:3, 50:53] = 3
    image[40:50, 55:] = 8
    three, eight = pieces(image)
    assert (three.label, eight.label) == (3, 8)
    assert "largest of 2 pieces" in three.changes[0]
    assert "holes filled" in three.changes
    assert "cut by the edge of the image" in eight.changes
    assert eight.pixels == 50


def test_pixels_that_touch_at_a_corner_are_two_pieces():
    (piece,) = pieces(np.eye(5, dtype=np.uint8))
    assert piece.pixels == 1
    assert "largest of 5 pieces" in piece.changes[0]


def write_stack(file, frames, **told):
    tifffile = pytest.importorskip("tifffile")
    tifffile.imwrite(file, np.asarray(frames), photometric="minisblack", **told)
    return file


def test_a_label_stack_is_tracks_over_frames(tmp_path):
    frames = [disk(8, at=(20 + 2 * k, 30)) + 5 * disk(6, at=(20 + k, 50)) for k in range(6)]
    file = write_stack(tmp_path / "a.tif", np.array(frames, np.uint16))
    outlines = cc.read_outlines(file)
    assert outlines.track_ids == ("1", "5")
    assert [one.frame for one in outlines.of_track("5")] == [0, 1, 2, 3, 4, 5]
    tracks = cc.read_tracks(file, pixel_size="0.5 µm", frame_interval="20 s")
    np.testing.assert_allclose(tracks["1"].x, 10 + np.arange(6), atol=0.05)
    np.testing.assert_array_equal(tracks["1"].t, 20 * np.arange(6))
    assert (tracks.source.length_units, tracks.source.time_units) == ("µm", "s")


def test_the_dataset_is_by_track_frame_and_node(tmp_path):
    frames = [disk(8, at=(20 + 2 * k, 30)) + 5 * disk(6, at=(20, 50)) * (k > 1) for k in range(4)]
    file = write_stack(tmp_path / "a.tif", np.array(frames, np.uint16))
    dataset = cc.read_outlines(file, pixel_size=2.0).dataset
    assert dict(dataset.sizes) == {"track": 2, "frame": 4, "node": 128}
    one = dataset.sel(track="1", frame=2)
    assert float(one["centroid_x"]) == pytest.approx(48, abs=0.2)
    steps = np.hypot(np.diff(one["x"]), np.diff(one["y"]))
    assert steps.std() < 0.1 * steps.mean()
    assert area_of(np.column_stack([one["x"], one["y"]])) == pytest.approx(
        float(one["area"]), rel=0.01
    )
    assert np.isnan(dataset["x"].sel(track="5", frame=0)).all()
    assert dataset.attrs["y_down"] == 1


def test_cells_numbered_anew_in_every_frame_are_not_linked(tmp_path):
    rng = np.random.default_rng(2)
    frames = []
    for _ in range(5):
        image = np.zeros((90, 90), np.uint16)
        places = rng.permutation([(15, 15), (15, 75), (75, 15), (75, 75), (45, 45)])
        for number, (i, j) in enumerate(places, start=1):
            image[i - 4 : i + 4, j - 4 : j + 4] = number
        frames.append(image)
    outlines = cc.read_outlines(write_stack(tmp_path / "a.tif", frames))
    assert len(outlines) == len(outlines.track_ids) == 25
    assert "start anew in every frame" in outlines.summary()
    with pytest.raises(cc.InputError, match="no track of two records"):
        _ = outlines.tracks


def test_pixel_size_and_interval_come_from_the_file(tmp_path):
    frames = np.array([disk(8, at=(20 + k, 30)) for k in range(3)])
    file = write_stack(
        tmp_path / "a.tif",
        frames,
        imagej=True,
        resolution=(4.0, 4.0),
        metadata={"axes": "TYX", "unit": "um", "finterval": 90.0},
    )
    source = cc.read_outlines(file).source
    assert (source.length_units, source.time_units) == ("µm", "s")
    assert "pixel size 0.25 µm from the file" in source.notes
    np.testing.assert_array_equal(cc.read_tracks(file)[0].t, [0, 90, 180])
    assert cc.read_outlines(file, pixel_size=1.0)[0].area == pytest.approx(
        16 * cc.read_outlines(file)[0].area
    )


def test_a_picture_is_no_label_image(tmp_path):
    rng = np.random.default_rng(0)
    file = write_stack(tmp_path / "a.tif", rng.normal(size=(50, 60)).astype(np.float32))
    with pytest.raises(cc.InputError, match="is a picture, not a label image"):
        cc.read_outlines(file)
    with pytest.raises(cc.InputError, match="all its pixels are 0"):
        cc.read_outlines(write_stack(tmp_path / "b.tif", np.zeros((5, 5), np.uint8)))
    (tmp_path / "c.tif").write_bytes(b"II*\x00\x00\x00")
    with pytest.raises(cc.InputError, match=r"c\.tif cannot be read"):
        cc.read_outlines(tmp_path / "c.tif")


def test_daughters_of_the_cell_tracking_challenge_know_their_mother(tmp_path):
    tifffile = pytest.importorskip("tifffile")
    for frame in range(4):
        image = np.zeros((40, 60), np.uint16)
        if frame < 2:
            image[15:25, 20 + frame : 30 + frame] = 1
        else:
            image[5:12, 20:28], image[25:33, 20:28] = 2, 3
        tifffile.imwrite(tmp_path / f"man_track{frame:03d}.tif", image)
    (tmp_path / "man_track.txt").write_text("1 0 1 0\n2 2 3 1\n3 2 3 1\n")
    tracks = cc.read_tracks(tmp_path)
    assert tracks.ids == ("1", "2", "3")
    assert tracks["2"].parent == tracks["3"].parent == "1"
    np.testing.assert_array_equal(tracks["2"].t, [2, 3])
    assert len(cc.read_outlines(tmp_path)) == 6


def test_a_polygon_drawn_on_a_grid_has_its_area():
    angle = 2 * math.pi * np.arange(400) / 400
    circle = np.column_stack([50.2 + 40 * np.cos(angle), 49.7 + 40 * np.sin(angle)])
    assert rasterised(circle, (100, 100)).sum() == pytest.approx(math.pi * 1600, rel=2e-3)
    assert rasterised(circle[::-1], (100, 100)).sum() == rasterised(circle, (100, 100)).sum()
    there_and_back = np.array([[10, 10.5], [50, 10.5], [10, 10.5]])
    assert not rasterised(there_and_back, (100, 100)).any()
    assert rasterised(np.array([[-5, -5], [200, -5], [200, 200], [-5, 200]]), (9, 7)).all()


def test_an_opening_takes_off_what_is_thinner_than_the_disk():
    image = disk(12, 80).astype(bool)
    fibre = np.zeros_like(image)
    fibre[29:32, 35:75] = True
    after = opened(image | fibre, 4.0)
    assert not after[:, 46:].any()
    assert after.sum() == pytest.approx(image.sum(), rel=0.06)
    np.testing.assert_array_equal(opened(after, 4.0), after)
