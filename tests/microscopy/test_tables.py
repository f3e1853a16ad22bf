"""Plain tables of tracks: however they were written, the same cells come out."""

from __future__ import annotations

import numpy as np
import pytest

import cellcrawl as cc
from cellcrawl.microscopy import tables

# Two cells of four records; the second starts later, and y is no function of x.
RECORDS = [
    ("a", 0.0, 1.5, 2.25),
    ("a", 1.0, 2.5, 2.75),
    ("a", 2.0, 3.5, 4.25),
    ("a", 3.0, 4.5, 4.75),
    ("b", 1.0, 10.5, -2.25),
    ("b", 2.0, 11.5, -3.25),
    ("b", 3.0, 12.25, -5.25),
    ("b", 4.0, 13.5, -6.25),
]


def text(names=("track", "t", "x", "y"), separator=",", decimal=".", order=None, ids=str):
    rows = [RECORDS[i] for i in order] if order is not None else RECORDS
    lines = [separator.join(names)] if names else []
    lines += [
        separator.join([ids(name), *(f"{v:.4f}".replace(".", decimal) for v in values)])
        for name, *values in rows
    ]
    return "\n".join(lines) + "\n"


def must_be_the_two_cells(tracks, names=("a", "b")):
    assert sorted(tracks.ids) == sorted(names)
    for name, given in zip(names, ("a", "b"), strict=True):
        rows = np.array([values for track, *values in RECORDS if track == given])
        track = tracks[name]
        np.testing.assert_allclose(np.column_stack([track.t, track.x, track.y]), rows)


def read(tmp_path, content, name="cells.csv", **options):
    file = tmp_path / name
    file.write_bytes(content if isinstance(content, bytes) else content.encode())
    return cc.read_tracks(file, **options)


@pytest.mark.parametrize("separator", [",", ";", "\t", " ", "   ", ", ", " ; "])
@pytest.mark.parametrize("decimal", [".", ","])
def test_separators_and_decimal_signs_do_not_matter(separator, decimal, tmp_path):
    if separator.strip() == "," and decimal == ",":
        pytest.skip("no reader could tell")
    must_be_the_two_cells(read(tmp_path, text(separator=separator, decimal=decimal)))


def test_quoted_decimal_commas_between_commas(tmp_path):
    lines = ["track,t,x,y"]
    lines += [
        ",".join([name, *(f'"{v:.4f}"'.replace(".", ",") for v in values)])
        for name, *values in RECORDS
    ]
    must_be_the_two_cells(read(tmp_path, "\n".join(lines)))


@pytest.mark.parametrize("end", ["\n", "\r\n", "\r"])
@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16", "cp1252"])
def test_line_ends_and_encodings_do_not_matter(encoding, end, tmp_path):
    content = text(("Track n°", "t", "x", "y")).replace("\n", end).encode(encoding)
    must_be_the_two_cells(read(tmp_path, content))


@pytest.mark.parametrize(
    "names",
    [
        ("id", "time", "x", "y"),
        ("TrackID", "Time", "Position X", "Position Y"),
        ("TRACK_ID", "POSITION_T", "POSITION_X", "POSITION_Y"),
        ("particle", "frame", "x", "y"),
        ("label", "slice", "Location_Center_X", "Location_Center_Y"),
        ("Cell", "Timepoint", "centroid_x", "centroid_y"),
        ("trajectory", "t [s]", "x [µm]", "y [µm]"),
        ("object_id", "time_min", "x_um", "y_um"),
        ("CellID", "Elapsed (s)", "X (px)", "Y (px)"),
        ("label", "frame", "centroid-1", "centroid-0"),
        ("Track #", "Frame #", "X", "Y"),
    ],
)
def test_columns_have_the_names_that_people_use(names, tmp_path):
    must_be_the_two_cells(read(tmp_path, text(names)))


def test_columns_may_come_in_any_order_with_others_between(tmp_path):
    lines = ["quality,y,note,x,ID,t"]
    lines += [f"0.{i},{y},seen,{x},{name},{t}" for i, (name, t, x, y) in enumerate(RECORDS)]
    must_be_the_two_cells(read(tmp_path, "\n".join(lines)))


