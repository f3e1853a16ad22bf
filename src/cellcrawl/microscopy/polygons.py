"""Plain measures of closed polygons, with NumPy alone."""

from __future__ import annotations

import numpy as np


def area_of(xy: np.ndarray) -> float:
    """Signed area of a polygon, positive if it turns from x towards y."""
    x, y = (xy - xy.mean(axis=0)).T
    return float(0.5 * np.sum(x * np.roll(y, -1) - np.roll(x, -1) * y))


def centroid_of(xy: np.ndarray) -> np.ndarray:
    """Centroid of the area of a polygon, shape (2,); the mean vertex where it has no area."""
    origin = xy.mean(axis=0)
    x, y = (xy - origin).T
    cross = x * np.roll(y, -1) - np.roll(x, -1) * y
    twice = cross.sum()
    if abs(twice) <= 1e-12 * np.abs(cross).sum():
        return np.asarray(origin)
    return np.asarray(
        origin
        + np.array([((x + np.roll(x, -1)) * cross).sum(), ((y + np.roll(y, -1)) * cross).sum()])
        / (3.0 * twice)
    )


def without_repeats(xy: np.ndarray) -> np.ndarray:
    """Return the vertices without those equal to the next, the closing one included."""
    return xy[np.any(xy != np.roll(xy, -1, axis=0), axis=1)] if len(xy) > 1 else xy


def equally_spaced(xy: np.ndarray, nodes: int) -> np.ndarray:
    """Return ``nodes`` points along a polygon, equally spaced, turning from x towards y."""
    if area_of(xy) < 0.0:
        xy = np.concatenate([xy[:1], xy[:0:-1]])
    corners = np.append(xy, xy[:1], axis=0)
    at = np.append(0.0, np.cumsum(np.hypot(*np.diff(corners, axis=0).T)))
    along = at[-1] * np.arange(nodes) / nodes
    return np.column_stack([np.interp(along, at, corners[:, axis]) for axis in (0, 1)])
