"""Tracks as the text of tables and of TrackMate's model file."""

from __future__ import annotations

import csv
import io
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any, Final

import numpy as np

from cellcrawl.errors import InputError
from cellcrawl.microscopy.track import Tracks
from cellcrawl.microscopy.trackmate_model import shown, trackmate_model

_EVEN = 1e-4  # of a frame interval: how far a time may be from a whole frame


def write_text(target: Path, text: str) -> None:
    """Write a file under another name first, so that none is left half written."""
    partial = target.with_name(f".{target.name}.part")
    try:
        partial.write_text(text, encoding="utf-8", newline="")
        partial.replace(target)
    except OSError:
        partial.unlink(missing_ok=True)
        raise


def _lines(rows: Iterable[Iterable[Any]], delimiter: str = ",") -> str:
    stream = io.StringIO()
    csv.writer(stream, delimiter=delimiter, lineterminator="\n").writerows(rows)
    return stream.getvalue()


def record_ids(tracks: Tracks) -> list[str]:
    """Return the id of the track of each record."""
    return [
        _named(name)
        for name, size in zip(tracks.ids, np.diff(tracks.starts), strict=True)
        for _ in range(int(size))
    ]


def _named(name: str) -> str:
    """Return an id that is not blank: that would be read as no track."""
    return name or "0"


def numbers_of(tracks: Tracks, first: int = 0) -> dict[str, int]:
    """Return a whole number for every id: its own where all are whole numbers."""
    if all(name.isascii() and name.isdigit() for name in tracks.ids if name):
        return {name or "0": int(name or 0) for name in tracks.ids}
    return {name or "0": number for number, name in enumerate(tracks.ids, start=first)}


def frames_of(t: np.ndarray) -> tuple[np.ndarray, float]:
    """Return times as whole numbers of frames from the first, and the interval.

    Raises
    ------
    InputError
        If the times are no multiples of one interval.
    """
    distinct = np.unique(t)
    if distinct.size < 2:
        return np.zeros(t.size, np.int64), 1.0
    steps = np.diff(distinct)
    interval = float(steps[steps > _EVEN * steps.max()].min())
    frames = (t - distinct[0]) / interval
    whole = np.round(frames)
    interval = float((distinct[-1] - distinct[0]) / max(whole.max(), 1.0))
    if np.any(np.abs((t - distinct[0]) / interval - whole) > _EVEN * np.maximum(whole, 1.0) + 1e-3):
        raise InputError(
            "the times are no multiples of one frame interval: write a plain table or TrackMate XML"
        )
    return whole.astype(np.int64), interval


def plain_table(tracks: Tracks, extra: dict[str, np.ndarray]) -> str:
    """Return a table of track, t, x, y and further columns."""
    units = tracks.source.length_units, tracks.source.time_units
    # Units of the model would not be known as such by their name in brackets.
    length, time = (
        f" [{unit}]" if unit in ("µm", "pixel", "nm", "mm", "s", "min", "h") else ""
        for unit in units
    )
    header = ["track", f"t{time}", f"x{length}", f"y{length}", *extra]
    columns = [map(shown, values) for values in (tracks.t, tracks.x, tracks.y, *extra.values())]
    return _lines([header, *zip(record_ids(tracks), *columns, strict=True)])


def _celltrackr(tracks: Tracks) -> str:
    rows = zip(
        record_ids(tracks),
        map(shown, tracks.t),
        map(shown, tracks.x),
        map(shown, tracks.y),
        strict=True,
    )
    return _lines([["id", "t", "x", "y"], *rows], " ")


def _trackpy(tracks: Tracks) -> str:
    frames, _ = frames_of(tracks.t)
    numbers = numbers_of(tracks)
    rows = zip(
        map(shown, tracks.y),
        map(shown, tracks.x),
        frames.tolist(),
        (numbers[name] for name in record_ids(tracks)),
        strict=True,
    )
    return _lines([["y", "x", "frame", "particle"], *rows])


def napari_rows(tracks: Tracks) -> np.ndarray:
    """Return napari's array of tracks: id, frame, y, x in each row."""
    frames, _ = frames_of(tracks.t)
    numbers = numbers_of(tracks)
    ids = np.array([numbers[name] for name in record_ids(tracks)], float)
    return np.column_stack([ids, frames, tracks.y, tracks.x])


def _napari(tracks: Tracks) -> str:
    rows = ([int(i), int(t), shown(y), shown(x)] for i, t, y, x in napari_rows(tracks))
    return _lines([["track_id", "t", "y", "x"], *rows])


