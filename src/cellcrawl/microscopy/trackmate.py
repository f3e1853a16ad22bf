"""TrackMate's XML files: the whole model with tracks and outlines, and the simple one of tracks."""

from __future__ import annotations

import xml.etree.ElementTree as ElementTree
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Literal

import numpy as np

from cellcrawl.errors import InputError
from cellcrawl.microscopy.columns import length_unit, time_unit
from cellcrawl.microscopy.grouping import tracks_of_records
from cellcrawl.microscopy.options import Reading
from cellcrawl.microscopy.outlines import Outline, Outlines
from cellcrawl.microscopy.polygons import without_repeats
from cellcrawl.microscopy.source import LeftOut, Source
from cellcrawl.microscopy.track import Tracks

_Event = Literal["start", "end"]
_SPLIT = "it splits or merges: two cells follow from one, or one from two"


@dataclass
class Model:
    """What a TrackMate model file holds, by arrays; filled while the file is read through."""

    length_units: str = ""
    time_units: str = ""
    frame_interval: float = 0.0
    spots: dict[int, int] = field(default_factory=dict)  # id -> place
    t: list[float] = field(default_factory=list)
    frame: list[int] = field(default_factory=list)
    x: list[float] = field(default_factory=list)
    y: list[float] = field(default_factory=list)
    roi: dict[int, np.ndarray] = field(default_factory=dict)  # place -> points around the spot
    edges: dict[str, list[tuple[int, int]]] = field(default_factory=dict)
    kept: list[str] | None = None  # tracks the user did not filter out


def read_trackmate_tracks(path: Path, reading: Reading) -> Tracks:
    """Read the tracks of a TrackMate XML file of either kind; see `cellcrawl.read_tracks`."""
    reading.without_columns(str(path))
    if _root_of(path) in ("Tracks", "root"):
        return _simple_tracks(path, reading)
    model = _model(path)
    codes, ids, left_out, notes = _linked(model, path)
    t, units = _times(model, reading)
    source = Source(str(path), "TrackMate XML", {}, model.length_units, units, True, tuple(notes))
    source, x, y = reading.scaled(source, np.array(model.x), np.array(model.y))
    return tracks_of_records(codes, ids, t, x, y, source, left_out)


def read_trackmate_outlines(path: Path, reading: Reading) -> Outlines:
    """Read the outlines of a TrackMate model file; see `cellcrawl.read_outlines`.

    Spots of no track, and those of tracks that split or merge, are left out and listed. In a file
    without any track every spot is a cell of its own.
    """
    reading.without_columns(str(path))
    model = _model(path)
    if not model.roi:
        raise InputError(
            f"{path} holds spots without outlines: use a detector that gives them (mask, label, "
            "thresholding, cellpose, StarDist), or read its tracks"
        )
    if any(model.edges.values()):
        codes, ids, left_out, notes = _linked(model, path)
    else:  # a segmentation that was not linked
        codes, ids = np.arange(len(model.t)), [f"spot {spot}" for spot in model.spots]
        left_out, notes = [], ["the spots are not linked: each outline is a cell of its own"]
    t, units = _times(model, reading)
    source = Source(
        str(path), "TrackMate XML with outlines", {}, model.length_units, units, True, tuple(notes)
    )
    source, x, y = reading.scaled(source, np.array(model.x), np.array(model.y))
    size = reading.pixel_size or 1.0
    found, bare, stray = [], 0, 0
    for place in np.lexsort((np.array(model.frame), codes)):
        where = int(place)
        if codes[where] < 0:
            stray += codes[where] == -1
            continue
        if where not in model.roi:
            bare += 1
            continue
        xy = without_repeats(size * model.roi[where] + (x[where], y[where]))
        found.append(
            Outline(
                xy,
                ids[int(codes[where])],
                model.frame[where],
                float(t[where]),
                source.length_units,
                source.time_units,
                source.y_down,
                (),
                source,
            )
        )
    if stray:
        left_out.append(LeftOut(f"{stray} spots", "they belong to no track", stray))
    if bare:
        left_out.append(LeftOut(f"{bare} spots", "they have no outline", bare))
    return Outlines(found, source, tuple(left_out))


def has_outlines(path: Path) -> bool:
    """Whether a TrackMate file gives its spots outlines."""
    for _, element in _elements(path, ("start",)):
        if element.tag == "Spot":
            return "ROI_N_POINTS" in element.attrib
    return False


def _elements(path: Path, events: tuple[_Event, ...]) -> Iterator[tuple[str, ElementTree.Element]]:
    try:
        yield from ElementTree.iterparse(path, events)
    except ElementTree.ParseError as error:
        raise InputError(f"{path} is not whole: its XML breaks off or is wrong ({error})") from None
    except OSError as error:
        raise InputError(f"cannot read {path}: {error.strerror or error}") from None


def _root_of(path: Path) -> str:
    for _, element in _elements(path, ("start",)):
        return element.tag
    return ""


def _model(path: Path) -> Model:
    """Read a model file once through, letting go of every element when it ends."""
    model, track = Model(), ""
    for event, element in _elements(path, ("start", "end")):
        if event == "start":
            if element.tag == "Model":
                model.length_units = length_unit(element.get("spatialunits", ""))
                model.time_units = time_unit(element.get("timeunits", ""))
            elif element.tag == "Track":
                track = element.get("TRACK_ID", element.get("name", ""))
                model.edges.setdefault(track, [])
            continue
        if element.tag == "Spot":
            _add_spot(model, element, path)
        elif element.tag == "Edge":
            ends = (element.get("SPOT_SOURCE_ID"), element.get("SPOT_TARGET_ID"))
            model.edges[track].append((int(ends[0] or -1), int(ends[1] or -1)))
        elif element.tag == "TrackID":
            if model.kept is None:
                model.kept = []
            model.kept.append(element.get("TRACK_ID", ""))
        elif element.tag == "FilteredTracks" and model.kept is None:
            model.kept = []
        elif element.tag == "ImageData":
            model.frame_interval = float(element.get("timeinterval") or 0.0)
        elif element.tag in ("SpotsInFrame", "Track"):
            element.clear()
    if not model.spots:
        raise InputError(f"{path} holds no spots: save it from TrackMate with its model")
    return model


