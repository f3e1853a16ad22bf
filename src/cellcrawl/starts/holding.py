"""Outlines made such that the model can hold them: fibres taken off, and what was done said."""

from __future__ import annotations

import math

import numpy as np

from cellcrawl.curve import Curve, SelfCrossing, from_polygon, polygon_area, simple_polygon
from cellcrawl.errors import InputError

_PIXELS_ACROSS = 160.0  # pixels along the side of a square of the cell's area
_LARGEST_GRID = 1500  # pixels along the longer side of the grid
_SHARPEST = 16.0  # curvature times radius: sharper bends leave the model within a time of 1
_FIBRES = (0.03, 0.06, 0.12)  # radii of disks that do not fit into fibres, over the cell's
_REACH = 3.0  # radii of the disk that a fibre reaches further than the rest of the cell
_ASIDE = 2.37  # pixels of margin
_LEAST_SMOOTHING = 0.01  # of a polygon that was drawn on a grid
_RADII = (0.03, 0.05, 0.08, 0.12, 0.17, 0.23, 0.3)  # of the disk, over the cell's radius
_LEAST_KEPT = 0.8  # share of the area below which it is another shape


def held_polygon(xy: np.ndarray, nodes: int, smoothing: float) -> tuple[Curve, tuple[str, ...]]:
    """Return the curve of a polygon that the model can hold, and what was changed for it.

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
    An outline that is simple, and whose smooth curve is, stays as it is unless it has fibres: bends
    sharper than a sixteenth of the cell's radius, and a part too thin for a small disk that reaches
    further than a corner would. Such an outline is opened by disks of growing radius until its
    bends are wider: what no disk fits into is taken off. One that would lose more than a fifth of
    its area, such as a figure of eight, is refused.
    """
    complaint: InputError | None = None
    whole: Curve | None = None
    try:
        whole = from_polygon(xy, nodes, smoothing)
        if _sharpest_bend(whole) <= _SHARPEST or not _has_fibres(xy):
            return whole, ()
    except SelfCrossing as error:
        complaint = error
    except InputError:
        simple_polygon(xy)  # raises for what is no outline at all
        raise
    rounded = max(smoothing, _LEAST_SMOOTHING)
    usable: tuple[Curve, tuple[str, ...]] | None = None
    for radius in _RADII:
        body = _opened_polygon(xy, radius)
        if body is None:
            break
        try:
            curve = from_polygon(body, nodes, rounded)
        except InputError:
            continue
        found = curve, (_told(xy, body, radius, smoothing, rounded, complaint),)
        if _sharpest_bend(curve) <= _SHARPEST:
            return found
        usable = usable or found
    if usable is not None and complaint is not None:
        return usable
    if whole is not None:
        return whole, ()
    raise complaint or InputError("the outline cannot be held")


def _sharpest_bend(curve: Curve) -> float:
    """Largest curvature, of either sign, times the cell's radius."""
    return float(np.abs(curve.curvature).max()) * math.sqrt(curve.area / math.pi)


def _has_fibres(xy: np.ndarray) -> bool:
    """Whether a part that some disk does not fit into reaches further than a corner would.

    The tip of a corner of angle a lies (1 / sin(a / 2) - 1) radii from the disk that fits into it:
    three radii are a corner of 29 degrees.
    """
    from cellcrawl.microscopy.raster import opened, widened

    mask, _, _ = _drawn(xy)
    size = math.sqrt(float(mask.sum()) / math.pi)
    for radius in _FIBRES:
        body = opened(mask, radius * size)
        if body.any() and np.any(mask & ~widened(body, _REACH * radius * size)):
            return True
    return False


def _drawn(xy: np.ndarray) -> tuple[np.ndarray, float, np.ndarray]:
    """Return the polygon on a grid, the size of a pixel, and where the grid begins."""
    # Only outlines that need it pay for the import of readers and what they lean on.
    from cellcrawl.microscopy.raster import rasterised

    low, size = xy.min(axis=0), np.ptp(xy, axis=0)
    pixel = max(math.sqrt(_area(xy, low, size)) / _PIXELS_ACROSS, size.max() / _LARGEST_GRID)
    shape = (int(size[1] / pixel) + 5, int(size[0] / pixel) + 5)
    # A third of a pixel aside, so that whole coordinates never lie on the centres of pixels.
    return rasterised((xy - low) / pixel + _ASIDE, shape), pixel, low


def _opened_polygon(xy: np.ndarray, radius: float) -> np.ndarray | None:
    """Return the largest piece after an opening; None if it is another shape then."""
    from cellcrawl.microscopy.label_images import pieces
    from cellcrawl.microscopy.raster import opened

    mask, pixel, low = _drawn(xy)
    whole = int(mask.sum())
    body = opened(mask, radius * math.sqrt(whole / math.pi))
    found = list(pieces(body.astype(np.uint8)))
    if not found or found[0].pixels < _LEAST_KEPT * whole:
        return None
    return np.asarray((found[0].xy - _ASIDE) * pixel + low)


def _area(xy: np.ndarray, low: np.ndarray, size: np.ndarray) -> float:
    """Area enclosed by the even-odd rule, roughly; that of the box over 100 at the least."""
    from cellcrawl.microscopy.raster import rasterised

    pixel = float(size.max()) / 300.0
    shape = (int(size[1] / pixel) + 3, int(size[0] / pixel) + 3)
    pixels = int(rasterised((xy - low) / pixel + 1.37, shape).sum())
    return max(pixels * pixel**2, float(size.prod()) / 100.0)


def _told(
    xy: np.ndarray,
    body: np.ndarray,
    radius: float,
    smoothing: float,
    rounded: float,
    complaint: InputError | None,
) -> str:
    before, after = abs(polygon_area(xy)), abs(polygon_area(body))
    shorter = 100.0 * (1.0 - _length(body) / _length(xy))
    why = "it crosses or touches itself" if complaint is not None else "it has thin fibres"
    more = f", smoothing raised from {smoothing:g} to {rounded:g}" if rounded > smoothing else ""
    return (
        f"{why}: opened with a disk of {100.0 * radius:.0f} % of the cell's radius{more}; the area "
        f"went from {before:.4g} to {after:.4g} and the outline is {shorter:.0f} % shorter"
    )


def _length(xy: np.ndarray) -> float:
    return float(np.hypot(*(np.roll(xy, -1, axis=0) - xy).T).sum())
