"""Files that were cut, or in which something flipped: a line that names them, or what is left."""

from __future__ import annotations

import random

import numpy as np
import pytest

import cellcrawl as cc
from cellcrawl.microscopy.outlines import Outline

pytest.importorskip("tifffile")
pytest.importorskip("roifile")
FORMS = ("cells.tif", "cells.zip", "cells.geojson", "cells_outlines.txt", "cells.xml")


@pytest.fixture(scope="module")
def outlines():
    angle = np.linspace(0.0, 2.0 * np.pi, 40, endpoint=False)
    circle = np.column_stack([np.cos(angle), np.sin(angle)])
    return [
        Outline(10.0 * circle + (20.0 + 2.0 * frame, 30.0), "1", frame, float(frame), y_down=True)
        for frame in range(5)
    ]


def refusal(read, file):
    """Return what is said of a file that is refused, "" for one that is read."""
    try:
        read(file)
    except cc.InputError as error:
        return str(error)
    return ""


@pytest.mark.parametrize("name", FORMS)
def test_a_damaged_file_is_refused_in_one_line_or_read_as_far_as_it_goes(name, outlines, tmp_path):
    whole = tmp_path / name
    cc.write_outlines(whole, outlines)
    content = whole.read_bytes()
    chance = random.Random(name)
    damaged = [content[: len(content) * part // 8] for part in range(1, 8)]
    for _ in range(25):
        place, bit = chance.randrange(len(content)), 1 << chance.randrange(8)
        if whole.suffix == ".tif" and place < 400:
            continue  # sizes in the head that ask for more memory than there is
        flipped = bytearray(content)
        flipped[place] ^= bit
        damaged.append(bytes(flipped))
    for number, data in enumerate(damaged):
        file = tmp_path / f"{number}-{name}"
        file.write_bytes(data)
        for read in (cc.read_outlines, cc.read_tracks):
            said = refusal(read, file)
            assert "\n" not in said
            assert not said or file.name in said


@pytest.mark.parametrize(
    ("content", "said"),
    [
        (b"PKabcdef", "archive cannot be opened"),
        (b"PAR1" + bytes(40), "Parquet"),
        (b'<?xml version="1.0" encoding="UTB-8"?><TrackMate></TrackMate>', "damaged"),
        (b"\x89HDF\r\n", "HDF5"),
    ],
)
def test_what_is_no_table_is_named(content, said, tmp_path):
    file = tmp_path / "cells.csv"
    file.write_bytes(content)
    with pytest.raises(cc.InputError, match=said):
        cc.read_tracks(file)


def test_a_label_image_with_frames_that_cannot_be_found_says_so(outlines, tmp_path, caplog):
    file = tmp_path / "cells.tif"
    cc.write_outlines(file, outlines)
    import tifffile

    with tifffile.TiffFile(file) as image:
        last = image.pages[-1].offset
    content = bytearray(file.read_bytes())
    content[last:] = bytes(len(content) - last)
    file.write_bytes(content)
    try:
        notes = " ".join(cc.read_outlines(file).source.notes)
    except cc.InputError as error:
        notes = str(error)
    assert "damaged" in notes or "cannot be read" in notes
    assert not caplog.records
