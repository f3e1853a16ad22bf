"""Outlines and graphs as other programs write them, with the faults they come with."""

from __future__ import annotations

import json
import math
import os
import pickle

import numpy as np
import pytest

import cellcrawl as cc
from cellcrawl.microscopy import Outline

SPOT = (
    '<Spot ID="{i}" name="s" POSITION_X="{x}" POSITION_Y="{y}" POSITION_Z="0" POSITION_T="{t}" '
    'FRAME="{f}"{roi}>{text}</Spot>'
)


def model(spots, tracks, kept=None, units='spatialunits="micron" timeunits="min"'):
    """A TrackMate file: spots as (id, frame, x, y), tracks as {name: [(source, target)]}."""
    body = "".join(
        SPOT.format(
            i=i,
            f=f,
            t=2.0 * f,
            x=x,
            y=y,
            roi=' ROI_N_POINTS="4"',
            text="-1 -1 1 -1 1 2 -1 2",
        )
        for i, f, x, y in spots
    )
    links = "".join(
        f'<Track name="T" TRACK_ID="{name}">'
        + "".join(f'<Edge SPOT_SOURCE_ID="{a}" SPOT_TARGET_ID="{b}"/>' for a, b in edges)
        + "</Track>"
        for name, edges in tracks.items()
    )
    chosen = "".join(f'<TrackID TRACK_ID="{name}"/>' for name in (kept or []))
    filtered = f"<FilteredTracks>{chosen}</FilteredTracks>" if kept is not None else ""
    return (
        f'<?xml version="1.0"?><TrackMate version="7"><Model {units}><AllSpots>'
        f'<SpotsInFrame frame="0">{body}</SpotsInFrame></AllSpots>'
        f"<AllTracks>{links}</AllTracks>{filtered}</Model></TrackMate>"
    )


SPOTS = [(10 * c + f, f, 5.0 * c + f, 2.0 * f) for c in range(5) for f in range(4)]
CHAIN = {str(c): [(10 * c + f, 10 * c + f + 1) for f in range(3)] for c in range(5)}


def test_trackmates_model_gives_filtered_tracks_by_their_id(tmp_path):
    file = tmp_path / "a.xml"
    file.write_text(model(SPOTS, CHAIN, kept=["1", "3"]))
    tracks = cc.read_tracks(file)
    assert tracks.ids == ("1", "3")
    np.testing.assert_array_equal(tracks["3"].t, [0, 2, 4, 6])
    np.testing.assert_array_equal(tracks["3"].x, [15, 16, 17, 18])
    assert (tracks.source.length_units, tracks.source.time_units) == ("µm", "min")
    assert "3 tracks filtered out" in tracks.summary()
    assert len(cc.read_tracks(file, frame_interval=30)["1"]) == 4


def test_edges_may_point_back_in_time_and_come_in_any_order(tmp_path):
    file = tmp_path / "a.xml"
    file.write_text(model(SPOTS, {"0": [(2, 1), (3, 2), (0, 1)]}, kept=["0"]))
    np.testing.assert_array_equal(cc.read_tracks(file)["0"].x, [0, 1, 2, 3])


def test_tracks_of_trackmate_that_split_or_merge_are_set_aside(tmp_path):
    split = {**CHAIN, "0": [(0, 1), (1, 2), (1, 12)], "1": [(10, 11)]}
    file = tmp_path / "a.xml"
    file.write_text(model(SPOTS, split, kept=list(split)))
    tracks = cc.read_tracks(file)
    assert tracks.ids == ("1", "2", "3", "4")
    reasons = {one.what: one.reason for one in tracks.left_out}
    assert "splits or merges" in reasons["0"]
    outlines = cc.read_outlines(file)
    assert "0" not in outlines.track_ids
    assert any(one.what == "0" for one in outlines.left_out)


def test_trackmates_outlines_stand_around_their_spots(tmp_path):
    file = tmp_path / "a.xml"
    file.write_text(model(SPOTS, CHAIN, kept=["2"]))
    outlines = cc.read_outlines(file)
    assert [one.frame for one in outlines] == [0, 1, 2, 3]
    np.testing.assert_array_equal(outlines[1].xy, [[10, 1], [12, 1], [12, 4], [10, 4]])
    assert outlines[1].t == 2.0
    assert outlines.source.length_units == "µm"