def _add_spot(model: Model, element: ElementTree.Element, path: Path) -> None:
    try:
        identity = int(element.attrib["ID"])
        x, y = float(element.attrib["POSITION_X"]), float(element.attrib["POSITION_Y"])
        frame = int(float(element.get("FRAME") or 0))
        t = float(element.get("POSITION_T") or frame)
    except (KeyError, ValueError) as error:
        raise InputError(f"{path}: a spot has no number for {error}") from None
    place = len(model.t)
    model.spots[identity] = place
    for values, value in ((model.t, t), (model.x, x), (model.y, y)):
        values.append(value)
    model.frame.append(frame)
    points = int(element.get("ROI_N_POINTS") or 0)
    if points > 2 and element.text:
        numbers = np.array(element.text.split(), float)
        # Points of a plane; a mesh in space holds three numbers a point and more.
        if numbers.size == 2 * points:
            model.roi[place] = numbers.reshape(points, 2)
    element.clear()


def _linked(model: Model, path: Path) -> tuple[np.ndarray, list[str], list[LeftOut], list[str]]:
    """Return the track of each spot, -1 for none, by the edges between spots."""
    codes = np.full(len(model.t), -1, np.int64)
    frames = np.array(model.frame)
    ids: list[str] = []
    left_out: list[LeftOut] = []
    notes: list[str] = []
    kept = None if model.kept is None else set(model.kept)
    if kept is None:
        notes.append("the file names no filtered tracks: all are taken")
    filtered = 0
    gone: set[int] = set()
    for track, edges in model.edges.items():
        if not edges:
            continue
        ends = np.array([[model.spots.get(spot, -1) for spot in edge] for edge in edges])
        if np.any(ends < 0):
            left_out.append(LeftOut(track, "it links spots that are not in the file", len(edges)))
            gone |= set(ends[ends >= 0].tolist())
            continue
        if kept is not None and track not in kept:
            filtered += 1
            gone |= set(ends.ravel().tolist())
            continue
        ends = np.where(
            (frames[ends[:, 0]] > frames[ends[:, 1]])[:, None],
            ends[:, ::-1],
            ends,
        )
        if any(np.unique(side).size < side.size for side in ends.T):
            left_out.append(LeftOut(track, _SPLIT, len(edges) + 1))
            gone |= set(ends.ravel().tolist())
            continue
        codes[ends.ravel()] = len(ids)
        ids.append(track)
    if filtered:
        notes.append(f"{filtered} track{'s' if filtered > 1 else ''} filtered out in TrackMate")
    if not ids:
        raise InputError(
            f"{path} holds no tracks, only spots: link them in TrackMate and save it again"
            + (f" ({left_out[0]})" if left_out else "")
        )
    codes[[place for place in gone if codes[place] < 0]] = -2
    return codes, ids, left_out, notes


def _times(model: Model, reading: Reading) -> tuple[np.ndarray, str]:
    frames = np.array(model.frame, float)
    if reading.frame_interval is not None:
        return reading.frame_interval * frames, reading.time_units
    t = np.array(model.t)
    if np.ptp(t) == 0.0 < np.ptp(frames):
        return frames, "frame"
    return t, model.time_units


def _simple_tracks(path: Path, reading: Reading) -> Tracks:
    """Read the simple file: one particle a track, one detection a record, times in frames.

    Icy's and that of the Particle Tracking Challenge are the same, but for the names.
    """
    codes: list[int] = []
    rows: list[tuple[float, float, float]] = []
    ids: list[str] = []
    length, time, interval, form = "", "", 0.0, "XML of particle tracks"
    for event, element in _elements(path, ("start", "end")):
        if event == "start" and element.tag == "Tracks":
            form = "TrackMate XML of tracks"
            length = length_unit(element.get("spaceUnits", ""))
            time = time_unit(element.get("timeUnits", ""))
            interval = float(element.get("frameInterval") or 0.0)
        elif event == "start" and element.tag == "trackgroup":
            form, length = "Icy tracks", "pixel"
        elif event == "end" and element.tag == "detection":
            try:
                rows.append(tuple(float(element.attrib[name]) for name in ("t", "x", "y")))  # type: ignore[arg-type]
            except (KeyError, ValueError) as error:
                raise InputError(f"{path}: a detection has no number for {error}") from None
            codes.append(len(ids))
        elif event == "end" and element.tag in ("particle", "track"):
            ids.append(element.get("id", str(len(ids))))
            element.clear()
    if not rows:
        raise InputError(f"{path} holds no tracks")
    if len(set(ids)) < len(ids):
        ids = [str(number) for number in range(len(ids))]
    frames, x, y = np.array(rows).T
    source = Source(str(path), form, {}, length, "", True)
    if reading.frame_interval is None and interval > 0.0 and time != "frame":
        source = Source(str(path), source.format, {}, length, time, True)
        t = interval * frames
    else:
        source, t = reading.timed(source, frames)
    source, x, y = reading.scaled(source, x, y)
    return tracks_of_records(np.array(codes), ids, t, x, y, source)