@pytest.mark.parametrize(
    "above",
    [
        "sep=,\n",
        "# made by hand\n",
        "Tracks of 3 May, dish 7\n\n",
        "Results\n=======\n\n",
        "% one\n% two\n",
    ],
)
def test_lines_above_the_names_are_passed_over(above, tmp_path):
    must_be_the_two_cells(read(tmp_path, above + text()))


def test_names_may_stand_in_a_comment(tmp_path):
    must_be_the_two_cells(read(tmp_path, "# " + text(separator=" ")))


def test_rows_may_come_in_any_order_and_twice(tmp_path):
    order = np.random.default_rng(1).permutation(len(RECORDS))
    tracks = read(tmp_path, text(order=[*order, *order[:3]]))
    must_be_the_two_cells(tracks)
    assert "3 records given twice: counted once" in tracks.source.notes
    assert "the rows were not in the order of time: sorted" in tracks.source.notes


def test_row_names_of_r_and_an_index_of_pandas_are_no_ids(tmp_path):
    rows = text().splitlines()
    written = [rows[0], *(f"{i},{row}" for i, row in enumerate(rows[1:], start=1))]
    must_be_the_two_cells(read(tmp_path, "\n".join(written)))
    with_index = ["," + rows[0], *written[1:]]
    must_be_the_two_cells(read(tmp_path, "\n".join(with_index)))


def test_whole_numbers_written_as_decimals_are_the_same_ids(tmp_path):
    tracks = read(tmp_path, text(ids={"a": "3.0", "b": "12.0"}.get))
    must_be_the_two_cells(tracks, ("3", "12"))


def test_blank_and_bad_records_are_left_out_with_a_word(tmp_path):
    content = text() + "a,4,,\na,5,nan,NaN\nb,6,far,1\nb,7,1\n,8,1,2\n"
    tracks = read(tmp_path, content)
    must_be_the_two_cells(tracks)
    said = tracks.summary()
    assert "line 12: x is not a number" in said
    assert "it has another number of cells" in said
    assert "1 record: they belong to no track" in said
    assert "blank: skipped" in said


def test_a_track_that_splits_is_set_aside_and_named(tmp_path):
    tracks = read(tmp_path, text() + "b,2,90,90\nc,1,5,5\n")
    assert tracks.ids == ("a",)
    reasons = {one.what: one.reason for one in tracks.left_out}
    assert "two positions at one time" in reasons["b"]
    assert reasons["c"] == "a single record is no path"


def test_two_positions_at_one_time_without_an_id_are_refused(tmp_path):
    content = "t,x,y\n0,1,1\n1,2,2\n0,5,5\n1,6,7\n"
    with pytest.raises(cc.InputError, match="two positions at t = 0 and no column"):
        read(tmp_path, content)


def test_cells_that_follow_each_other_are_never_made_one_track(tmp_path):
    rows = [f"{c},{10 * c + i},{100 * c + i},{50 * c - i}" for c in (1, 2, 3) for i in range(10)]
    content = "wanderer,t,x,y\n" + "\n".join(rows)
    with pytest.raises(cc.InputError, match="'wanderer' seems to tell 3 cells apart"):
        read(tmp_path, content)
    assert len(read(tmp_path, content, columns="id=wanderer,t=t,x=x,y=y")) == 3
    assert len(read(tmp_path, content, columns="id=none,t=t,x=x,y=y")) == 1


@pytest.mark.parametrize("between", ["\n", "\n\n", ",,\n", "  \n"])
def test_blank_lines_keep_tracks_apart_where_there_is_no_id(between, tmp_path):
    blocks = ["".join(f"{10 * c + i},{3 * c + i},{i}\n" for i in range(4)) for c in range(3)]
    content = "t,x,y\n" + between.join(blocks) + "\n\n"
    tracks = read(tmp_path, content)
    assert tracks.ids == ("1", "2", "3")
    np.testing.assert_array_equal(tracks["3"].t, [20, 21, 22, 23])
    assert "blank lines keep the tracks apart" in tracks.summary()


def test_a_state_that_changes_on_the_way_is_no_id(tmp_path):
    rows = [f"{int(i > 7)},{i},{i},{0.5 * i}" for i in range(20)]
    assert len(read(tmp_path, "state,t,x,y\n" + "\n".join(rows))) == 1


