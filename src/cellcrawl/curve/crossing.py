"""Where a closed polygon crosses or touches itself.

The edges are grouped in short runs. A run whose edges all advance along one direction cannot meet
itself, and two runs whose bounding boxes are apart cannot meet each other; the few runs left are
tested edge by edge with exact orientations. On a smooth curve nearly all work is box comparisons.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from cellcrawl.curve.orientation import orientation
from cellcrawl.numerics.kernels import expanded_kernel, kernel

_RUN = 16
_NONE = -1


class Crossing(NamedTuple):
    """Two edges of a closed polygon that meet.

    Attributes
    ----------
    edges : tuple of int
        Indices of the edges; edge i joins node i to node i + 1.
    point : tuple of float
        Where they meet.
    places : tuple of float
        Position of the meeting point on each edge, in node numbers (edge 3, halfway: 3.5).
    """

    edges: tuple[int, int]
    point: tuple[float, float]
    places: tuple[float, float]


def first_crossing(points: np.ndarray) -> Crossing | None:
    """Return a pair of edges of the closed polygon that meet, None if it is simple.

    Parameters
    ----------
    points : array, shape (nodes, 2)
        Vertices in order, the first not repeated. Edges that touch count as crossing, so do
        neighbouring edges that fold back on each other, and a vertex given twice. The verdict is
        exact for these vertices; a smooth curve between them can differ by
        ``curvature * spacing**2 / 8``.
    """
    x = np.ascontiguousarray(points[:, 0])
    y = np.ascontiguousarray(points[:, 1])
    i, j = crossing_edges(x, y)
    if i == _NONE:
        return None
    return _meeting(points, i, j)


@kernel
def crossing_edges(x: np.ndarray, y: np.ndarray) -> tuple[int, int]:
    """Return the indices of two edges that meet, (-1, -1) if the closed polygon is simple."""
    nodes = x.size
    runs = (nodes + _RUN - 1) // _RUN
    box = np.empty((4, runs))
    for a in range(runs):
        low_x, high_x = np.inf, -np.inf
        low_y, high_y = np.inf, -np.inf
        for k in range(a * _RUN, min((a + 1) * _RUN, nodes) + 1):
            i = k if k < nodes else 0
            low_x, high_x = min(low_x, x[i]), max(high_x, x[i])
            low_y, high_y = min(low_y, y[i]), max(high_y, y[i])
        box[0, a], box[1, a], box[2, a], box[3, a] = low_x, high_x, low_y, high_y
    for a in range(runs):
        start, stop = a * _RUN, min((a + 1) * _RUN, nodes)
        if not _advances(x, y, start, stop):
            i, j = _meet(x, y, start, stop, start, stop)
            if i != _NONE:
                return i, j
        for b in range(a + 1, runs):
            if (
                box[0, a] > box[1, b]
                or box[0, b] > box[1, a]
                or box[2, a] > box[3, b]
                or box[2, b] > box[3, a]
            ):
                continue
            first, last = b * _RUN, min((b + 1) * _RUN, nodes)
            if b == a + 1 and runs > 2 and _advances(x, y, start, last):
                continue
            if a == 0 and b == runs - 1 and runs > 2 and _advances(x, y, first, nodes + stop):
                continue
            i, j = _meet(x, y, start, stop, first, last)
            if i != _NONE:
                return i, j
    return _NONE, _NONE


@kernel
def _advances(x: np.ndarray, y: np.ndarray, start: int, stop: int) -> bool:
    """Whether all edges start <= i < stop (past the end: wrapped) advance along their chord."""
    nodes = x.size
    a, b = start % nodes, stop % nodes
    chord_x, chord_y = x[b] - x[a], y[b] - y[a]
    chord = abs(chord_x) + abs(chord_y)
    for k in range(start, stop):
        i, j = k % nodes, (k + 1) % nodes
        edge_x, edge_y = x[j] - x[i], y[j] - y[i]
        advance = edge_x * chord_x + edge_y * chord_y
        if not advance > 1e-9 * chord * (abs(edge_x) + abs(edge_y)):
            return False
    return True


@kernel
def _meet(
    x: np.ndarray, y: np.ndarray, start: int, stop: int, first: int, last: int
) -> tuple[int, int]:
    """First pair of edges i in [start, stop), j in [first, last), i < j, that meet."""
    nodes = x.size
    for i in range(start, stop):
        i1 = i + 1 if i + 1 < nodes else 0
        for j in range(max(first, i + 1), last):
            j1 = j + 1 if j + 1 < nodes else 0
            if j == i1:
                met = _folds(x[i], y[i], x[j], y[j], x[j1], y[j1])
            elif j1 == i:
                met = _folds(x[j], y[j], x[i], y[i], x[i1], y[i1])
            else:
                met = _touch(x[i], y[i], x[i1], y[i1], x[j], y[j], x[j1], y[j1])
            if met:
                return i, j
    return _NONE, _NONE


@kernel
def _folds(ax: float, ay: float, bx: float, by: float, cx: float, cy: float) -> bool:
    """Whether edge b-c runs back over edge a-b."""
    ahead = (bx - ax) * (cx - bx) + (by - ay) * (cy - by)
    return ahead <= 0.0 and orientation(ax, ay, bx, by, cx, cy) == 0


@expanded_kernel
def _touch(
    ax: float, ay: float, bx: float, by: float, cx: float, cy: float, dx: float, dy: float
) -> bool:
    """Whether the closed segments a-b and c-d have a point in common."""
    if (
        max(ax, bx) < min(cx, dx)
        or max(cx, dx) < min(ax, bx)
        or max(ay, by) < min(cy, dy)
        or max(cy, dy) < min(ay, by)
    ):
        return False
    if orientation(ax, ay, bx, by, cx, cy) * orientation(ax, ay, bx, by, dx, dy) > 0:
        return False
    return orientation(cx, cy, dx, dy, ax, ay) * orientation(cx, cy, dx, dy, bx, by) <= 0


def _meeting(points: np.ndarray, i: int, j: int) -> Crossing:
    nodes = len(points)
    a, b = points[i], points[(i + 1) % nodes]
    c, d = points[j], points[(j + 1) % nodes]
    along, across = b - a, d - c
    area = along[0] * across[1] - along[1] * across[0]
    if area == 0.0:
        u, v = _overlap(along, c - a, d - a), _overlap(across, a - c, b - c)
    else:
        u = float(np.clip(((c - a)[0] * across[1] - (c - a)[1] * across[0]) / area, 0.0, 1.0))
        v = float(np.clip(((c - a)[0] * along[1] - (c - a)[1] * along[0]) / area, 0.0, 1.0))
    x, y = a + u * along
    return Crossing((i, j), (float(x), float(y)), (i + u, j + v))


def _overlap(along: np.ndarray, first: np.ndarray, second: np.ndarray) -> float:
    """Middle of the part of an edge that a parallel edge covers, as a fraction of the edge."""
    size = float(along @ along)
    if size == 0.0:
        return 0.0
    ends = np.clip([first @ along / size, second @ along / size], 0.0, 1.0)
    return float(ends.mean())
