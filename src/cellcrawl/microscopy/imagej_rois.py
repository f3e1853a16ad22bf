"""Outlines from ImageJ regions of interest, single or zipped, by roifile."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from cellcrawl.errors import InputError
from cellcrawl.microscopy.extras import reader
from cellcrawl.microscopy.options import Reading
from cellcrawl.microscopy.outline_lists import Shape, outlines_of_shapes
from cellcrawl.microscopy.outlines import Outlines
from cellcrawl.microscopy.polygons import area_of
from cellcrawl.microscopy.source import LeftOut, Source

_CLOSED = ("POLYGON", "FREEHAND", "TRACED", "OVAL", "RECT")


def read_imagej_rois(path: Path, reading: Reading) -> Outlines:
    """Read the closed regions of an ImageJ ``.roi`` or ROI zip; lines and points are listed."""
    roifile = reader("roifile", "ImageJ regions of interest")
    try:
        read = roifile.roiread(path)
    except Exception as error:  # a damaged file shows itself in many ways
        raise InputError(f"{path} cannot be read as ImageJ regions: {error}") from None
    shapes: list[Shape] = []
    out: list[LeftOut] = []
    for number, roi in enumerate(read if isinstance(read, list) else [read], start=1):
        name = str(roi.name or number)
        kind = str(getattr(roi.roitype, "name", roi.roitype))
        if kind not in _CLOSED:
            out.append(LeftOut(name, f"a region of type {kind.lower()} encloses nothing", 1))
            continue
        rings = _rings(roi)
        changes = (f"largest of {len(rings)} paths",) if len(rings) > 1 else ()
        xy = max(rings, key=lambda ring: abs(area_of(ring)) if len(ring) > 2 else 0.0)
        shapes.append(Shape(xy, name, _frame(roi), changes))
    source = Source(str(path), "ImageJ regions of interest", {}, "pixel", "", True)
    return outlines_of_shapes(_distinct(shapes), source, reading, out)


def _rings(roi: Any) -> list[np.ndarray]:
    paths = roi.coordinates(multi=True)
    rings = [np.asarray(path, float) for path in (paths if isinstance(paths, list) else [paths])]
    return [ring for ring in rings if ring.ndim == 2 and len(ring) > 2] or [np.zeros((1, 2))]


def _frame(roi: Any) -> int:
    """Frame from 0: that of a hyperstack, else the place in the stack."""
    position = int(getattr(roi, "t_position", 0) or 0) or int(getattr(roi, "position", 0) or 0)
    return max(position - 1, 0)


def _distinct(shapes: list[Shape]) -> list[Shape]:
    """Names are free in ImageJ: regions that share one in a frame are told apart by a number."""
    seen: dict[tuple[str, int], int] = {}
    told = []
    for shape in shapes:
        again = seen.get((shape.track, shape.frame), 0)
        seen[shape.track, shape.frame] = again + 1
        told.append(shape._replace(track=f"{shape.track}-{again + 1}") if again else shape)
    return told
