"""Surroundings at work: local parameters where an edge is, and forces in balance with them."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from cellcrawl.laws.force_balance import SOLVED, solve_bonds
from cellcrawl.laws.functions import off_rate, surround, velocity
from cellcrawl.numerics.elementary import hypotenuse
from cellcrawl.numerics.kernels import kernel
from cellcrawl.surroundings.base import CompiledSurroundings
from cellcrawl.surroundings.motion import (
    AREA,
    CENTER_X,
    CENTER_Y,
    MOST_TRIES,
    MOVES,
    TRIES,
    VX,
    VY,
    at_rest,
    improve,
)

SETTLED, AGAIN, UNSETTLED = range(3)  # what `settle` returns


class Around(NamedTuple):
    """Surroundings at work on an edge."""

    compiled: CompiledSurroundings
    data: np.ndarray
    local: np.ndarray
    before: np.ndarray
    """The local parameters before the last change, if the motion of the cell matters."""
    motion: np.ndarray
    """See `cellcrawl.surroundings.motion`."""


def around(
    compiled: CompiledSurroundings | None, rows: int, nodes: int, motion: np.ndarray | None = None
) -> Around | None:
    """Return what kernels need of surroundings on ``nodes`` nodes, None if there are none."""
    if compiled is None:
        return None
    if motion is None:
        motion = at_rest(compiled.bends, compiled.moves)
    before = np.zeros((rows, nodes if compiled.moves else 0))
    return Around(compiled, compiled.data, np.zeros((rows, nodes)), before, motion)


@kernel
def copy_rows(source: np.ndarray, target: np.ndarray) -> None:
    """Copy an array of two dimensions: a whole assignment compiles to much text for its error."""
    for row in range(source.shape[0]):
        for i in range(source.shape[1]):
            target[row, i] = source[row, i]


@kernel
def surround_edge(
    around: Any,
    time: float,
    x: np.ndarray,
    y: np.ndarray,
    tangent_x: np.ndarray,
    tangent_y: np.ndarray,
    kappa: np.ndarray,
    edge: np.ndarray,
) -> None:
    """Fill the parameters in place from those far from all, ``edge``, shape (rows, nodes).

    The tangent may have any length, equal all along or that of an arc from node to node; arrays
    have shape (nodes,).
    """
    local, motion = around.local, around.motion
    copy_rows(edge, local)
    moves = motion[MOVES] > 0.0
    if moves:
        _find_center(x, y, tangent_x, tangent_y, motion)
    for i in range(x.size):
        per_length = 1.0 / hypotenuse(tangent_x[i], tangent_y[i])
        surround(
            around.compiled,
            around.data,
            time,
            x[i],
            y[i],
            tangent_y[i] * per_length,
            -tangent_x[i] * per_length,
            kappa[i],
            x[i] - motion[CENTER_X],
            y[i] - motion[CENTER_Y],
            motion[VX],
            motion[VY],
            edge,
            local,
            i,
        )


@kernel
def agrees(
    laws: Any,
    around: Any,
    x: np.ndarray,
    y: np.ndarray,
    tangent_x: np.ndarray,
    tangent_y: np.ndarray,
    kappa: np.ndarray,
    sigma: float,
    phi: np.ndarray,
) -> bool:
    """Whether the cell moves as the parameters in place were made for.

    Otherwise there is a better velocity, and the parameters are kept to compare with.
    """
    motion, local = around.motion, around.local
    found_x = found_y = 0.0
    for i in range(x.size):
        r = off_rate(laws, phi[i], local, i)
        speed = velocity(laws, phi[i], r, sigma, kappa[i], local, i)
        speed *= hypotenuse(tangent_x[i], tangent_y[i])
        found_x += (x[i] - motion[CENTER_X]) * speed
        found_y += (y[i] - motion[CENTER_Y]) * speed
    if improve(found_x / motion[AREA], found_y / motion[AREA], motion):
        return True
    copy_rows(local, around.before)
    return False


@kernel
def settle(
    laws: Any,
    around: Any,
    time: float,
    x: np.ndarray,
    y: np.ndarray,
    tangent_x: np.ndarray,
    tangent_y: np.ndarray,
    kappa: np.ndarray,
    sigma: float,
    phi: np.ndarray,
    edge: np.ndarray,
) -> int:
    """Make the parameters in place anew with a better velocity, if the cell moves otherwise.

    What follows from them must then be made anew (`AGAIN`), unless they have not changed.
    """
    if around.motion[MOVES] == 0.0:
        return SETTLED
    if agrees(laws, around, x, y, tangent_x, tangent_y, kappa, sigma, phi):
        return SETTLED
    surround_edge(around, time, x, y, tangent_x, tangent_y, kappa, edge)
    return changed(around.local, around.before, around.motion)


@kernel
def changed(local: np.ndarray, before: np.ndarray, motion: np.ndarray) -> int:
    """Whether new local parameters ask for a new balance, or have been changed too often."""
    for row in range(local.shape[0]):
        for i in range(local.shape[1]):
            if local[row, i] != before[row, i]:
                if motion[TRIES] < MOST_TRIES:
                    return AGAIN
                motion[TRIES] = 0.0
                return UNSETTLED
    motion[TRIES] = 0.0
    return SETTLED


@kernel
def balance_in_place(
    laws: Any,
    around: Any,
    time: float,
    x: np.ndarray,
    y: np.ndarray,
    tangent_x: np.ndarray,
    tangent_y: np.ndarray,
    kappa: np.ndarray,
    sigma: float,
    n: np.ndarray,
    phi: np.ndarray,
    edge: np.ndarray,
) -> int:
    """Make the parameters in place and solve the bonds under them, as `solve_bonds` does.

    ``around`` is None or what `Around` holds. A velocity that does not settle is told as a lack of
    a root at node 0.
    """
    if around is None:
        return solve_bonds(laws, phi, n, sigma, kappa, edge)
    again = False
    while True:
        surround_edge(around, time, x, y, tangent_x, tangent_y, kappa, edge)
        if again:
            state = changed(around.local, around.before, around.motion)
            if state != AGAIN:
                return SOLVED if state == SETTLED else 0
        failed = solve_bonds(laws, phi, n, sigma, kappa, around.local)
        if failed != SOLVED or around.motion[MOVES] == 0.0:
            return failed
        if agrees(laws, around, x, y, tangent_x, tangent_y, kappa, sigma, phi):
            return SOLVED
        again = True


@kernel
def _find_center(
    x: np.ndarray, y: np.ndarray, tangent_x: np.ndarray, tangent_y: np.ndarray, motion: np.ndarray
) -> None:
    """Leave centroid and area; the latter over the arc that a tangent of length 1 stands for."""
    area = moment_x = moment_y = 0.0
    for i in range(x.size):
        to_x, to_y = x[i] - x[0], y[i] - y[0]
        area += 0.5 * (to_x * tangent_y[i] - to_y * tangent_x[i])
        moment_x += 0.5 * to_x * to_x * tangent_y[i]
        moment_y -= 0.5 * to_y * to_y * tangent_x[i]
    motion[AREA] = area
    motion[CENTER_X] = x[0] + moment_x / area
    motion[CENTER_Y] = y[0] + moment_y / area
