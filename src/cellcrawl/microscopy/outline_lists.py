"""Outlines written as plain lists of points: cellpose's text, GeoJSON and Celltool contours."""

from __future__ import annotations

import json
import re
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from cellcrawl.errors import InputError
from cellcrawl.microscopy.options import Reading
from cellcrawl.microscopy.outlines import Outline, Outlines
from cellcrawl.microscopy.polygons import area_of, without_repeats
from cellcrawl.microscopy.source import LeftOut, Source
from cellcrawl.microscopy.tables import decoded

_NUMBER = r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?"
_PAIR = re.compile(rf"\[\s*({_NUMBER})\s*,\s*({_NUMBER})\s*\]")
_TRACK_NAMES = ("track", "track_id", "TRACK_ID", "trackid", "id", "label", "name", "cell")
_FRAME_NAMES = ("frame", "Frame", "FRAME", "t", "time", "slice")


class Shape(NamedTuple):
    """One outline as it stands in a file, before units."""

    xy: np.ndarray
    track: str
    frame: int
    changes: tuple[str, ...] = ()


def outlines_of_shapes(
    shapes: Sequence[Shape], source: Source, reading: Reading, left_out: Sequence[LeftOut] = ()
) -> Outlines:
    """Return outlines in the caller's units, those that are no polygons left out and listed."""
    frames = np.array([shape.frame for shape in shapes], float)
    source, times = reading.timed(source, frames)
    source, _, _ = reading.scaled(source, np.empty(0), np.empty(0))
    size = reading.pixel_size or 1.0
    found: list[Outline] = []
    out = list(left_out)
    seen: set[tuple[str, int]] = set()
    for shape, t in zip(shapes, times, strict=True):
        place = f"{shape.track} in frame {shape.frame}"
        xy = without_repeats(np.asarray(shape.xy, float))
        if not np.all(np.isfinite(xy)):
            out.append(LeftOut(place, "a coordinate is no number", len(xy)))
        elif len(xy) < 3 or area_of(xy) == 0.0:
            out.append(LeftOut(place, "fewer than 3 corners, or no area", len(xy)))
        elif (shape.track, shape.frame) in seen:
            out.append(LeftOut(place, "a second outline of that cell in that frame", len(xy)))
        else:
            seen.add((shape.track, shape.frame))
            found.append(
                Outline(
                    size * xy,
                    shape.track,
                    shape.frame,
                    float(t),
                    source.length_units,
                    source.time_units,
                    source.y_down,
                    shape.changes,
                    source,
                )
            )
    if not found:
        why = f": {out[0]}" if out else ""
        raise InputError(f"{source.path} holds no outline that can be used{why}")
    return Outlines(found, source, tuple(out))


def read_cellpose_text(path: Path, reading: Reading) -> Outlines:
    """Read cellpose's ``*_cp_outlines.txt``: a cell a line, x and y in turn."""
    shapes, out = [], []
    for number, line in enumerate(decoded(path.read_bytes()).splitlines(), start=1):
        cells = [cell for cell in line.strip().split(",") if cell.strip()]
        if not cells:
            continue
        try:
            values = np.array(cells, float)
        except ValueError:
            values = np.empty(1)
        if values.size % 2:
            out.append(LeftOut(f"line {number}", "it is no list of x and y in turn", 1))
            continue
        shapes.append(Shape(values.reshape(-1, 2), str(number), 0))
    note = "points are centres of the pixels along the edge, half a pixel inside it"
    source = Source(str(path), "cellpose outlines", {}, "pixel", "", True, (note,))
    return outlines_of_shapes(shapes, source, reading, out)


