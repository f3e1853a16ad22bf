"""What is written is read back, by the reader of the form itself and by ours."""

from __future__ import annotations

import json
import math
import xml.etree.ElementTree as ElementTree
import zipfile

import numpy as np
import pandas as pd
import pytest

import cellcrawl as cc
from cellcrawl.microscopy import OUTLINE_FORMS, TRACK_FORMS, Outline, Source, Track, Tracks

FRAMES = {"napari array", "trackpy", "btrack", "napari", "cellprofiler", "manual tracking"}
NO_IMAGE = {"table", "celltrackr"}


def some_tracks(y_down=False):
    """Three tracks that begin late, miss frames, and are of different length."""
    rng = np.random.default_rng(3)
    source = Source(length_units="µm", time_units="s", y_down=y_down)
    frames = {"3": np.arange(2, 14), "7": np.array([0, 1, 4, 5, 9]), "12": np.arange(5)}
    tracks = [
        Track(60.0 * frame, *np.cumsum(rng.normal(size=(2, frame.size)), axis=1), id=name)
        for name, frame in frames.items()
    ]
    return Tracks.of(tracks, source)


def some_outlines():
    """An ellipse that moves and a triangle, in whole and half pixels, y downwards."""
    angle = 2 * math.pi * np.arange(40) / 40
    ellipse = np.column_stack([30 + 12 * np.cos(angle), 20 + 7 * np.sin(angle)])
    triangle = np.array([[60.5, 10.5], [80.5, 12.0], [70.0, 40.0]])
    made = [Outline(ellipse + 3 * k, "1", k, float(k), y_down=True) for k in range(3)]
    return [*made, Outline(triangle, "2", 1, 1.0, y_down=True)]


@pytest.mark.parametrize("form", TRACK_FORMS)
@pytest.mark.parametrize("y_down", [False, True])
def test_our_reader_gives_back_what_was_written(form, y_down, tmp_path):
    tracks = some_tracks(y_down)
    file = cc.write_tracks(tmp_path / ("t.npy" if "array" in form else "t"), tracks, form=form)
    back = cc.read_tracks(file)
    assert sorted(back.ids) == sorted(tracks.ids)
    mirrored = back.source.y_down != y_down and form not in NO_IMAGE
    assert back.source.y_down is (form not in NO_IMAGE)
    for track in tracks:
        found = back[track.id]
        np.testing.assert_allclose(found.x, track.x, atol=1e-9)
        np.testing.assert_allclose(found.y, -track.y if mirrored else track.y, atol=1e-9)
        if form in FRAMES:
            first = found.t[0] - back.t.min()
            np.testing.assert_array_equal(found.t - found.t[0], (track.t - track.t[0]) / 60)
            assert first == track.t[0] / 60
        else:
            np.testing.assert_allclose(found.t, track.t)
    if form not in FRAMES | {"celltrackr"}:
        assert (back.source.length_units, back.source.time_units) == ("µm", "s")


def test_frames_need_times_that_are_multiples_of_one_interval(tmp_path):
    track = Track(np.array([0.0, 1.0, 2.3, 4.0]), np.arange(4.0), np.arange(4.0))
    with pytest.raises(cc.InputError, match="no multiples of one frame interval"):
        cc.write_tracks(tmp_path / "t.csv", [track], form="btrack")
    for form in ("table", "trackmate"):
        back = cc.read_tracks(cc.write_tracks(tmp_path / "t", [track], form=form))
        np.testing.assert_array_equal(back[0].t, track.t)
    with pytest.raises(cc.InputError, match="no tracks to write"):
        cc.write_tracks(tmp_path / "t.csv", [])
    with pytest.raises(cc.InputError, match="did you mean 'trackpy'"):
        cc.write_tracks(tmp_path / "t.csv", [track], form="trackpi")


def test_tables_are_those_that_pandas_and_the_programs_read(tmp_path):
    tracks = some_tracks(y_down=True)
    for form, columns in {
        "trackpy": ("particle", "frame", "x", "y"),
        "napari": ("track_id", "t", "x", "y"),
        "cellprofiler": (
            *("TrackObjects_Label_50", "ImageNumber"),
            *("Location_Center_X", "Location_Center_Y"),
        ),
        "manual tracking": ("Track n°", "Slice n°", "X", "Y"),
        "btrack": ("ID", "t", "x", "y"),
        "celltrackr": ("id", "t", "x", "y"),
    }.items():
        file = cc.write_tracks(tmp_path / "t.csv", tracks, form=form)
        table = pd.read_csv(file, sep=" " if form in ("btrack", "celltrackr") else ",")
        first = 60 if form == "celltrackr" else 1
        base = 1 if form in ("cellprofiler", "manual tracking") else 0
        for track in tracks:
            own = table[table[columns[0]] == int(track.id)].sort_values(columns[1])
            np.testing.assert_allclose(own[columns[1]] - base, track.t / 60 * first)
            np.testing.assert_allclose(own[columns[2]], track.x)
            np.testing.assert_allclose(own[columns[3]], track.y)


def test_trackmates_table_has_its_four_lines_above(tmp_path):
    file = cc.write_tracks(tmp_path / "t.csv", some_tracks(), form="trackmate table")
    table = pd.read_csv(file, skiprows=[1, 2, 3])
    assert list(table["TRACK_ID"].unique()) == [3, 7, 12]
    assert file.read_text().splitlines()[3].count("(µm)") == 3


def test_napari_takes_the_array(tmp_path):
    rows = np.load(cc.write_tracks(tmp_path / "t.npy", some_tracks(y_down=True)))
    assert rows.shape == (22, 4)
    order = np.lexsort((rows[:, 1], rows[:, 0]))
    assert np.array_equal(np.unique(rows[order, 0]), [3, 7, 12])


