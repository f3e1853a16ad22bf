"""Outlines made such that the model can hold them: fibres taken off, and what was done said."""

from __future__ import annotations

import math

import numpy as np

from cellcrawl.curve import Curve, from_polygon, polygon_area, simple_polygon
from cellcrawl.errors import InputError
from cellcrawl.microscopy.label_images import pieces
from cellcrawl.microscopy.raster import opened, rasterised

_PIXELS_ACROSS = 160.0  # pixels along the side of a square of the cell's area
_LARGEST_GRID = 1500  # pixels along the longer side of the grid
_RADII = (0.0, 0.03, 0.05, 0.08, 0.12, 0.17, 0.23, 0.3)  # of the disk, over the cell's radius
_LEAST_KEPT = 0.8  # share of the area below which it is another shape


def held_polygon(
    xy: np.ndarray, nodes: int, smoothing: float
) -> tuple[np.ndarray, Curve, tuple[str, ...]]:
    """Return a polygon that the model can hold, its curve, and what was changed.

    Parameters
    ----------
    xy : ndarray, shape (vertices, 2)
        A closed polygon, as it was given.
    nodes : int
        Nodes of the curve.
    smoothing : float
        As in `cellcrawl.curve.from_polygon`.

    Raises
    ------
    InputError
        The complaint about the outline as it was given, if no small change mends it.

    Notes
    -----
    An outline that is simple, and whose smooth curve is, stays as it is. Else it is opened by disks
    of growing radius: what no disk fits into, such as a retraction fibre, is taken off. A fibre
    without width, walked there and back, goes with the smallest. An outline that would lose more
    than a fifth of its area is refused.
    """
    try:
        return xy, from_polygon(xy, nodes, smoothing), ()
    except InputError as error:
        complaint = error
    if len(xy) < 3 or not np.ptp(xy, axis=0).min() > 0.0:
        raise complaint
    for radius in _RADII:
        body = _opened_polygon(xy, radius)
        if body is None:
            break
        try:
            simple_polygon(body)
            curve = from_polygon(body, nodes, smoothing)
        except InputError:
            continue
        return body, curve, (_told(xy, body, radius, complaint),)
    raise complaint


def _opened_polygon(xy: np.ndarray, radius: float) -> np.ndarray | None:
    """Return the largest piece after an opening; None if it is another shape then."""
    low, size = xy.min(axis=0), np.ptp(xy, axis=0)
    pixel = max(math.sqrt(_area(xy, low, size)) / _PIXELS_ACROSS, size.max() / _LARGEST_GRID)
    shape = (int(size[1] / pixel) + 5, int(size[0] / pixel) + 5)
    # Half a pixel aside, so that whole coordinates never lie on the centres of pixels.
    mask = rasterised((xy - low) / pixel + 2.37, shape)
    whole = int(mask.sum())
    if radius > 0.0:
        mask = opened(mask, radius * math.sqrt(whole / math.pi))
    found = list(pieces(mask.astype(np.uint8)))
    if not found or found[0].pixels < _LEAST_KEPT * whole:
        return None
    return np.asarray((found[0].xy - 2.37) * pixel + low)


def _area(xy: np.ndarray, low: np.ndarray, size: np.ndarray) -> float:
    """Area enclosed by the even-odd rule, roughly; that of the box over 100 at the least."""
    pixel = float(size.max()) / 300.0
    shape = (int(size[1] / pixel) + 3, int(size[0] / pixel) + 3)
    pixels = int(rasterised((xy - low) / pixel + 1.37, shape).sum())
    return max(pixels * pixel**2, float(size.prod()) / 100.0)


def _told(xy: np.ndarray, body: np.ndarray, radius: float, complaint: InputError) -> str:
    before, after = abs(polygon_area(xy)), abs(polygon_area(body))
    longer = _length(xy) / _length(body)
    how = "what encloses nothing was taken off"
    if radius > 0.0:
        how = f"opened with a disk of {100.0 * radius:.0f} % of the cell's radius"
    return (
        f"{how}: the area went from {before:.4g} to {after:.4g}, the outline was "
        f"{longer:.2f} times as long ({complaint})"
    )


def _length(xy: np.ndarray) -> float:
    return float(np.hypot(*(np.roll(xy, -1, axis=0) - xy).T).sum())
