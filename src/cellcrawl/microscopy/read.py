"""The one door for tracks and outlines: whatever the file is, it is known by its content."""

from __future__ import annotations

import contextlib
from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace
from os import PathLike
from pathlib import Path
from typing import Any

import numpy as np

from cellcrawl.arguments import checked
from cellcrawl.errors import CellcrawlError, InputError
from cellcrawl.microscopy.cellpose_masks import read_cellpose_masks
from cellcrawl.microscopy.geff_graphs import read_geff
from cellcrawl.microscopy.grouping import tracks_of_records
from cellcrawl.microscopy.imagej_rois import read_imagej_rois
from cellcrawl.microscopy.label_images import linked_or_apart
from cellcrawl.microscopy.options import Reading
from cellcrawl.microscopy.outline_lists import read_cellpose_text, read_celltool, read_geojson
from cellcrawl.microscopy.outlines import Outlines
from cellcrawl.microscopy.recognise import form_of_file, is_geff
from cellcrawl.microscopy.source import LeftOut, Source
from cellcrawl.microscopy.table_tracks import read_table_tracks
from cellcrawl.microscopy.tiff_labels import (
    read_cell_tracking_challenge,
    read_label_tiff,
    with_parents,
)
from cellcrawl.microscopy.track import Tracks
from cellcrawl.microscopy.trackmate import read_trackmate_outlines, read_trackmate_tracks

_OUTLINES: dict[str, Callable[[Path, Reading], Outlines]] = {
    "tiff": read_label_tiff,
    "cellpose masks": read_cellpose_masks,
    "cellpose outlines": read_cellpose_text,
    "imagej roi": read_imagej_rois,
    "geojson": read_geojson,
    "celltool": read_celltool,
    "trackmate": read_trackmate_outlines,
}


@checked
def read_tracks(
    path: str | PathLike[str],
    *,
    columns: str | Mapping[str, str | int] | None = None,
    frame_interval: Any = None,
    pixel_size: Any = None,
    image_coordinates: bool | None = None,
) -> Tracks:
    """Read tracks from whatever tracking programs and people write, recognised by content.

    Parameters
    ----------
    path : path-like
        A table with the usual column names (any separator, decimal sign, encoding and order of
        rows), TrackMate's CSV and XML files, tables of trackpy, btrack, ultrack, napari,
        celltrackR, CellProfiler, ImageJ's Manual Tracking and MTrackJ, a napari array (``.npy``),
        a GEFF graph, a folder of the Cell Tracking Challenge; or outlines, whose centroids are
        taken.
    columns : str or mapping, optional
        Which column of a table is what, where the names do not say so:
        ``"id=Cell,t=Time,x=X,y=Y"``, or ``"id,t,x,y"`` in the order of the file; roles are id,
        t, frame, x, y, z, parent and group (ids of different groups are different cells).
    frame_interval : float or str, optional
        Time between frames, such as 60 or ``"60 s"``.
    pixel_size : float or str, optional
        Size of a pixel, such as 0.65 or ``"0.65 µm"``, where positions are in pixels.
    image_coordinates : bool, optional
        Whether y points down; that of the form unless given: down for what image programs write,
        up for plain tables. Coordinates stay those of the file.

    Returns
    -------
    Tracks
        With ``source``, what was recognised, and ``left_out``, what was not taken and why;
        ``tracks.summary()`` tells both.

    Raises
    ------
    InputError
        If the file holds no tracks, or only a guess could tell which.

    See Also
    --------
    cellcrawl.read_outlines, cellcrawl.write_tracks, cellcrawl.classify_track

    Notes
    -----
    Tracks that split or merge, with two positions at one time, are left out: they are no path of
    one cell. So are spots of no track and blank records. Nothing is interpolated.
    """
    reading = Reading.of(columns, frame_interval, pixel_size, image_coordinates)
    file = Path(path)
    form = form_of_file(file)
    with _damage_told(file):
        return _tracks_of(file, form, reading)


@checked
def read_outlines(
    path: str | PathLike[str],
    *,
    frame_interval: Any = None,
    pixel_size: Any = None,
    image_coordinates: bool | None = None,
) -> Outlines:
    """Read outlines of cells from whatever segmentation programs write, recognised by content.

    Parameters
    ----------
    path : path-like
        A label TIFF, cellpose's ``_seg.npy`` or ``_outlines.txt``, an ImageJ ROI or ROI zip,
        GeoJSON, a Celltool contour, a TrackMate XML with outlines, a folder of the Cell Tracking
        Challenge; or a folder of such files, a frame each in the order of their names.
    frame_interval, pixel_size, image_coordinates
        As in `cellcrawl.read_tracks`.

    Returns
    -------
    Outlines
        A sequence; ``outlines.dataset`` is the whole by track and frame. One of them goes into
        `cellcrawl.FromOutline`.

    Raises
    ------
    InputError
        If the file holds no outlines.

    See Also
    --------
    cellcrawl.read_tracks, cellcrawl.write_outlines, cellcrawl.FromOutline
    """
    reading = Reading.of(None, frame_interval, pixel_size, image_coordinates)
    file = Path(path)
    form = form_of_file(file)
    with _damage_told(file):
        return _outlines_of(file, form, reading)


