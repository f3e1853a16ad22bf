"""Surroundings at work: local parameters where an edge is."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from cellcrawl._compile import kernel
from cellcrawl._elementary import hypotenuse
from cellcrawl.laws.functions import surround
from cellcrawl.surroundings.base import CompiledSurroundings


class Around(NamedTuple):
    """Surroundings at work on an edge."""

    compiled: CompiledSurroundings
    data: np.ndarray
    local: np.ndarray


def around(compiled: CompiledSurroundings | None, rows: int, nodes: int) -> Around | None:
    """Return what kernels need of surroundings on ``nodes`` nodes, None if there are none."""
    return None if compiled is None else Around(compiled, compiled.data, np.zeros((rows, nodes)))


@kernel
def surround_edge(
    around: Any,
    time: float,
    x: np.ndarray,
    y: np.ndarray,
    tangent_x: np.ndarray,
    tangent_y: np.ndarray,
    edge: np.ndarray,
) -> None:
    """Fill the parameters in place from those far from all, ``edge``, shape (rows, nodes).

    The tangent may have any length; arrays have shape (nodes,).
    """
    local = around.local
    local[:] = edge
    for i in range(x.size):
        per_length = 1.0 / hypotenuse(tangent_x[i], tangent_y[i])
        normal_x, normal_y = tangent_y[i] * per_length, -tangent_x[i] * per_length
        surround(around.compiled, around.data, time, x[i], y[i], normal_x, normal_y, edge, local, i)


def placed(
    compiled: CompiledSurroundings | None,
    time: float,
    x: np.ndarray,
    y: np.ndarray,
    tangent: tuple[np.ndarray, np.ndarray],
    edge: np.ndarray,
) -> np.ndarray:
    """Return the parameters in place from those far from all, ``edge``, shape (rows, nodes)."""
    room = around(compiled, *edge.shape)
    if room is None:
        return edge
    surround_edge(room, time, x, y, *tangent, edge)
    return room.local