def test_the_same_id_in_two_movies_is_two_cells(tmp_path):
    rows = [
        f"m{m},{c},{t},{10 * m + t},{5 * c + t}" for m in (1, 2) for c in (1, 2) for t in (0, 1)
    ]
    tracks = read(tmp_path, "movie,cell,t,x,y\n" + "\n".join(rows))
    assert tracks.ids == ("m1/1", "m1/2", "m2/1", "m2/2")
    assert tracks.source.columns["group"] == "movie"


def test_columns_may_be_named_by_the_caller(tmp_path):
    content = text(("who", "when", "east", "north"))
    with pytest.raises(cc.InputError, match="name them with --columns"):
        read(tmp_path, content)
    for columns in (
        "id=who,t=when,x=east,y=north",
        "id=1,t=2,x=3,y=4",
        {"id": "who", "t": "when", "x": 3, "y": 4},
        "id,t,x,y",
    ):
        must_be_the_two_cells(read(tmp_path, content, columns=columns))
    with pytest.raises(cc.InputError, match="did you mean 'north'"):
        read(tmp_path, content, columns="id=who,t=when,x=east,y=nort")
    with pytest.raises(cc.InputError, match="no role 'who'"):
        read(tmp_path, content, columns="who=id")
    with pytest.raises(cc.InputError, match="must name y"):
        read(tmp_path, content, columns="x=east")


@pytest.mark.parametrize("pattern", ["x{}", "X_{}", "{}_x", "{} x"])
def test_cells_side_by_side_are_cells_of_their_own(pattern, tmp_path):
    ids = ("a", "b")
    y_of = pattern.replace("x", "y").replace("X", "Y")
    names = [p.format(c) for c in ids for p in (pattern, y_of)]
    lines = [",".join(["frame", *names])]
    for t in range(5):
        found = {n: (x, y) for n, when, x, y in RECORDS if when == t}
        lines.append(",".join([str(t), *(str(v) for c in ids for v in found.get(c, ("", "")))]))
    tracks = read(tmp_path, "\n".join(lines))
    must_be_the_two_cells(tracks)
    assert "2 cells side by side" in tracks.summary()


def test_units_may_stand_below_the_names(tmp_path):
    rows = text().splitlines()
    source = read(tmp_path, "\n".join([rows[0], ",min,um,um", *rows[1:]])).source
    assert (source.length_units, source.time_units) == ("µm", "min")


def test_cellprofilers_names_may_begin_with_the_object(tmp_path):
    names = ("Nuclei_TrackObjects_Label_30", "ImageNumber")
    content = text((*names, "Nuclei_Location_Center_X", "Nuclei_Location_Center_Y"))
    tracks = read(tmp_path, content)
    must_be_the_two_cells(tracks)
    assert tracks.source.y_down


def test_a_number_of_records_is_no_id(tmp_path):
    content = "ID,t,x,y\n" + "".join(f"{i},{i % 5},{i},{i}\n" for i in range(10))
    with pytest.raises(cc.InputError, match="ID seems to number records"):
        read(tmp_path, content)


def test_a_table_without_names_is_told_by_its_content(tmp_path):
    number = {"a": "1", "b": "2"}.get
    must_be_the_two_cells(read(tmp_path, text((), " ", ids=number)), ("1", "2"))
    # celltrackR's own text: number of the frame, id, time, and three coordinates.
    rows = [
        f"{int(t) + 1} {number(name)} {24 * t:g} {x} {y} {-6400 + 3 * x}"
        for name, t, x, y in RECORDS
    ]
    tracks = read(tmp_path, "\n".join(rows))
    assert tracks.ids == ("1", "2")
    np.testing.assert_array_equal(tracks["2"].t, [24.0, 48.0, 72.0, 96.0])
    np.testing.assert_array_equal(tracks["2"].y, [-2.25, -3.25, -5.25, -6.25])
    with pytest.raises(cc.InputError, match="names no columns"):
        read(tmp_path, "1,2,3\n4,5,6\n7,9,3\n")


