"""Outlines from label TIFFs and folders of the Cell Tracking Challenge, by tifffile."""

from __future__ import annotations

import contextlib
import logging
import re
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from cellcrawl.errors import InputError
from cellcrawl.microscopy.columns import length_unit, time_unit
from cellcrawl.microscopy.extras import reader
from cellcrawl.microscopy.label_images import outlines_of_labels
from cellcrawl.microscopy.options import Reading
from cellcrawl.microscopy.outlines import Outlines
from cellcrawl.microscopy.source import LeftOut, Source
from cellcrawl.microscopy.track import Tracks

CTC_TABLES = ("res_track.txt", "man_track.txt")
_ARRAY_AXES = ("T", "Z", "Q", "I", "C", "S")


def read_label_tiff(path: Path, reading: Reading) -> Outlines:
    """Read a label TIFF: a frame a page, every cell its own number in all frames."""
    tifffile = reader("tifffile", "label TIFFs")
    try:
        with _complaints() as complaints, tifffile.TiffFile(path) as file:
            series = file.series[0]
            stack, axes = series.asarray(), series.axes
            size, length, interval, time = _scales(file)
    except Exception as error:  # a damaged file shows itself in many ways
        raise InputError(f"{path} cannot be read as a TIFF: {error}") from None
    frames = _as_frames(path, stack, axes)
    notes = []
    if complaints:
        notes.append(f"the file seems to be damaged, frames may be missing: {complaints[0]}")
    if reading.pixel_size is None and size is not None:
        reading = replace(reading, pixel_size=size, length_units=length)
        notes.append(f"pixel size {size:.6g} {length} from the file".rstrip())
    if reading.frame_interval is None and interval is not None:
        reading = replace(reading, frame_interval=interval, time_units=time)
        notes.append(f"frame interval {interval:.6g} {time} from the file".rstrip())
    if len(np.unique(frames[0])) == 2 and frames[0].max() in (1, 255):
        notes.append("all cells have one number: the largest piece of a frame counts as the cell")
    source = Source(str(path), "label TIFF", {}, "pixel", "", True, tuple(notes))
    return outlines_of_labels(list(frames), source, reading)


@contextlib.contextmanager
def _complaints() -> Iterator[list[str]]:
    """Gather what tifffile logs of a file that it reads as far as it can."""
    found: list[str] = []

    class Gather(logging.Handler):
        def emit(self, record: logging.LogRecord) -> None:
            found.append(" ".join(record.getMessage().split())[:120])

    log, handler = logging.getLogger("tifffile"), Gather(logging.WARNING)
    others, passed_on = log.handlers[:], log.propagate
    log.handlers, log.propagate = [handler], False
    try:
        yield found
    finally:
        log.handlers, log.propagate = others, passed_on


def read_cell_tracking_challenge(folder: Path, reading: Reading) -> tuple[Outlines, dict[str, str]]:
    """Read a result or truth folder of the Cell Tracking Challenge; and the parents of its cells.

    Labels are tracks: a cell that divides ends, and its daughters are tracks of their own.
    """
    tifffile = reader("tifffile", "folders of the Cell Tracking Challenge")
    table = next((folder / name for name in CTC_TABLES if (folder / name).is_file()), None)
    if table is None:
        raise InputError(f"{folder} holds no {' or '.join(CTC_TABLES)}")
    images = sorted(
        (path for path in folder.iterdir() if re.fullmatch(r".*\d+\.tiff?", path.name)),
        key=_number,
    )
    if not images:
        raise InputError(f"{folder} holds no masks (mask000.tif, man_track000.tif, ...)")
    try:
        rows = np.loadtxt(table, ndmin=2, dtype=np.int64)
        parents = {str(row[0]): str(row[3]) for row in rows if row[3] > 0}
    except (ValueError, IndexError):
        raise InputError(f"{table} is no table of L B E P, four whole numbers a row") from None
    found: list[Any] = []
    out: list[Any] = []
    source = Source(str(folder), "Cell Tracking Challenge folder", {}, "pixel", "", True)
    for path in images:
        try:
            frame = tifffile.imread(path)
        except Exception as error:  # a damaged file shows itself in many ways
            out.append(LeftOut(path.name, f"it cannot be read as a TIFF: {error}", 0))
            continue
        if frame.ndim != 2:
            raise InputError(f"{path} has shape {frame.shape}: only images of a plane are read")
        if not frame.any():
            continue
        one = outlines_of_labels([frame], replace(source, path=str(path)), reading, _number(path))
        found += list(one)
        out += one.left_out
        told = one.source
    if not found:
        raise InputError(f"{folder} has no labelled cells: all its pixels are 0")
    told = replace(told, path=str(folder), notes=())
    found.sort(key=lambda outline: (int(outline.track), outline.frame))
    return Outlines([replace(one, source=told) for one in found], told, tuple(out)), parents


def with_parents(tracks: Tracks, parents: dict[str, str]) -> Tracks:
    """Return tracks that know which one they came from."""
    known = {name: parent for name, parent in parents.items() if name in tracks.ids}
    return Tracks(
        tracks.t,
        tracks.x,
        tracks.y,
        tracks.starts,
        tracks.ids,
        tracks.source,
        tracks.left_out,
        known,
    )


def _number(path: Path) -> int:
    return int(re.findall(r"(\d+)\.tiff?$", path.name)[0])


def _as_frames(path: Path, stack: np.ndarray, axes: str) -> np.ndarray:
    """Return (frames, rows, columns), leaving out axes of length 1."""
    kept = [axis for axis, size in zip(axes, stack.shape, strict=True) if size > 1 or axis in "YX"]
    stack = stack.reshape([size for a, size in zip(axes, stack.shape, strict=True) if a in kept])
    if stack.ndim == 2:
        return stack[None]
    if stack.ndim != 3 or kept[-1] in ("S", "C"):
        raise InputError(
            f"{path} has axes {axes} of sizes {stack.shape}: give labels by frame, row and column"
        )
    return stack


def _scales(file: Any) -> tuple[float | None, str, float | None, str]:
    """Return the size of a pixel and the time between frames as the file gives them."""
    told = dict(file.imagej_metadata or {})
    page = file.pages[0]
    size: float | None = None
    length = ""
    resolution = page.tags.get("XResolution")
    if told and resolution is not None and resolution.value[0]:
        size = resolution.value[1] / resolution.value[0]
        length = length_unit(str(told.get("unit", "")).replace("\\u00B5", "µ"))
        if length in ("", "pixel") and size == 1.0:
            size = None
    interval = told.get("finterval")
    time = time_unit(str(told.get("tunit", "s"))) if interval else ""
    if file.is_ome and file.ome_metadata:
        sizes = re.search(r'PhysicalSizeX="([^"]+)"', file.ome_metadata)
        unit = re.search(r'PhysicalSizeXUnit="([^"]+)"', file.ome_metadata)
        step = re.search(r'TimeIncrement="([^"]+)"', file.ome_metadata)
        span = re.search(r'TimeIncrementUnit="([^"]+)"', file.ome_metadata)
        if sizes:
            size, length = float(sizes[1]), length_unit(unit[1] if unit else "µm")
        if step:
            interval, time = float(step[1]), time_unit(span[1] if span else "s")
    return size, length, float(interval) if interval else None, time