def _btrack(tracks: Tracks) -> str:
    frames, _ = frames_of(tracks.t)
    numbers = numbers_of(tracks, first=1)
    header = ["ID", "t", "x", "y", "z", "parent", "root", "state", "generation", "dummy"]
    rows = (
        [own, frame, shown(x), shown(y), 0.0, parent, parent, 0, 0, False]
        for name, frame, x, y in zip(
            record_ids(tracks), frames.tolist(), tracks.x, tracks.y, strict=True
        )
        for own in [numbers[name]]
        for parent in [numbers.get(tracks.parents.get(name, ""), own)]
    )
    return _lines([header, *rows], " ")


def _manual_tracking(tracks: Tracks) -> str:
    frames, _ = frames_of(tracks.t)
    numbers = numbers_of(tracks, first=1)
    header = [" ", "Track n°", "Slice n°", "X", "Y"]
    rows = (
        [row, numbers[name], frame + 1, shown(x), shown(y)]
        for row, (name, frame, x, y) in enumerate(
            zip(record_ids(tracks), frames.tolist(), tracks.x, tracks.y, strict=True), start=1
        )
    )
    return _lines([header, *rows])


def _cellprofiler(tracks: Tracks) -> str:
    frames, _ = frames_of(tracks.t)
    numbers = numbers_of(tracks, first=1)
    order = np.lexsort((np.arange(frames.size), frames))
    ids = record_ids(tracks)
    counts: dict[int, int] = {}
    rows = []
    for place in order:
        image = int(frames[place]) + 1
        counts[image] = counts.get(image, 0) + 1
        rows.append(
            [
                image,
                counts[image],
                shown(tracks.x[place]),
                shown(tracks.y[place]),
                numbers[ids[place]],
            ]
        )
    header = [
        "ImageNumber",
        "ObjectNumber",
        "Location_Center_X",
        "Location_Center_Y",
        "TrackObjects_Label_50",
    ]
    return _lines([header, *rows])


def _trackmate_table(tracks: Tracks) -> str:
    source = tracks.source
    numbers = numbers_of(tracks)
    frames = _frames_or_ranks(tracks)
    length, time = source.length_units or "pixel", source.time_units or "frame"
    rows: list[list[Any]] = [
        [
            "LABEL",
            "ID",
            "TRACK_ID",
            "QUALITY",
            "POSITION_X",
            "POSITION_Y",
            "POSITION_Z",
            "POSITION_T",
            "FRAME",
        ],
        ["Label", "Spot ID", "Track ID", "Quality", "X", "Y", "Z", "T", "Frame"],
        ["Label", "Spot ID", "Track ID", "Quality", "X", "Y", "Z", "T", "Frame"],
        ["", "", "", "(quality)", f"({length})", f"({length})", f"({length})", f"({time})", ""],
    ]
    rows += [
        [f"ID{row}", row, numbers[name], 1, shown(x), shown(y), 0, shown(t), frame]
        for row, (name, x, y, t, frame) in enumerate(
            zip(record_ids(tracks), tracks.x, tracks.y, tracks.t, frames.tolist(), strict=True)
        )
    ]
    return _lines(rows)


def _trackmate(tracks: Tracks) -> str:
    spots = [
        {"x": x, "y": y, "t": t, "frame": frame, "text": ""}
        for x, y, t, frame in zip(
            tracks.x, tracks.y, tracks.t, _frames_or_ranks(tracks).tolist(), strict=True
        )
    ]
    numbers = numbers_of(tracks)
    links = {
        str(numbers[name]): list(range(int(first), int(last)))
        for name, first, last in zip(
            map(_named, tracks.ids), tracks.starts[:-1], tracks.starts[1:], strict=True
        )
    }
    return trackmate_model(spots, links, tracks.source.length_units, tracks.source.time_units)


def _frames_or_ranks(tracks: Tracks) -> np.ndarray:
    """Return frames where times are multiples of an interval, else their rank."""
    try:
        return frames_of(tracks.t)[0]
    except InputError:
        return np.unique(tracks.t, return_inverse=True)[1]


TEXT_FORMS: Final[dict[str, Callable[[Tracks], str]]] = {
    "trackmate": _trackmate,
    "trackmate table": _trackmate_table,
    "trackpy": _trackpy,
    "btrack": _btrack,
    "napari": _napari,
    "celltrackr": _celltrackr,
    "cellprofiler": _cellprofiler,
    "manual tracking": _manual_tracking,
}
