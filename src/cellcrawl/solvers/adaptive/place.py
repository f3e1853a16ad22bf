"""Where the edge is, for parameters that surroundings give it there."""

from __future__ import annotations

import math
from typing import Any, Final, NamedTuple

import numpy as np

from cellcrawl.laws.functions import surround
from cellcrawl.numerics.kernels import kernel
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
from cellcrawl.solvers.adaptive.staggered import HALO, difference_ahead, mean_ahead
from cellcrawl.surroundings.base import CompiledSurroundings
from cellcrawl.surroundings.motion import AREA, CENTER_X, CENTER_Y, MOVES, VX, VY, at_rest, improve
from cellcrawl.surroundings.place import SETTLED, changed, copy_rows

_HALO: Final = np.uint64(HALO)
MORE_CURVED: Final = 1e-5


class Around(NamedTuple):
    """Surroundings at work on the midpoints."""

    compiled: CompiledSurroundings
    data: np.ndarray
    local: np.ndarray
    before: np.ndarray
    """The local parameters before the last change, if the motion of the cell matters; and those at
    a slightly larger curvature, if that does."""
    motion: np.ndarray
    """See `cellcrawl.surroundings.motion`."""
    room: np.ndarray


def around(
    compiled: CompiledSurroundings | None, rows: int, nodes: int, last: Around | None = None
) -> Around | None:
    """Return what kernels need of surroundings on ``nodes`` nodes, None if there are none.

    The cell moves on as in the ``last``.
    """
    if compiled is None:
        return None
    motion = at_rest(compiled.bends, compiled.moves) if last is None else last.motion
    room = np.zeros((TRACE_ROWS, nodes + 2 * HALO))
    before = np.zeros((rows, nodes if compiled.moves or compiled.bends else 0))
    return Around(compiled, compiled.data, np.zeros((rows, nodes)), before, motion, room)


@kernel
def surround_midpoints(
    around: Any,
    time: float,
    w: np.ndarray,
    g: np.ndarray,
    scalars: np.ndarray,
    fine: np.ndarray,
    edge: np.ndarray,
) -> None:
    """Fill the parameters in place from those far from all, ``edge``. Halos are filled.

    ``fine`` is ``1 / g``.
    """
    nodes, motion, room = edge.shape[1], around.motion, around.room
    tangent(w, nodes, room)
    _, _, area, center_x, center_y = trace(g, scalars[LENGTH], nodes, room)
    motion[AREA], motion[CENTER_X], motion[CENTER_Y] = area, center_x, center_y
    _fill(around, time, w, scalars, fine, edge, 0.0, around.local)


@kernel
def _fill(
    around: Any,
    time: float,
    w: np.ndarray,
    scalars: np.ndarray,
    fine: np.ndarray,
    edge: np.ndarray,
    more: float,
    local: np.ndarray,
) -> None:
    """Fill ``local`` for curvatures ``more`` than those of the edge that was traced."""
    nodes, motion, room = edge.shape[1], around.motion, around.room
    winding, per_spacing = 2.0 * math.pi / scalars[LENGTH], nodes / scalars[LENGTH]
    for row in range(edge.shape[0]):
        for i in range(nodes):
            local[row, i] = edge[row, i]
    for i in range(nodes):
        j = np.uint64(i) + _HALO
        x, y = mean_ahead(room[X], j), mean_ahead(room[Y], j)
        cosine, sine = room[COSINE, j], room[SINE, j]
        kappa = (winding + per_spacing * difference_ahead(w, j)) * fine[j] + more
        surround(
            around.compiled,
            around.data,
            time,
            x + scalars[ORIGIN_X],
            y + scalars[ORIGIN_Y],
            sine,
            -cosine,
            kappa,
            x - motion[CENTER_X],
            y - motion[CENTER_Y],
            motion[VX],
            motion[VY],
            edge,
            local,
            i,
        )


@kernel
def settle_midpoints(
    around: Any,
    time: float,
    w: np.ndarray,
    g: np.ndarray,
    scalars: np.ndarray,
    fine: np.ndarray,
    speed: np.ndarray,
    edge: np.ndarray,
) -> int:
    """Whether the cell moves as the parameters in place were made for, as in `settle`.

    ``speed`` is the normal velocity at the midpoints, with halos.
    """
    motion, room, nodes = around.motion, around.room, edge.shape[1]
    if motion[MOVES] == 0.0:
        return SETTLED
    found_x = found_y = 0.0
    for i in range(nodes):
        j = np.uint64(i) + _HALO
        found_x += (mean_ahead(room[X], j) - motion[CENTER_X]) * speed[j] * g[j]
        found_y += (mean_ahead(room[Y], j) - motion[CENTER_Y]) * speed[j] * g[j]
    share = scalars[LENGTH] / (nodes * motion[AREA])
    if improve(share * found_x, share * found_y, motion):
        return SETTLED
    copy_rows(around.local, around.before)
    _fill(around, time, w, scalars, fine, edge, 0.0, around.local)
    return changed(around.local, around.before, motion)


@kernel
def bent_midpoints(
    around: Any, time: float, w: np.ndarray, scalars: np.ndarray, fine: np.ndarray, edge: np.ndarray
) -> None:
    """Leave in ``before`` the parameters for curvatures that are `MORE_CURVED`."""
    _fill(around, time, w, scalars, fine, edge, MORE_CURVED, around.before)
