"""Curves along which a function of two variables changes sign, as vertices on the curve itself.

Marching squares finds which edges of a grid a curve crosses and how the crossings join; where on
its edge each crossing is comes from the function, by bracketed root finding, so that the vertices
lie on the curve to rounding, whatever the grid.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from cellcrawl.numerics.bracketing import bracketed_roots

Field = Callable[[np.ndarray, np.ndarray], np.ndarray]


def level_curves(field: Field, x: np.ndarray, y: np.ndarray) -> list[np.ndarray]:
    """Curves in a box on which ``field`` passes from above 0 to 0 or below.

    Parameters
    ----------
    field : callable
        Of arrays of x and y to values.
    x, y : array
        Grid lines, increasing; the first and last bound the box. Loops that fit between grid lines
        are missed.

    Returns
    -------
    list of array, shape (vertices, 2)
        Each branch once, with values above 0 on its left. A closed branch ends with its first
        vertex; an open one begins and ends on the border of the box.
    """
    inside = np.broadcast_to(field(x[:, None], y[None, :]), (x.size, y.size)) > 0.0
    along_x = np.argwhere(inside[1:] != inside[:-1])  # edges (i, j) to (i + 1, j)
    along_y = np.argwhere(inside[:, 1:] != inside[:, :-1])  # edges (i, j) to (i, j + 1)
    edges = [(0, int(i), int(j)) for i, j in along_x] + [(1, int(i), int(j)) for i, j in along_y]
    if not edges:
        return []
    vertices = _crossings(field, x, y, along_x, along_y)
    number = {edge: index for index, edge in enumerate(edges)}
    following = {number[start]: number[end] for start, end in _segments(field, x, y, inside, edges)}
    return [curve for curve in (vertices[chain] for chain in _chains(following)) if len(curve) > 1]


def _crossings(
    field: Field, x: np.ndarray, y: np.ndarray, along_x: np.ndarray, along_y: np.ndarray
) -> np.ndarray:
    """Return where the curve crosses the edges, shape (edges, 2)."""
    i, j = along_x.T
    at_x = bracketed_roots(lambda at: field(at, y[j]), x[i], x[i + 1])
    m, n = along_y.T
    at_y = bracketed_roots(lambda at: field(x[m], at), y[n], y[n + 1])
    return np.concatenate([np.column_stack([at_x, y[j]]), np.column_stack([x[m], at_y])])


def _segments(
    field: Field,
    x: np.ndarray,
    y: np.ndarray,
    inside: np.ndarray,
    edges: list[tuple[int, int, int]],
) -> list[tuple[tuple[int, int, int], tuple[int, int, int]]]:
    """Return pairs of crossed edges joined within a cell, inside on the left."""
    cells = {(i, j) for _, i, j in edges}
    cells |= {(i, j - 1) for along, i, j in edges if along == 0}
    cells |= {(i - 1, j) for along, i, j in edges if along == 1}
    segments = []
    for i, j in sorted(cells):
        if not (0 <= i < x.size - 1 and 0 <= j < y.size - 1):
            continue
        corners = (inside[i, j], inside[i + 1, j], inside[i + 1, j + 1], inside[i, j + 1])
        sides = ((0, i, j), (1, i + 1, j), (0, i, j + 1), (1, i, j))  # counter-clockwise
        leaving = [s for s in range(4) if corners[s] and not corners[(s + 1) % 4]]
        entering = [s for s in range(4) if not corners[s] and corners[(s + 1) % 4]]
        step = -1
        if len(leaving) == 2:  # a saddle: the middle says which corners belong together
            middle = field(np.array(0.5 * (x[i] + x[i + 1])), np.array(0.5 * (y[j] + y[j + 1])))
            step = 1 if middle > 0.0 else -1
        for side in leaving:
            other = entering[0] if len(entering) == 1 else (side + step) % 4
            segments.append((sides[side], sides[other]))
    return segments


def _chains(following: dict[int, int]) -> list[list[int]]:
    """Return the branches as lists of vertices; a closed one repeats its first at the end."""
    reached = set(following.values())
    starts = [start for start in following if start not in reached]
    chains = []
    left = dict(following)
    while left:
        at = starts.pop() if starts else next(iter(left))
        chain = [at]
        while at in left:
            at = left.pop(at)
            chain.append(at)
        chains.append(chain)
    return chains
