"""The outlines of a cell over time as an edge like that of a run: what all observables take."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import xarray as xr

from cellcrawl.arguments import checked
from cellcrawl.errors import InputError
from cellcrawl.microscopy.outlines import Outline, Outlines
from cellcrawl.microscopy.polygons import area_of, centroid_of, equally_spaced
from cellcrawl.validation import listed, real_array, real_number, whole_number

NODES = 128
_FINE = 512
_TOLERANCE = 0.26  # of a pixel: the error of an outline that follows pixels
_ORDER = 3  # of the smoothing spline
_HALVINGS = 14
_ROUNDS = 2  # in which bends are found, and the smoothing is fitted to them
_STRAIGHT = 0.8  # of the mean curvature: straighter parts are smoothed as if they bent so much
_FEWEST_STRAIGHT, _STRAIGHT_PART = 4, 0.1  # sides along an axis that tell of pixels
_STAIRCASE = 0.9  # part of the sides that follow the axes where an outline goes round pixels
_FEWEST_PIXELS, _MOST_PIXELS = 24, 100_000


@checked
def edge_series(
    outlines: Any, t: Any = None, *, tolerance: float | None = None, nodes: int = NODES
) -> xr.Dataset:
    """Return the outlines of one cell as a Dataset like a run's.

    Parameters
    ----------
    outlines : Outlines, or sequence of array_like, shape (points, 2)
        Outlines of one cell in the order of time; of several, give ``outlines.of_track(id)``.
    t : array_like, shape (time,), optional
        Their times, rising; those of the outlines, or 0, 1, 2, ... unless given.
    tolerance : float, optional
        How far, root mean square, smoothing may move the outline; 0 leaves it as it is. Unless
        given 0.26 of a pixel (of the median side where there are none): the error of what follows
        pixels.
    nodes : int
        Nodes along the edge.

    Returns
    -------
    Dataset, dims (time, node)
        ``x``, ``y``, ``theta``, ``curvature`` and ``normal_velocity`` at nodes that are equally
        spaced in arclength; ``length``, ``area``, ``centroid_x``, ``centroid_y`` and
        ``smoothing_length`` over time; named as in a run, so that circularity, aspect ratio,
        kymographs, front and asymmetry work on both. In the units of the outlines.
        ``attrs["tolerance"]`` is the smoothing in those units.

    Raises
    ------
    InputError
        For outlines of several cells, none at all, times that do not rise or are not as many, or
        an outline without an area.

    Notes
    -----
    *Smoothing.* The staircase of pixels makes the edge too long, by up to 4/pi, and its curvature
    meaningless. An outline that goes round pixels is taken through the middles of their sides; the
    outline is then smoothed by a spline (of third order, which damps a wavelength ``w`` to half
    where ``w`` is the ``smoothing_length``), as much as the tolerance allows and no more; it keeps
    the area of the polygon it was read from. The spline runs along the edge at a rate of the square
    root of the curvature, so that a sharp bend is smoothed over a shorter length than a flat side;
    ``smoothing_length`` is the mean. On rasterised circles and ellipses of 40 pixels, up to an
    aspect ratio of 2, the length is right to 1 percent and the curvature to 10 (root mean square,
    over the mean). Features smaller than the smoothing length, filopodia among them, are lost to
    the curvature.

    *Origin.* Node 0 is tracked: from frame to frame nodes are paired so that the sum of squared
    distances between pairs is least, for a shift along the edge. A cell that only moves keeps its
    nodes; one that turns, or grows at one end, carries them along as far as its shape tells.

    *Normal velocity.* Of paired nodes, by central differences, along the outward normal; one-sided
    at the ends and NaN for a single outline. Motion of half a node spacing along the edge is not
    seen, nor any that the shape does not show.
    """
    shapes, given, attributes = _shapes(outlines)
    whole_number("nodes", nodes, 8)
    times = real_array("t", given if t is None else t, (len(shapes),))
    if np.any(np.diff(times) <= 0.0):
        raise InputError("t must rise: give the outlines in the order of time")
    if tolerance is not None:
        real_number("tolerance", tolerance, 0.0, np.inf)
    moved = [_side(shape) * _TOLERANCE if tolerance is None else tolerance for shape in shapes]
    edges, lengths, widths = zip(
        *(_smoothed(shape, far, nodes) for shape, far in zip(shapes, moved, strict=True)),
        strict=True,
    )
    paired = _paired(np.array(edges))
    attributes["tolerance"] = float(np.median(moved))
    areas = np.array([abs(area_of(shape)) for shape in shapes])
    return _dataset(times, paired, np.array(lengths), areas, np.array(widths), attributes)


def _shapes(outlines: Any) -> tuple[list[np.ndarray], np.ndarray, dict[str, Any]]:
    """Return polygons, times and units of what was given."""
    attributes = {"kind": "outlines", "length_units": "", "time_units": "", "y_down": 0}
    if isinstance(outlines, Outline):
        outlines = Outlines([outlines], outlines.source)
    if isinstance(outlines, Outlines):
        if len(outlines.track_ids) > 1:
            raise InputError(
                f"these are outlines of {len(outlines.track_ids)} cells: "
                "give those of one, outlines.of_track(id)"
            )
        attributes["length_units"] = outlines.source.length_units
        attributes["time_units"] = outlines.source.time_units
        attributes["y_down"] = int(outlines.source.y_down)
        attributes["track"] = outlines.track_ids[0] if outlines.track_ids else ""
        polygons = [outline.xy for outline in outlines]
        times = np.array([outline.t for outline in outlines])
    else:
        polygons = listed("outlines", outlines, "a sequence of arrays of shape (points, 2)")
        times = np.arange(len(polygons), dtype=float)
    if not polygons:
        raise InputError("there are no outlines")
    shapes = [real_array(f"outline {i}", polygon, (None, 2)) for i, polygon in enumerate(polygons)]
    for i, shape in enumerate(shapes):
        if shape.shape[0] < 3 or area_of(shape) == 0.0:
            raise InputError(f"outline {i} encloses no area: give at least three corners")
    return shapes, times, attributes


def _side(shape: np.ndarray) -> float:
    """Return the size of a pixel for an outline that follows pixels, else that of its sides.

    Sides that run along an axis to the last bit are those of pixels, and the shortest is one long;
    what an image program drew through the middles of pixels, or between them, has some as well.
    """
    sides = np.roll(shape, -1, axis=0) - shape
    lengths = np.hypot(*sides.T)
    along = lengths[(lengths > 0.0) & (sides == 0.0).any(axis=1)]
    if along.size >= max(_FEWEST_STRAIGHT, _STRAIGHT_PART * lengths.size):
        return float(along.min())
    return float(np.median(lengths[lengths > 0.0]))


def _smoothed(shape: np.ndarray, tolerance: float, nodes: int) -> tuple[np.ndarray, float, float]:
    """Return nodes (node,) in the complex plane, the length and the smoothing length."""
    fine = max(_FINE, 4 * nodes)
    given = _complex(equally_spaced(_between_pixels(shape), fine))
    edge, width = _filtered(given, tolerance)
    for _ in range(_ROUNDS if width > 0.0 else 0):
        given = _resampled(given, _by_bends(edge))
        edge, width = _filtered(given, tolerance)
    area = 0.5 * float(np.sum((np.conj(edge) * np.roll(edge, -1)).imag))
    middle = edge.mean()
    edge = middle + (edge - middle) * np.sqrt(abs(area_of(shape)) / area)
    corners = np.column_stack([edge.real, edge.imag])
    length = float(np.sum(np.abs(np.roll(edge, -1) - edge)))
    return _complex(equally_spaced(corners, nodes)), length, width


def _filtered(edge: np.ndarray, tolerance: float) -> tuple[np.ndarray, float]:
    """Smooth nodes (node,) as far as the tolerance allows, and return over which wavelength."""
    fine = edge.size
    number = np.abs(np.fft.fftfreq(fine, 1.0 / fine))
    spectrum = np.fft.fft(edge)
    power = np.abs(spectrum) ** 2
    length = float(np.sum(np.abs(np.roll(edge, -1) - edge)))

    def moves(part: float) -> float:
        return float(np.sqrt(np.sum((1.0 - _kept(number, part)) ** 2 * power))) / fine

    low, high = 1.0 / fine, 1.0
    if moves(low) > tolerance:
        return edge, 0.0
    for _ in range(_HALVINGS):
        middle = math.sqrt(low * high)
        low, high = (middle, high) if moves(middle) <= tolerance else (low, middle)
    return np.fft.ifft(spectrum * _kept(number, low)), low * length


def _by_bends(edge: np.ndarray) -> np.ndarray:
    """Return a length (node + 1,) along a smooth edge, from 0 to 1, that runs faster in bends.

    In arclength a spline cannot be smooth on the sides of an ellipse and true at its tips.
    """
    slope, bend = _derivatives(edge)
    speed = np.abs(slope)
    curvature = (np.conj(slope) * bend).imag / speed**3 * speed.mean() / (2.0 * np.pi)
    rate = speed * np.sqrt(np.hypot(curvature, _STRAIGHT))
    gone = np.concatenate([[0.0], np.cumsum(rate + np.roll(rate, -1))])
    whole: np.ndarray = gone / gone[-1]
    return whole


def _resampled(edge: np.ndarray, along: np.ndarray) -> np.ndarray:
    """Return as many nodes, evenly spaced in what runs along the edge (node + 1,) from 0 to 1."""
    place = np.interp(np.arange(edge.size) / edge.size, along, np.arange(edge.size + 1.0))
    nodes: np.ndarray = np.interp(place, np.arange(edge.size + 1.0), np.append(edge, edge[0]))
    return nodes


def _derivatives(edges: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return first and second derivatives of edges (..., node) by the part of the way round."""
    nodes = edges.shape[-1]
    number = np.fft.fftfreq(nodes, 1.0 / nodes)
    number[nodes // 2] = 0.0  # the highest one of an even number of nodes has no slope
    spectrum = np.fft.fft(edges)
    slope = np.fft.ifft(2j * np.pi * number * spectrum)
    return slope, np.fft.ifft(-((2.0 * np.pi * number) ** 2) * spectrum)


def _between_pixels(shape: np.ndarray) -> np.ndarray:
    """Return the middles of the sides of an outline that goes round pixels, others as they are."""
    sides = np.roll(shape, -1, axis=0) - shape
    lengths = np.abs(sides).sum(axis=1)
    straight = (sides == 0.0).any(axis=1)
    if np.mean(straight) < _STAIRCASE:
        return shape
    pixel = float(lengths[lengths > 0.0].min())
    parts = np.round(lengths / pixel).astype(int)
    if not _FEWEST_PIXELS <= parts.sum() <= _MOST_PIXELS:
        return shape
    starts = np.repeat(shape, parts, axis=0)
    steps = np.repeat(sides / np.maximum(parts, 1)[:, None], parts, axis=0)
    first = np.repeat(np.cumsum(parts) - parts, parts)
    number = np.arange(parts.sum()) - first
    middles: np.ndarray = starts + steps * (number + 0.5)[:, None]
    return middles


def _kept(number: np.ndarray, width: float) -> np.ndarray:
    """Return by how much each wavenumber is damped: half at a wavelength of ``width``."""
    kept: np.ndarray = 1.0 / (1.0 + (number * width) ** (2 * _ORDER))
    return kept


def _complex(xy: np.ndarray) -> np.ndarray:
    joined: np.ndarray = xy[:, 0] + 1j * xy[:, 1]
    return joined


def _paired(edges: np.ndarray) -> np.ndarray:
    """Shift the nodes of each edge (time, node) to lie nearest to those of the one before."""
    nodes = edges.shape[1]
    number = np.fft.fftfreq(nodes, 1.0 / nodes)
    for i in range(1, edges.shape[0]):
        before, now = np.fft.fft(edges[i - 1]), np.fft.fft(edges[i])
        nearness = np.fft.ifft(np.conj(before) * now).real
        best = int(np.argmax(nearness))
        low, top, high = (nearness[(best + k) % nodes] for k in (-1, 0, 1))
        bend = low - 2.0 * top + high
        shift = best + (0.5 * (low - high) / bend if bend < 0.0 else 0.0)
        edges[i] = np.fft.ifft(now * np.exp(2j * np.pi * number * shift / nodes))
    return edges


def _dataset(
    times: np.ndarray,
    edges: np.ndarray,
    lengths: np.ndarray,
    areas: np.ndarray,
    widths: np.ndarray,
    attributes: dict[str, Any],
) -> xr.Dataset:
    slope, bend = _derivatives(edges)
    curvature = (np.conj(slope) * bend).imag / np.abs(slope) ** 3
    normal = -1j * slope / np.abs(slope)  # outward, for an edge that turns from x towards y
    velocity = np.full(edges.shape, np.nan)
    if times.size > 1:
        velocity = (np.gradient(edges, times, axis=0) * np.conj(normal)).real
    centroids = np.array([_centroid(edge) for edge in edges])
    length, time = attributes["length_units"], attributes["time_units"]
    on_edge = {
        "x": (edges.real, "position of the edge, x", length),
        "y": (edges.imag, "position of the edge, y", length),
        "theta": (np.unwrap(np.angle(slope), axis=1), "tangent angle", "rad"),
        "curvature": (curvature, "curvature of the edge", f"1/{length}" if length else ""),
        "normal_velocity": (
            velocity,
            "outward normal velocity of the edge",
            f"{length}/{time}" if length and time else "",
        ),
    }
    whole = {
        "length": (lengths, "length of the edge", length),
        "area": (areas, "enclosed area", f"{length}^2" if length else ""),
        "centroid_x": (centroids.real, "centroid of the area, x", length),
        "centroid_y": (centroids.imag, "centroid of the area, y", length),
        "smoothing_length": (widths, "wavelength that smoothing halves", length),
    }
    variables = {
        name: (dims, values, {"long_name": words, "units": units})
        for dims, table in ((("time", "node"), on_edge), (("time",), whole))
        for name, (values, words, units) in table.items()
    }
    when = ("time", times, {"long_name": "time", "units": time})
    return xr.Dataset(variables, {"time": when}, attributes)


def _centroid(edge: np.ndarray) -> complex:
    x, y = centroid_of(np.column_stack([edge.real, edge.imag]))
    return complex(x, y)