@contextlib.contextmanager
def _damage_told(path: Path) -> Iterator[None]:
    """Turn what a broken file makes a reader stumble over into one line that names the file."""
    try:
        yield
    except CellcrawlError:
        raise
    except (ArithmeticError, LookupError, TypeError, ValueError, EOFError, MemoryError) as error:
        told = " ".join(str(error).split())[:120] or type(error).__name__
        raise InputError(f"{path} seems to be damaged: {told}") from error


def _tracks_of(file: Path, form: str, reading: Reading) -> Tracks:
    if form == "table":
        return read_table_tracks(file, reading)
    if form in ("trackmate", "trackmate tracks"):
        return read_trackmate_tracks(file, reading)
    if form in ("geff", "folder of geff"):
        return read_geff(_geff_within(file, form), reading)
    if form == "numpy array":
        return _napari_array(file, reading)
    reading.without_columns(str(file))
    if form == "cell tracking challenge":
        outlines, parents = read_cell_tracking_challenge(file, reading)
        return with_parents(outlines.tracks, parents)
    if form == "folder":
        return _folder_outlines(file, reading).tracks
    return _OUTLINES[form](file, reading).tracks


def _outlines_of(file: Path, form: str, reading: Reading) -> Outlines:
    if form == "cell tracking challenge":
        return read_cell_tracking_challenge(file, reading)[0]
    if form == "folder":
        return _folder_outlines(file, reading)
    if form not in _OUTLINES:
        raise InputError(
            f"{file} holds positions, not outlines: read it with read_tracks, or give a label "
            "image, ROIs, GeoJSON, Celltool contours, cellpose's or TrackMate's outlines"
        )
    return _OUTLINES[form](file, reading)


def _geff_within(path: Path, form: str) -> Path:
    if form == "geff":
        return path
    return next(child for child in path.iterdir() if child.is_dir() and is_geff(child))


def _napari_array(path: Path, reading: Reading) -> Tracks:
    """Read napari's array of tracks: a record a row, with id, t, (z,) y, x."""
    reading.without_columns(str(path))
    try:
        rows = np.load(path, allow_pickle=False)
    except ValueError as error:
        raise InputError(f"{path} cannot be read: {error}") from None
    if rows.ndim != 2 or rows.shape[1] not in (4, 5) or rows.dtype.kind not in "iuf":
        raise InputError(
            f"{path} has shape {rows.shape}: napari's tracks have the columns id, t, (z,) y, x"
        )
    names, codes = np.unique(rows[:, 0], return_inverse=True)
    source = Source(str(path), "napari tracks array", {}, "pixel", "", True)
    source, t = reading.timed(source, rows[:, 1])
    source, x, y = reading.scaled(source, rows[:, -1].astype(float), rows[:, -2].astype(float))
    return tracks_of_records(codes, [f"{name:g}" for name in names], t, x, y, source)


def _folder_outlines(folder: Path, reading: Reading) -> Outlines:
    """Read the files of a folder, a frame each; one that cannot be read is listed."""
    files = sorted(path for path in folder.iterdir() if path.is_file() and path.name[0] != ".")
    out: list[LeftOut] = []
    found: list[tuple[Path, Outlines]] = []
    for path in files:
        try:
            form = form_of_file(path)
            if form not in _OUTLINES:
                raise InputError("it holds no outlines")
            with _damage_told(path):
                found.append((path, _OUTLINES[form](path, reading)))
        except InputError as error:
            out.append(LeftOut(path.name, str(error).replace(str(path), "it"), 0))
    if not found:
        why = f": {out[0]}" if out else ""
        raise InputError(f"{folder} holds no file of outlines{why}")
    out += [one for _, outlines in found for one in outlines.left_out]
    source = replace(found[0][1].source, path=str(folder))
    _, times = reading.timed(source, np.arange(len(found), dtype=float))
    if source.format == "Celltool contour":  # a file a cell, and nothing of time
        placed = [outline for _, outlines in found for outline in outlines]
    elif source.format in ("label TIFF", "cellpose masks"):
        placed = [
            replace(outline, frame=frame, t=float(times[frame]))
            for frame, (_, outlines) in enumerate(found)
            for outline in outlines
        ]
        placed, notes = linked_or_apart(placed)
        source = replace(source, notes=(*source.notes, *notes))
    else:  # cells are numbered anew in every file
        placed = [
            replace(
                outline, track=f"{path.stem}/{outline.track}", frame=frame, t=float(times[frame])
            )
            for frame, (path, outlines) in enumerate(found)
            for outline in outlines
        ]
        note = "cells of different files are not linked: each is a track of its own"
        source = replace(source, notes=(*source.notes, note))
    return Outlines([replace(one, source=source) for one in placed], source, tuple(out))
