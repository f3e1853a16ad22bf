"""A frame of output from the adaptive solver's state, as accurate as the state itself.

Positions come from the tangent angle by a tenth-order running integral along the solver's own
nodes; values at equal arclengths lie on polynomials through the twelve nodes around them.
"""

from __future__ import annotations

import math
from typing import Any, Final, NamedTuple

import numpy as np

from cellcrawl._compile import inlined_kernel, kernel
from cellcrawl.curve.fourier import BEFORE, TAPS
from cellcrawl.laws.functions import friction, off_rate, velocity
from cellcrawl.physics.force_balance import SOLVED, bond_force, solve_bonds
from cellcrawl.solvers.adaptive import state as layout
from cellcrawl.solvers.adaptive.differences import interpolate
from cellcrawl.solvers.adaptive.entries import FIELDS, LENGTH, ORIGIN_X, ORIGIN_Y, SCALARS, TENSION
from cellcrawl.solvers.adaptive.mesh import places
from cellcrawl.solvers.adaptive.projection import (
    COSINE,
    SINE,
    TRACE_ROWS,
    X,
    Y,
    project,
    tangent,
    trace,
)
from cellcrawl.solvers.adaptive.staggered import HALO, difference_ahead, fill_halo, mean_ahead
from cellcrawl.solvers.base import Frame, Instant
from cellcrawl.surroundings.motion import MOVES
from cellcrawl.surroundings.place import balance_in_place, surround_edge

KAPPA, PLACE = COSINE, SINE  # rows that hold these once the tangent has been used
_HALO = np.uint64(HALO)
_ROWS: Final = ("x", "y", "theta", "curvature", "bound_fraction", "off_rate")
_VELOCITY, _FRICTION = 6, 7
_CLEARLY = 0.1  # in cell radii: far more than the edge does between two midpoints
_NEWTON_STEPS = 5
_SETTLED = 2e-5  # a Newton step this short leaves a tenth of its square
_SCALES: Final = np.array(
    [
        (-1.0) ** (TAPS - 1 - tap) / (math.factorial(tap) * math.factorial(TAPS - 1 - tap))
        for tap in range(TAPS)
    ]
)


class Shape(NamedTuple):
    """The edge at one instant on the solver's own nodes, and what is measured on it."""

    state: np.ndarray
    work: np.ndarray
    """x and y from node 0, and arclength in mean spacings, at the nodes; curvature at the
    midpoints; all with halos, in rows `X`, `Y`, `PLACE` and `KAPPA`."""
    area: float
    centroid: tuple[float, float]
    closure_error: float
    area_error: float
    """What was mended: relative to the length and the area."""
    star_shaped: bool
    """Whether every point of the edge is seen from the centroid; then it cannot cross itself."""


def shape_of(state: np.ndarray) -> Shape:
    """Return the edge of a state."""
    return shape_between(0.0, 0, state[None])


def shape_between(steps: float, order: int, table: np.ndarray) -> Shape:
    """Return the edge ``steps`` step sizes after the last state, between -1 and 0.

    ``table`` holds the state and its backward differences. The edge closes and has the area of the
    tension law to rounding.
    """
    state = np.empty_like(table[0])
    work = np.empty((TRACE_ROWS, layout.nodes_of(state) + 2 * HALO))
    area, x, y, gap, excess, clearance = _edge_shape(steps, order, table, state, work)
    return Shape(state, work, area, (x, y), gap, excess, clearance > _CLEARLY)


def instant(time: float, shape: Shape) -> Instant:
    """Return the cell as a whole."""
    return Instant(time=time, **_whole_cell(shape))


def frame(
    laws: Any, around: Any, time: float, shape: Shape, log_rate: np.ndarray, edge: np.ndarray
) -> Frame:
    """Return the cell on ``edge.shape[1]`` nodes.

    ``log_rate`` is any guess of ``log r`` at the solver's midpoints.
    """
    out = np.empty((_FRICTION + 1, edge.shape[1]))
    y = np.empty(edge.shape[1])
    _sample(shape.state, shape.work, log_rate, y, out)
    if around is not None:
        points = (out[0], out[1], np.cos(out[2]), np.sin(out[2]), out[3])
        if around.motion[MOVES] > 0.0:
            tension = float(layout.scalars(shape.state)[TENSION])
            balance_in_place(laws, around, time, *points, tension, out[4], y.copy(), edge)
        else:
            surround_edge(around, time, *points, edge)
        edge = around.local
    _balance(laws, float(layout.scalars(shape.state)[TENSION]), edge, y, out)
    return Frame(
        time=time,
        **{name: out[row] for row, name in enumerate(_ROWS)},
        normal_velocity=out[_VELOCITY],
        friction=out[_FRICTION],
        **_whole_cell(shape),
    )


def _whole_cell(shape: Shape) -> dict[str, Any]:
    scalars = layout.scalars(shape.state)
    center_x, center_y = shape.centroid
    return {
        "tension": float(scalars[TENSION]),
        "length": float(scalars[LENGTH]),
        "area": shape.area,
        "centroid_x": center_x + float(scalars[ORIGIN_X]),
        "centroid_y": center_y + float(scalars[ORIGIN_Y]),
        "surely_simple": shape.star_shaped,
        "closure_gap": max(shape.closure_error, shape.area_error),
    }


