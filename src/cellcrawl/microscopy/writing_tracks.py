"""Tracks written as the tables and files that tracking programs read."""

from __future__ import annotations

from os import PathLike
from pathlib import Path
from typing import Any, Final

import numpy as np
import xarray as xr

from cellcrawl.arguments import checked
from cellcrawl.errors import InputError, StorageError
from cellcrawl.microscopy.extras import reader
from cellcrawl.microscopy.source import Source
from cellcrawl.microscopy.track import Track, Tracks
from cellcrawl.microscopy.track_forms import (
    TEXT_FORMS,
    napari_rows,
    numbers_of,
    plain_table,
    record_ids,
    write_text,
)
from cellcrawl.validation import one_of

_GEFF_UNITS = {
    "µm": "micrometer",
    "nm": "nanometer",
    "mm": "millimeter",
    "pixel": "pixel",
    "s": "second",
    "min": "minute",
    "h": "hour",
    "ms": "millisecond",
    "d": "day",
    "frame": "frame",
}


@checked
def write_tracks(path: str | PathLike[str], tracks: Any, *, form: str | None = None) -> Path:
    """Write tracks, or the path of a run, in the form of a tracking program.

    Parameters
    ----------
    path : path-like
        The file; a folder for "geff".
    tracks : Tracks, iterable of Track, or a run
        Of a run the path of its centroid; as a table with its area, length and tension.
    form : str, optional
        One of `TRACK_FORMS`; by the suffix of ``path`` unless given: .xml TrackMate, .geff or
        .zarr GEFF, .npy a napari array, a plain table for all else.

    Returns
    -------
    Path
        Of the file.

    Raises
    ------
    InputError
        For a form that counts frames, and times that are no multiples of one interval.

    Notes
    -----
    Image programs have y downwards. Tracks with y upwards, such as those of a run, are mirrored
    (y becomes -y) in their forms, so that left and right stay those seen on the screen.
    """
    target = Path(path)
    by_suffix = {".xml": "trackmate", ".geff": "geff", ".zarr": "geff", ".npy": "napari array"}
    form = form or by_suffix.get(target.suffix.lower(), "table")
    one_of("form", form, TRACK_FORMS)
    extra: dict[str, np.ndarray] = {}
    if isinstance(tracks, xr.Dataset):
        tracks, extra = _of_run(tracks)
    whole = tracks if isinstance(tracks, Tracks) else Tracks.of(tracks)
    if not len(whole):
        raise InputError("there are no tracks to write")
    try:
        if form == "table":
            write_text(target, plain_table(whole, extra))
        elif form == "celltrackr":
            write_text(target, TEXT_FORMS[form](whole))
        elif form == "geff":
            _write_geff(target, _downwards(whole))
        elif form == "napari array":
            np.save(target, napari_rows(_downwards(whole)))
        else:
            write_text(target, TEXT_FORMS[form](_downwards(whole)))
    except OSError as error:
        raise StorageError(f"cannot write {target}: {error.strerror or error}") from None
    return target


def _of_run(run: xr.Dataset) -> tuple[Tracks, dict[str, np.ndarray]]:
    missing = [name for name in ("time", "centroid_x", "centroid_y") if name not in run]
    if missing:
        raise InputError(f"this dataset is no run: it has no {missing[0]}")
    t, x, y = (np.array(run[name].values, float) for name in ("time", "centroid_x", "centroid_y"))
    source = Source("", "run", {}, "R_0", "1/k_off0")
    extra = {name: run[name].values for name in ("area", "length", "tension") if name in run}
    return Tracks.of([Track(t, x, y, id="0")], source), extra


def _downwards(tracks: Tracks) -> Tracks:
    """Return tracks with y downwards, mirrored if it pointed up."""
    if tracks.source.y_down:
        return tracks
    mirrored = Tracks(
        tracks.t,
        tracks.x,
        -tracks.y,
        tracks.starts,
        tracks.ids,
        tracks.source,
        tracks.left_out,
        tracks.parents,
    )
    return mirrored.with_source(y_down=True)


def _write_geff(target: Path, tracks: Tracks) -> None:
    core, geff = reader("geff.core_io", "GEFF graphs"), reader("geff_spec", "GEFF graphs")
    source = tracks.source
    length = _GEFF_UNITS.get(source.length_units, source.length_units or None)
    time = _GEFF_UNITS.get(source.time_units, source.time_units or None)
    axes = [
        geff.Axis(name=name, type=kind, unit=unit)
        for name, kind, unit in (
            ("t", "time", time),
            ("y", "space", length),
            ("x", "space", length),
        )
    ]
    nodes = np.arange(tracks.t.size, dtype=np.uint64)
    first = set(tracks.starts.tolist())
    later = np.array([node for node in range(tracks.t.size) if node not in first], np.uint64)
    edges = np.column_stack([later - 1, later]).astype(np.uint64)
    numbers = numbers_of(tracks)
    values = {
        "t": tracks.t,
        "y": tracks.y,
        "x": tracks.x,
        "track_id": np.array([numbers[name] for name in record_ids(tracks)], np.int64),
    }
    properties = {
        name: {"values": np.asarray(value), "missing": None} for name, value in values.items()
    }
    metadata = geff.GeffMetadata(
        directed=True,
        axes=axes,
        track_node_props={"tracklet": "track_id"},
        node_props_metadata={},
        edge_props_metadata={},
    )
    core.write_arrays(target, nodes, properties, edges, {}, metadata, overwrite=True)


TRACK_FORMS: Final = ("table", "geff", "napari array", *TEXT_FORMS)
"""Forms in which `write_tracks` writes."""