def test_times_are_scaled_by_the_frame_interval_and_positions_by_the_pixel(tmp_path):
    content = text(("track", "frame", "x", "y"))
    tracks = read(tmp_path, content, frame_interval="2.5 min", pixel_size="0.5 um")
    np.testing.assert_array_equal(tracks["b"].t, [2.5, 5.0, 7.5, 10.0])
    np.testing.assert_array_equal(tracks["a"].x, [0.75, 1.25, 1.75, 2.25])
    assert (tracks.source.time_units, tracks.source.length_units) == ("min", "µm")
    assert "unknown" not in tracks.summary()
    assert "unknown (give the pixel size)" in read(tmp_path, content).summary()


def test_a_pixel_size_is_refused_where_there_is_a_unit_already(tmp_path):
    content = text(("track", "t [s]", "x [µm]", "y [µm]"))
    with pytest.raises(cc.InputError, match="in µm already"):
        read(tmp_path, content, pixel_size=0.5)
    uneven = content.replace("1.0000", "1.1300", 1)
    with pytest.raises(cc.InputError, match="times of its own, not frames"):
        read(tmp_path, uneven, frame_interval=60)


@pytest.mark.parametrize(
    ("times", "right"),
    [
        (("00:00:10", "00:01:00", "01:00:00"), (10.0, 60.0, 3600.0)),
        (("00:10", "01:00", "61:30"), (10.0, 60.0, 3690.0)),
        (("2024-05-01 10:00:00", "2024-05-01 10:00:30", "2024-05-02 10:00:00"), (0, 30, 86400)),
    ],
)
def test_clock_times_are_seconds(times, right, tmp_path):
    rows = [f"{time},{i},{i * i}" for i, time in enumerate(times)]
    track = read(tmp_path, "time,x,y\n" + "\n".join(rows))[0]
    np.testing.assert_array_equal(track.t, right)
    assert track.time_units == "s"


def test_a_time_that_nobody_filled_in_gives_way_to_the_frame(tmp_path):
    rows = [f"1,0.0,{i},{i},{i}" for i in range(5)]
    track = read(tmp_path, "track,t,frame,x,y\n" + "\n".join(rows))[0]
    np.testing.assert_array_equal(track.t, np.arange(5))


def test_trackmates_spots_have_y_downwards_and_their_units(tmp_path):
    tracks = [cc.microscopy.Track(np.arange(5.0), np.arange(5.0), np.arange(5.0) ** 2)]
    file = cc.write_tracks(tmp_path / "spots.csv", tracks, form="trackmate table")
    assert cc.read_tracks(file).source.y_down
    assert not cc.read_tracks(file, image_coordinates=False).source.y_down
    assert cc.read_tracks(file, image_coordinates=False)[0].y_down is False


@pytest.mark.parametrize(
    ("content", "says"),
    [
        ("", "is empty"),
        ("one word\n", "holds no table"),
        ("t,x,y\n", "holds no table"),
        ("a,b,c\n1,2,3\n", "no columns of positions among a, b, c"),
        ("t,x\n1,2\n", "no columns of positions among t, x"),
        ("x,y\n1,2\n3,4\n", "no column of times or frames"),
        ("t,x,y\n1,2,3\n", "a single record is no path"),
        ("t,x,y\n1,a,3\n2,b,3\n3,c,4\n", "x = 'a' is not a number"),
        ("SPOT_SOURCE_ID,SPOT_TARGET_ID,LINK_COST\n1,2,0.5\n2,3,0.5\n", "table of edges"),
        ("TRACK_ID,TRACK_DURATION,TRACK_START\n1,2,0.5\n2,3,0.5\n", "table of whole tracks"),
        (
            "ImageNumber,ObjectNumber,Location_Center_X,Location_Center_Y\n1,1,2,3\n2,1,4,5\n",
            "has no TrackObjects_Label",
        ),
        ("{\\rtf1", "holds no table"),
        (b"\x89HDF\r\n\x1a\n", "is an HDF5 file"),
        (b"RDX3\nX\n", "write it as CSV"),
    ],
)
def test_what_is_no_table_is_refused_in_one_line(content, says, tmp_path):
    with pytest.raises(cc.InputError, match=says) as error:
        read(tmp_path, content)
    assert "cells.csv" in str(error.value)
    assert "\n" not in str(error.value)
    with pytest.raises(cc.InputError, match="no such file"):
        cc.read_tracks(tmp_path / "absent.csv")


