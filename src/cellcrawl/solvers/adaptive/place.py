"""Where the edge is, for parameters that surroundings give it there."""

from __future__ import annotations

from typing import Any, Final, NamedTuple

import numpy as np

from cellcrawl._compile import kernel
from cellcrawl.laws.functions import surround
from cellcrawl.solvers.adaptive.entries import LENGTH, ORIGIN_X, ORIGIN_Y
from cellcrawl.solvers.adaptive.projection import (
    COSINE,
    SINE,
    TRACE_ROWS,
    X,
    Y,
    tangent,
    trace,
)
from cellcrawl.solvers.adaptive.staggered import HALO, mean_ahead
from cellcrawl.surroundings.base import CompiledSurroundings

_HALO: Final = np.uint64(HALO)


class Around(NamedTuple):
    """Surroundings at work on the midpoints."""

    compiled: CompiledSurroundings
    data: np.ndarray
    local: np.ndarray
    room: np.ndarray


def around(compiled: CompiledSurroundings | None, rows: int, nodes: int) -> Around | None:
    """Return what kernels need of surroundings on ``nodes`` nodes, None if there are none."""
    if compiled is None:
        return None
    room = np.zeros((TRACE_ROWS, nodes + 2 * HALO))
    return Around(compiled, compiled.data, np.zeros((rows, nodes)), room)


@kernel
def surround_midpoints(
    around: Any, time: float, w: np.ndarray, g: np.ndarray, scalars: np.ndarray, edge: np.ndarray
) -> None:
    """Fill the parameters in place from those far from all, ``edge``. Halos are filled."""
    nodes = edge.shape[1]
    local, room = around.local, around.room
    tangent(w, nodes, room)
    trace(g, scalars[LENGTH], nodes, room)
    for row in range(edge.shape[0]):
        for i in range(nodes):
            local[row, i] = edge[row, i]
    for i in range(nodes):
        j = np.uint64(i) + _HALO
        x = mean_ahead(room[X], j) + scalars[ORIGIN_X]
        y = mean_ahead(room[Y], j) + scalars[ORIGIN_Y]
        cosine, sine = room[COSINE, j], room[SINE, j]
        surround(around.compiled, around.data, time, x, y, sine, -cosine, edge, local, i)