def test_a_broken_or_foreign_xml_is_one_line(tmp_path):
    file = tmp_path / "a.xml"
    for text, says in (
        (model(SPOTS, CHAIN)[:-40], "XML breaks off"),
        (model(SPOTS, {}), "no tracks, only spots"),
        (model([], CHAIN), "no spots"),
        ("<svg></svg>", "XML that is not known"),
        (model(SPOTS, {"0": [(0, 99)]}), "links spots that are not in the file"),
    ):
        file.write_text(text)
        with pytest.raises(cc.InputError, match=says):
            cc.read_tracks(file)


def test_trackmates_simple_file_gives_times_by_its_interval(tmp_path):
    file = tmp_path / "a.xml"
    particle = "<particle nSpots='2'>{}</particle>"
    detection = "<detection t='{}' x='{}' y='1' z='0'/>"
    tracks = "".join(
        particle.format("".join(detection.format(t, 10 * c + t) for t in (4, 5))) for c in (1, 2)
    )
    head = "<Tracks nTracks='2' spaceUnits='micron' frameInterval='0.5' timeUnits='h'>"
    file.write_text(f"<?xml version='1.0'?>{head}{tracks}</Tracks>")
    found = cc.read_tracks(file)
    assert found.ids == ("0", "1")
    np.testing.assert_array_equal(found[1].t, [2.0, 2.5])
    np.testing.assert_array_equal(found[1].x, [24, 25])
    assert found.source.time_units == "h"


def test_a_graph_is_cut_into_tracklets_where_it_divides(tmp_path):
    core, spec = pytest.importorskip("geff.core_io"), pytest.importorskip("geff_spec")
    nodes = np.arange(9, dtype=np.uint64)
    t = np.array([0, 1, 2, 3, 4, 3, 4, 0, 1.0])
    edges = [(0, 1), (1, 2), (2, 3), (3, 4), (2, 5), (5, 6), (7, 8)]
    values = {"t": t, "y": 2 * t, "x": 10.0 + t}
    axes = [
        spec.Axis(name=name, type="time" if name == "t" else "space", unit=unit)
        for name, unit in (("t", "minute"), ("y", "micrometer"), ("x", "micrometer"))
    ]
    metadata = spec.GeffMetadata(
        directed=True, axes=axes, node_props_metadata={}, edge_props_metadata={}
    )
    properties = {name: {"values": value, "missing": None} for name, value in values.items()}
    core.write_arrays(
        tmp_path / "g.zarr", nodes, properties, np.array(edges, np.uint64), {}, metadata
    )
    tracks = cc.read_tracks(tmp_path / "g.zarr")
    assert {track.id: len(track) for track in tracks} == {"0": 3, "3": 2, "5": 2, "7": 2}
    assert tracks["3"].parent == tracks["5"].parent == "0"
    assert tracks.source.time_units == "min"


class Harmful:
    """What runs a command when it is unpickled."""

    def __reduce__(self):
        return os.mkdir, (os.environ["MARK"],)


def test_a_pickle_that_would_run_code_is_refused_and_not_run(tmp_path, monkeypatch):
    mark = tmp_path / "mark"
    monkeypatch.setenv("MARK", str(mark))
    file = tmp_path / "a_seg.npy"
    np.save(file, np.array({"masks": Harmful()}, dtype=object), allow_pickle=True)
    with pytest.raises(cc.InputError, match="only plain arrays are let in"):
        cc.read_outlines(file)
    assert not mark.exists()
    np.load(file, allow_pickle=True)  # the same file, read without care
    assert mark.is_dir()


def test_cellposes_dictionary_is_read_as_newer_and_older_numpy_write_it(tmp_path):
    masks = np.zeros((30, 40), np.uint16)
    masks[5:15, 10:30] = 4
    content = {"masks": masks, "est_diam": np.float64(20.0), "filename": "a.tif", "flows": [masks]}
    file = tmp_path / "a_seg.npy"
    np.save(file, np.array(content, dtype=object), allow_pickle=True)
    new = cc.read_outlines(file)
    assert new[0].area == 199.5
    old = pickle.dumps(np.array(content, dtype=object), 2)
    head = file.read_bytes()[: file.read_bytes().index(b"\n") + 1]
    file.write_bytes(head + old.replace(b"numpy._core", b"numpy.core"))
    assert cc.read_outlines(file)[0].track == "4"


def test_celltool_contours_are_text_and_never_run(tmp_path):
    file = tmp_path / "cell.contour"
    mark = tmp_path / "mark"
    file.write_text(
        'cls = ("celltool.contour.contour_class", "Contour")\n'
        f"evil = open({str(mark)!r}, 'w')\n"
        "units = \\\n''\n\npoints = \\\narray([[ 0.,  1e1],\n [ 5.5, 0],\n [-3, 2.]])\n"
        "landmarks = \\\narray([[7., 7.]])\n"
    )
    outline = cc.read_outlines(file)[0]
    np.testing.assert_array_equal(outline.xy, [[0, 10], [5.5, 0], [-3, 2]])
    assert outline.track == "cell"
    assert not mark.exists()