def test_many_tracks_are_read_in_no_time(tmp_path):
    count, records = 20_000, 30
    rng = np.random.default_rng(0)
    x, y = np.cumsum(rng.normal(size=(2, count, records)), axis=2)
    ids, t = np.divmod(np.arange(count * records), records)
    file = tmp_path / "many.csv"
    body = "\n".join(
        f"{i},{j},{a:.3f},{b:.3f}" for i, j, a, b in zip(ids, t, x.ravel(), y.ravel(), strict=True)
    )
    file.write_text("track,t,x,y\n" + body)
    tracks = cc.read_tracks(file)
    assert len(tracks) == count
    assert tracks.t.size == count * records
    np.testing.assert_allclose(tracks[777].x, x[777], atol=6e-4)


@pytest.mark.parametrize(
    "names",
    [
        ("Zelle", "Zeit [min]", "X [µm]", "Y [µm]"),
        ("Cellule", "Temps [min]", "X (µm)", "Y (µm)"),
        ("TrackID", "Time (min)", "Position X (um)", "Position Y (um)"),
    ],
)
def test_names_of_other_languages_and_units_in_them_are_known(names, tmp_path):
    content = text(names, ";", ",").encode("cp1252")
    tracks = read(tmp_path, content)
    must_be_the_two_cells(tracks)
    assert (tracks.source.length_units, tracks.source.time_units) == ("µm", "min")


def test_a_column_of_units_tells_the_unit_if_all_rows_agree(tmp_path):
    lines = ["Position X,Position Y,Unit,Category,Collection,Time,TrackID"]
    lines += [f"{x},{y},um,Spot,Position,{t},{name}" for name, t, x, y in RECORDS]
    tracks = read(tmp_path, "\n".join(lines))
    must_be_the_two_cells(tracks)
    assert tracks.source.length_units == "µm"
    mixed = read(tmp_path, "\n".join([*lines[:-1], lines[-1].replace(",um,", ",nm,")]))
    assert mixed.source.length_units == ""


def test_objects_that_ilastik_did_not_link_belong_to_no_track(tmp_path):
    lines = ["frame,labelimageId,trackId,lineageId,Center_of_the_object_0,Center_of_the_object_1"]
    lines += [f"{t:g},1,{'ab'.index(n) + 1},1,{x},{y}" for n, t, x, y in RECORDS]
    lines += [f"{t},9,-1,-1,{50 * t},7" for t in (0, 1, 2)]
    tracks = read(tmp_path, "\n".join(lines))
    must_be_the_two_cells(tracks, ("1", "2"))
    assert tracks.source.y_down
    assert [one.records for one in tracks.left_out] == [3]


def test_tracks_of_icy_are_read(tmp_path):
    def track(name):
        rows = [values for one, *values in RECORDS if one == name]
        points = "".join(f'<detection t="{t:g}" x="{x}" y="{y}" z="0"/>' for t, x, y in rows)
        return f'<track id="{name}">{points}</track>'

    group = f'<trackgroup description="g">{track("a")}{track("b")}</trackgroup>'
    tracks = read(tmp_path, f"<root><trackfile version='1'/>{group}</root>", "cells.xml")
    must_be_the_two_cells(tracks)
    assert (tracks.source.length_units, tracks.source.y_down) == ("pixel", True)


def test_a_table_read_in_many_pieces_is_that_read_in_one(tmp_path, monkeypatch):
    rows = list(RECORDS)
    rows[2] = ("a", 2.0, "?", 4.25)
    rows[5] = ("b", "soon", 11.5, -3.25)
    lines = ["movie,track,t,x,y,unit"]
    lines += [f"m{movie},{','.join(map(str, row))},um" for movie in (1, 2) for row in rows]
    whole = read(tmp_path, "\n".join(lines), "whole.csv")
    monkeypatch.setattr(tables, "_BLOCK", 64)  # two or three rows
    pieces = read(tmp_path, "\n".join(lines), "pieces.csv")
    assert pieces.ids == whole.ids
    assert len(whole.ids) == 4
    for name in ("t", "x", "y", "starts"):
        np.testing.assert_array_equal(getattr(pieces, name), getattr(whole, name))
    assert [(o.what, o.reason) for o in pieces.left_out] == [
        (o.what, o.reason) for o in whole.left_out
    ]
    assert whole.left_out
    assert pieces.source.length_units == whole.source.length_units == "µm"
