"""The inside of curves in a box, as a path to fill."""

from __future__ import annotations

import numpy as np
from matplotlib.path import Path

Box = tuple[float, float, float, float]
"""Left, right, bottom, top."""


def region(curves: list[np.ndarray], box: Box, corner_inside: bool) -> Path | None:
    """Return the region that lies to the left of the curves, or None if it is empty.

    Parameters
    ----------
    curves : list of array, shape (vertices, 2)
        Branches that do not cross, closed (the last vertex is the first) or open with both ends on
        the border of the box.
    box : (left, right, bottom, top)
    corner_inside : bool
        Whether the lower left corner is in the region; it decides where no curve meets the border.
    """
    closed = [curve for curve in curves if np.array_equal(curve[0], curve[-1])]
    opened = [curve for curve in curves if not np.array_equal(curve[0], curve[-1])]
    loops = [*closed, *_joined(opened, box)]
    if not opened and corner_inside:
        loops.append(_corners(box)[[0, 1, 2, 3, 0]])
    if not loops:
        return None
    return Path.make_compound_path(*(Path(loop, closed=True) for loop in loops))


def _joined(curves: list[np.ndarray], box: Box) -> list[np.ndarray]:
    """Close open curves along the border of the box, counter-clockwise."""
    starts = np.array([_along_border(curve[0], box) for curve in curves])
    left = set(range(len(curves)))
    loops = []
    while left:
        first = at = min(left)
        pieces = []
        while True:
            left.discard(at)
            pieces.append(curves[at])
            end = _along_border(curves[at][-1], box)
            ahead = (starts - end) % 4.0
            at = int(np.argmin(ahead))
            passed = np.arange(np.floor(end) + 1.0, end + ahead[at])
            pieces.append(_corners(box)[passed.astype(int) % 4])
            if at not in left:
                break
        loops.append(np.concatenate([*pieces, curves[first][:1]]))
    return loops


def _corners(box: Box) -> np.ndarray:
    left, right, bottom, top = box
    return np.array([[left, bottom], [right, bottom], [right, top], [left, top]])


def _along_border(point: np.ndarray, box: Box) -> float:
    """Return how far along the border a point is: a side each unit, from the lower left corner."""
    left, right, bottom, top = box
    x = float((point[0] - left) / (right - left))
    y = float((point[1] - bottom) / (top - bottom))
    distances = {x + 0.0: abs(y), 1.0 + y: abs(1.0 - x), 3.0 - x: abs(1.0 - y), 4.0 - y: abs(x)}
    return min(distances, key=lambda place: distances[place]) % 4.0