def test_geojson_gives_the_outer_ring_of_the_largest_piece(tmp_path):
    square = [[0, 0], [4, 0], [4, 4], [0, 4], [0, 0]]
    bit = [[9, 9], [10, 9], [10, 10], [9, 9]]
    hole = [[1, 1], [2, 1], [2, 2], [1, 1]]
    features = [
        {"geometry": {"type": "MultiPolygon", "coordinates": [[bit], [square, hole]]}},
        {"geometry": {"type": "Point", "coordinates": [1, 2]}, "properties": {"name": "p"}},
        {"geometry": {"type": "Polygon", "coordinates": []}},
        {
            "geometry": {"type": "Polygon", "coordinates": [bit], "plane": {"t": 3}},
            "properties": {"name": "tip"},
        },
    ]
    file = tmp_path / "a.geojson"
    file.write_text(json.dumps({"type": "FeatureCollection", "features": features}))
    outlines = cc.read_outlines(file)
    assert [(one.track, one.frame, len(one.xy)) for one in outlines] == [("1", 0, 4), ("tip", 3, 3)]
    assert outlines[0].changes == ("largest of 2 pieces", "holes filled")
    assert {one.what for one in outlines.left_out} == {"p", "3"}


def test_lines_and_points_of_imagej_enclose_nothing(tmp_path):
    roifile = pytest.importorskip("roifile")
    cell = roifile.ImagejRoi.frompoints(np.array([[1, 1], [9, 1], [5, 8]], float), name="cell")
    line = roifile.ImagejRoi.frompoints(np.array([[1, 1], [9, 1], [5, 8]], float), name="path")
    line.roitype = roifile.ROI_TYPE.POLYLINE
    file = tmp_path / "a.zip"
    roifile.roiwrite(file, [cell, line], name=["cell.roi", "path.roi"])
    outlines = cc.read_outlines(file)
    assert outlines.track_ids == ("cell",)
    assert "polyline encloses nothing" in outlines.left_out[0].reason


def test_a_bad_line_of_cellpose_stops_no_other(tmp_path):
    file = tmp_path / "a_cp_outlines.txt"
    angle = 2 * math.pi * np.arange(30) / 30
    cells = [
        ",".join(
            f"{v:.0f}"
            for v in np.column_stack([50 + r * np.cos(angle), 50 + r * np.sin(angle)]).ravel()
        )
        for r in (20, 30)
    ]
    file.write_text(f"{cells[0]}\n1,2,3\n\n{cells[1]}\n5,5,5,5\n")
    outlines = cc.read_outlines(file)
    assert outlines.track_ids == ("1", "4")
    assert [one.what for one in outlines.left_out] == ["line 2", "5 in frame 0"]


def test_a_folder_is_read_by_frames_and_a_bad_file_is_listed(tmp_path):
    ring = np.array([[10, 10], [30, 10], [30, 40], [10, 40]], float)
    for frame in range(3):
        one = Outline(ring + frame, "1", 0, 0.0, y_down=True)
        cc.write_outlines(tmp_path / f"f{frame}.geojson", [one])
    (tmp_path / "f1.geojson").write_text('{"type": "FeatureCollection", "features": [')
    outlines = cc.read_outlines(tmp_path)
    assert len(outlines) == 2
    assert len(outlines.track_ids) == 2  # cells of different files are not linked by their number
    assert outlines.left_out[0].what == "f1.geojson"


def test_positions_are_no_outlines(tmp_path):
    file = tmp_path / "a.csv"
    file.write_text("track,t,x,y\n1,0,1,1\n1,1,2,2\n")
    with pytest.raises(cc.InputError, match="holds positions, not outlines"):
        cc.read_outlines(file)
    with pytest.raises(cc.InputError, match="no file of outlines"):
        cc.read_outlines(tmp_path)


def test_a_missing_reader_is_named_with_its_extra(tmp_path, monkeypatch):
    import sys

    file = tmp_path / "a.tif"
    file.write_bytes(b"II*\x00" + bytes(100))
    monkeypatch.setitem(sys.modules, "tifffile", None)
    with pytest.raises(cc.errors.MissingExtraError, match=r"cellcrawl\[microscopy\]"):
        cc.read_outlines(file)