def test_a_geff_graph_is_valid_to_its_own_reader(tmp_path):
    geff = pytest.importorskip("geff.core_io")
    tracks = some_tracks(y_down=True)
    file = cc.write_tracks(tmp_path / "t.geff", tracks)
    graph = geff.read_to_memory(file)
    np.testing.assert_allclose(graph["node_props"]["x"]["values"], tracks.x)
    assert len(graph["edge_ids"]) == tracks.t.size - len(tracks)
    assert {axis.unit for axis in graph["metadata"].axes} == {"micrometer", "second"}


def test_a_run_becomes_a_table_with_its_size(tmp_path):
    run = cc.simulate(cc.Parameters(), 0.4, save_every=0.1, nodes=64)
    table = pd.read_csv(cc.write_tracks(tmp_path / "run.csv", run))
    np.testing.assert_allclose(table["t"], run["time"])
    np.testing.assert_allclose(table["x"], run["centroid_x"], rtol=1e-11)
    np.testing.assert_allclose(table["tension"], run["tension"], rtol=1e-11)
    assert {"area", "length"} <= set(table)
    back = cc.read_tracks(tmp_path / "run.csv")
    np.testing.assert_allclose(back[0].y, run["centroid_y"], rtol=1e-11)


NAMES = {
    "label tiff": "o.tif",
    "cell tracking challenge": "01_RES",
    "cellpose masks": "o_seg.npy",
    "cellpose outlines": "o_cp_outlines.txt",
    "imagej roi": "o.zip",
    "geojson": "o.geojson",
    "celltool": "contours",
    "trackmate": "o.xml",
}


@pytest.mark.parametrize("form", OUTLINE_FORMS)
def test_our_reader_gives_back_the_outlines(form, tmp_path):
    given = some_outlines()[: 3 if form == "trackmate" else 4]  # it has no tracks of one spot
    unlinked = form in ("cellpose outlines", "celltool")
    back = cc.read_outlines(cc.write_outlines(tmp_path / NAMES[form], given, form=form))
    assert len(back) == len(given)
    if not unlinked:
        assert [(one.track, one.frame) for one in back] == [(o.track, o.frame) for o in given]
    exact = form in ("imagej roi", "geojson", "celltool", "trackmate")
    for found, one in zip(back, given, strict=True):
        assert found.y_down
        np.testing.assert_allclose(found.centroid, one.centroid, atol=1e-4 if exact else 0.5)
        assert found.area == pytest.approx(one.area, rel=1e-4 if exact else 0.05)
        if exact:
            np.testing.assert_allclose(found.xy, one.xy, atol=1e-4)


def test_label_images_and_regions_are_read_by_their_own_readers(tmp_path):
    tifffile, roifile = pytest.importorskip("tifffile"), pytest.importorskip("roifile")
    given = some_outlines()
    labels = tifffile.imread(cc.write_outlines(tmp_path / "o.tif", given))
    assert labels.shape[0] == 3
    assert set(np.unique(labels[1])) == {0, 1, 2}
    assert np.count_nonzero(labels[0] == 1) == pytest.approx(given[0].area, rel=0.03)
    regions = roifile.roiread(cc.write_outlines(tmp_path / "o.zip", given))
    assert [region.t_position for region in regions] == [1, 2, 3, 2]
    np.testing.assert_allclose(regions[0].coordinates(), given[0].xy, atol=1e-4)
    assert len(zipfile.ZipFile(tmp_path / "o.zip").namelist()) == 4
    masks = np.load(cc.write_outlines(tmp_path / "o_seg.npy", given), allow_pickle=True)
    assert masks.item()["masks"].shape == labels.shape


def test_geojson_and_trackmate_are_what_their_standards_say(tmp_path):
    given = some_outlines()
    content = json.loads(cc.write_outlines(tmp_path / "o.geojson", given).read_text())
    ring = content["features"][0]["geometry"]["coordinates"][0]
    assert ring[0] == ring[-1]
    assert len(ring) == 41
    root = ElementTree.parse(cc.write_outlines(tmp_path / "o.xml", given)).getroot()
    spot = root.find("./Model/AllSpots/SpotsInFrame/Spot")
    assert int(spot.get("ROI_N_POINTS")) == len(spot.text.split()) // 2 == 40
    around = np.array(spot.text.split(), float).reshape(-1, 2)
    at = [float(spot.get("POSITION_X")), float(spot.get("POSITION_Y"))]
    np.testing.assert_allclose(around + at, given[0].xy, atol=1e-9)


def test_outlines_of_negative_pixels_or_no_form_are_refused(tmp_path):
    given = some_outlines()
    with pytest.raises(cc.InputError, match="shift them to positive"):
        cc.write_outlines(tmp_path / "o.tif", [Outline(given[0].xy - 50, y_down=True)])
    with pytest.raises(cc.InputError, match="give a smaller pixel"):
        cc.write_outlines(tmp_path / "o.tif", given, pixel=100.0)
    with pytest.raises(cc.InputError, match="tells no form"):
        cc.write_outlines(tmp_path / "o.xyz", given)
    with pytest.raises(cc.InputError, match="no outlines to write"):
        cc.write_outlines(tmp_path / "o.tif", [])
    with pytest.raises(cc.InputError, match=r"ends in \.zip"):
        cc.write_outlines(tmp_path / "o.roi", given)
    one = cc.read_outlines(cc.write_outlines(tmp_path / "o.roi", given[:1]))
    np.testing.assert_allclose(one[0].xy, given[0].xy, atol=1e-4)