@kernel
def _edge_shape(
    steps: float, order: int, table: np.ndarray, state: np.ndarray, work: np.ndarray
) -> tuple[float, float, float, float, float, float]:
    """Area, centroid from node 0, what was amiss with closure and area, least support.

    Fills ``state``, and ``work`` as `Shape` has it. The support is that seen from the centroid.
    """
    interpolate(steps, order, table, state)
    span = (state.size - SCALARS) // FIELDS
    count = span - 2 * HALO
    w, g = state[:span], state[2 * span : 3 * span]
    scalars = state[3 * span :]
    fill_halo(state[span : 2 * span], count)
    gap, excess = project(state, count, work)
    tangent(w, count, work)
    _, _, area, center_x, center_y = trace(g, scalars[LENGTH], count, work)
    x, y, cosine, sine = work[X], work[Y], work[COSINE], work[SINE]
    least = math.inf
    for i in range(count):
        j = np.uint64(i) + _HALO
        arm_x, arm_y = mean_ahead(x, j) - center_x, mean_ahead(y, j) - center_y
        support = arm_x * sine[j] - arm_y * cosine[j]
        least = support if support < least else least
    kappa = work[KAPPA]
    turn = 2.0 * math.pi / count
    for i in range(np.uint64(count)):
        j = i + _HALO
        kappa[j] = (turn + difference_ahead(w, j)) * (count / scalars[LENGTH]) / g[j]
    fill_halo(kappa, count)
    places(g, count, work[PLACE])
    return area, center_x, center_y, gap, excess, least


@kernel
def _sample(
    state: np.ndarray, work: np.ndarray, log_rate: np.ndarray, y: np.ndarray, out: np.ndarray
) -> None:
    """Fill ``out`` with shape and bound fraction at equal arclengths, ``y`` with a guess of phi."""
    nodes, count = out.shape[1], log_rate.size
    span = count + 2 * HALO
    w, n, g = state[:span], state[span : 2 * span], state[2 * span : 3 * span]
    scalars = state[3 * span :]
    place, turn = work[PLACE], 2.0 * math.pi / count
    weights = np.empty(TAPS)
    before = 0  # the node at or before the place
    for i in range(nodes):
        wanted = i * (count / nodes)
        while before < count - 1 and place[HALO + before + 1] <= wanted:
            before += 1
        part = _part_of_cell(wanted, before, place, g, weights)
        _lagrange(part, weights)
        first = HALO + before - BEFORE
        out[0, i] = _weighted(work[X], first, weights) + scalars[ORIGIN_X]
        out[1, i] = _weighted(work[Y], first, weights) + scalars[ORIGIN_Y]
        out[2, i] = _weighted(w, first, weights) + turn * (before + part)
        early = part < 0.5
        _lagrange(part + (0.5 if early else -0.5), weights)
        first -= 1 if early else 0
        out[3, i] = _weighted(work[KAPPA], first, weights)
        out[4, i] = _weighted(n, first, weights)
        y[i] = log_rate[before]


@kernel
def _balance(laws: Any, sigma: float, edge: np.ndarray, y: np.ndarray, out: np.ndarray) -> None:
    """Fill ``out`` with what follows from the balance of forces."""
    nodes, kappa, bound = y.size, out[3], out[4]
    failed = solve_bonds(laws, y, bound, sigma, kappa, edge)
    if failed != SOLVED:  # the edge left the model's range between the solver's midpoints
        for i in range(failed, nodes):
            root = bond_force(laws, y[i], bound[i], sigma, kappa[i], edge, i)
            y[i] = root if root == root else 0.0
    for i in range(nodes):
        r = off_rate(laws, y[i], edge, i)
        out[5, i] = r
        out[_VELOCITY, i] = velocity(laws, y[i], r, sigma, kappa[i], edge, i)
        out[_FRICTION, i] = friction(laws, y[i], r, bound[i], edge, i)


@kernel
def _part_of_cell(
    wanted: float, before: int, place: np.ndarray, g: np.ndarray, weights: np.ndarray
) -> float:
    """How far after node ``before``, in cells, the arclength is ``wanted``: Newton steps."""
    start, end = place[HALO + before], place[HALO + before + 1]
    part = (wanted - start) / (end - start)
    if part <= 0.0:
        return 0.0
    first = HALO + before - BEFORE
    for _ in range(_NEWTON_STEPS):
        _lagrange(part, weights)
        here = _weighted(place, first, weights)
        early = part < 0.5
        _lagrange(part + (0.5 if early else -0.5), weights)
        slope = _weighted(g, first - 1 if early else first, weights)
        step = (wanted - here) / slope
        part += step
        if abs(step) < _SETTLED:
            break
    return float(min(max(part, 0.0), 1.0))


@kernel
def _lagrange(part: float, weights: np.ndarray) -> None:
    """Weights of `TAPS` equal steps, from `BEFORE` before to a place ``part`` after one."""
    product = 1.0
    for tap in range(TAPS):
        weights[tap] = product * _SCALES[tap]
        product *= part + (BEFORE - tap)
    product = 1.0
    for tap in range(TAPS - 1, -1, -1):
        weights[tap] *= product
        product *= part + (BEFORE - tap)


@inlined_kernel
def _weighted(a: np.ndarray, first: int, weights: np.ndarray) -> float:
    value = 0.0
    for tap in range(TAPS):
        value += weights[tap] * a[np.uint64(first + tap)]
    return value