def read_celltool(path: Path, reading: Reading) -> Outlines:
    """Read the points of a Celltool contour as text; nothing in it is ever executed."""
    text = decoded(path.read_bytes())
    begin = re.search(r"^points\s*=", text, re.MULTILINE)
    if begin is None:
        raise InputError(f"{path} is a Celltool file without points")
    following = re.search(r"^\w+\s*=", text[begin.end() :], re.MULTILINE)
    end = begin.end() + following.start() if following else len(text)
    points = np.array(_PAIR.findall(text[begin.end() : end]), float).reshape(-1, 2)
    unit = re.search(r"^units\s*=[\\\s]*u?['\"]([^'\"]*)['\"]", text, re.MULTILINE)
    units = {"": "pixel", "px": "pixel", "pixels": "pixel"}
    name = unit[1] if unit else ""
    source = Source(str(path), "Celltool contour", {}, units.get(name, name), "", True)
    return outlines_of_shapes([Shape(points, path.stem, 0)], source, reading)


def read_geojson(path: Path, reading: Reading) -> Outlines:
    """Read GeoJSON polygons: of each feature the outer ring of the largest polygon."""
    try:
        content = json.loads(decoded(path.read_bytes()))
    except ValueError as error:
        raise InputError(
            f"{path} is not whole: its JSON breaks off or is wrong ({error})"
        ) from None
    shapes, out = [], []
    for number, feature in enumerate(_features(content), start=1):
        name, frame = _name_and_frame(feature, number)
        geometry = feature.get("geometry", feature) or {}
        try:
            rings, changes = _rings_of(geometry)
        except (TypeError, ValueError, IndexError):
            rings, changes = [], ()
        if not rings:
            kind = geometry.get("type", "nothing") if isinstance(geometry, dict) else "nothing"
            out.append(LeftOut(name, f"{kind} is no polygon", 1))
            continue
        shapes.append(Shape(max(rings, key=lambda ring: abs(area_of(ring))), name, frame, changes))
    source = Source(str(path), "GeoJSON polygons", {}, "pixel", "", True)
    return outlines_of_shapes(_distinct(shapes), source, reading, out)


def _features(content: Any) -> Iterator[dict[str, Any]]:
    if isinstance(content, list):
        for item in content:
            yield from _features(item)
    elif isinstance(content, dict):
        if content.get("type") == "FeatureCollection":
            yield from _features(content.get("features", []))
        elif content.get("type") == "GeometryCollection":
            yield from _features(content.get("geometries", []))
        else:
            yield content


def _name_and_frame(feature: dict[str, Any], number: int) -> tuple[str, int]:
    told = feature.get("properties") or {}
    geometry = feature.get("geometry") or {}
    plane = geometry.get("plane") if isinstance(geometry, dict) else None
    frame = next((told[name] for name in _FRAME_NAMES if name in told), None)
    if frame is None:
        frame = (plane or {}).get("t", 0)
    name = next((told[key] for key in _TRACK_NAMES if told.get(key) is not None), None)
    if name is None:
        name = number
    try:
        return str(name), int(float(frame))
    except (TypeError, ValueError):
        return str(name), 0


def _rings_of(geometry: dict[str, Any]) -> tuple[list[np.ndarray], tuple[str, ...]]:
    kind, coordinates = geometry.get("type"), geometry.get("coordinates") or []
    if kind == "Polygon":
        polygons: list[Any] = [coordinates]
    elif kind == "MultiPolygon":
        polygons = list(coordinates)
    else:
        return [], ()
    rings: list[np.ndarray] = [
        np.array([point[:2] for point in polygon[0]], dtype=float) for polygon in polygons
    ]
    changes = []
    if len(rings) > 1:
        changes.append(f"largest of {len(rings)} pieces")
    if any(len(polygon) > 1 for polygon in polygons):
        changes.append("holes filled")
    return [without_repeats(ring) for ring in rings if len(ring) > 3], tuple(changes)


def _distinct(shapes: list[Shape]) -> list[Shape]:
    """Number features that share a name in one frame: a class such as "Cell" is no cell's id."""
    places = [(shape.track, shape.frame) for shape in shapes]
    if len(set(places)) == len(places):
        return shapes
    return [shape._replace(track=str(number)) for number, shape in enumerate(shapes, start=1)]
