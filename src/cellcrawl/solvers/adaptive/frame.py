"""A frame of output from the adaptive solver's state, as accurate as the state itself.

Positions come from the tangent angle by a tenth-order running integral on the solver's own grid;
values at the output nodes lie on polynomials through the twelve grid points around them.
"""

from __future__ import annotations

import functools
import math
from typing import Any, Final, NamedTuple

import numpy as np

from cellcrawl._compile import inlined_kernel, kernel
from cellcrawl.curve.fourier import BEFORE, TAPS, lagrange_weights
from cellcrawl.parameters import EDGE_ROWS
from cellcrawl.physics.exponential import exponential
from cellcrawl.physics.force_balance import SOLVED, balance, solve_off_rate
from cellcrawl.physics.laws import driving_force, edge_velocity, friction
from cellcrawl.solvers.adaptive import state as layout
from cellcrawl.solvers.adaptive.differences import interpolate
from cellcrawl.solvers.adaptive.rates import LENGTH, ORIGIN_X, ORIGIN_Y, SCALARS, TENSION
from cellcrawl.solvers.adaptive.staggered import (
    HALO,
    cell_mean,
    difference_ahead,
    fill_halo,
    mean_ahead,
    running_sum,
    total,
)
from cellcrawl.solvers.base import Frame, Instant

_HALO = np.uint64(HALO)
_ROWS: Final = ("x", "y", "theta", "curvature", "bound_fraction", "off_rate")
_VELOCITY, _FRICTION = 6, 7
_CLEARLY = 0.1  # in cell radii: far more than the edge does between two midpoints


class Shape(NamedTuple):
    """The edge at one instant on the solver's own grid, and what is measured on it."""

    state: np.ndarray
    work: np.ndarray
    """x and y from node 0 at the nodes and curvature at the midpoints, with halos."""
    area: float
    centroid: tuple[float, float]
    closure_error: float
    star_shaped: bool
    """Whether every point of the edge is seen from the centroid; then it cannot cross itself."""


def shape_of(state: np.ndarray) -> Shape:
    """Return the edge of a state."""
    return shape_between(0.0, 0, state[None])


def shape_between(steps: float, order: int, table: np.ndarray) -> Shape:
    """Return the edge ``steps`` step sizes after the last state, between -1 and 0.

    ``table`` holds the state and its backward differences.
    """
    state = np.empty_like(table[0])
    work = np.empty((5, layout.nodes_of(state) + 2 * HALO))
    area, x, y, gap, clearance = _edge_shape(steps, order, table, state, work)
    return Shape(state, work, area, (x, y), gap, clearance > _CLEARLY)


def instant(time: float, shape: Shape) -> Instant:
    """Return the cell as a whole."""
    return Instant(time=time, **_whole_cell(shape))


def frame(time: float, shape: Shape, log_rate: np.ndarray, edge: np.ndarray) -> Frame:
    """Return the cell on ``edge.shape[1]`` nodes.

    ``log_rate`` is any guess of ``log r`` at the solver's midpoints.
    """
    nodes, count = edge.shape[1], log_rate.size
    out = np.empty((_FRICTION + 1, nodes))
    stencils, nearest = _stencils(count, nodes)
    _sample(shape.state, shape.work, *stencils, edge, log_rate[nearest], out)
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
    }


@kernel
def _edge_shape(
    steps: float, order: int, table: np.ndarray, state: np.ndarray, work: np.ndarray
) -> tuple[float, float, float, float, float]:
    """Area, centroid from node 0, closure error over the length, least support from the centroid.

    Fills ``state``, and ``work`` as `Shape` has it.
    """
    interpolate(steps, order, table, state)
    span = (state.size - SCALARS) // 2
    count = span - 2 * HALO
    w, n, length = state[:span], state[span : 2 * span], state[2 * span + LENGTH]
    fill_halo(w, count)
    fill_halo(n, count)
    x, y, kappa, cosine, sine = work[0], work[1], work[2], work[3], work[4]
    turn = 2.0 * math.pi / count
    for i in range(count):
        j = np.uint64(i) + _HALO
        angle = mean_ahead(w, j) + turn * (i + 0.5)
        cosine[j] = math.cos(angle)
        sine[j] = math.sin(angle)
        kappa[j] = (turn + difference_ahead(w, j)) * (count / length)
    fill_halo(cosine, count)
    fill_halo(sine, count)
    fill_halo(kappa, count)
    spacing = length / count
    for i in range(count):
        j = np.uint64(i) + _HALO
        x[j] = spacing * cell_mean(cosine, j)
        y[j] = spacing * cell_mean(sine, j)
    gap_x, gap_y = total(x, count), total(y, count)
    running_sum(x, count)
    running_sum(y, count)
    for i in range(count):
        j = np.uint64(i) + _HALO
        x[j] -= gap_x * i / count
        y[j] -= gap_y * i / count
    fill_halo(x, count)
    fill_halo(y, count)
    # 2 area and 3 area * centroid are the integrals of the support x . n and of x (x . n)
    area = moment_x = moment_y = 0.0
    for i in range(count):
        j = np.uint64(i) + _HALO
        middle_x, middle_y = mean_ahead(x, j), mean_ahead(y, j)
        support = middle_x * sine[j] - middle_y * cosine[j]
        area += support
        moment_x += middle_x * support
        moment_y += middle_y * support
    center_x, center_y = 2.0 * moment_x / (3.0 * area), 2.0 * moment_y / (3.0 * area)
    least = math.inf
    for i in range(count):
        j = np.uint64(i) + _HALO
        arm_x, arm_y = mean_ahead(x, j) - center_x, mean_ahead(y, j) - center_y
        support = arm_x * sine[j] - arm_y * cosine[j]
        least = support if support < least else least
    return 0.5 * spacing * area, center_x, center_y, math.hypot(gap_x, gap_y) / length, least


@kernel
def _sample(
    state: np.ndarray,
    work: np.ndarray,
    at_nodes: np.ndarray,
    node_weights: np.ndarray,
    at_midpoints: np.ndarray,
    midpoint_weights: np.ndarray,
    edge: np.ndarray,
    y: np.ndarray,
    out: np.ndarray,
) -> None:
    """Fill ``out`` with the fields at the output nodes; ``y`` holds guesses of ``log r``."""
    span = (state.size - SCALARS) // 2
    w, n, scalars = state[:span], state[span : 2 * span], state[2 * span :]
    nodes = y.size
    winding = 2.0 * math.pi / nodes
    sigma = scalars[TENSION]
    for i in range(nodes):
        first, weights = at_nodes[i], node_weights[i]
        out[0, i] = _weighted(work[0], first, weights) + scalars[ORIGIN_X]
        out[1, i] = _weighted(work[1], first, weights) + scalars[ORIGIN_Y]
        out[2, i] = _weighted(w, first, weights) + winding * i
        first, weights = at_midpoints[i], midpoint_weights[i]
        out[3, i] = _weighted(work[2], first, weights)
        out[4, i] = _weighted(n, first, weights)
    kappa, bound = out[3], out[4]
    failed = solve_off_rate(y, bound, sigma, kappa, edge[1], edge[5], edge[4])
    if failed != SOLVED:  # the edge left the model's range between the solver's midpoints
        for i in range(failed, nodes):
            force = driving_force(sigma, kappa[i], edge[5, i], edge[4, i])
            y[i] = max(balance(y[i], bound[i], edge[1, i], max(force, 0.0)), 0.0)
    for i in range(nodes):
        r = exponential(y[i])
        out[5, i] = r
        out[_VELOCITY, i] = edge_velocity(y[i], r, edge[6, i], edge[3, i])
        out[_FRICTION, i] = friction(y[i], r, bound[i], edge[1, i])


@inlined_kernel
def _weighted(a: np.ndarray, first: int, weights: np.ndarray) -> float:
    value = 0.0
    for tap in range(TAPS):
        value += weights[tap] * a[np.uint64(first + tap)]
    return value


@functools.lru_cache(maxsize=64)
def _stencils(
    count: int, nodes: int
) -> tuple[tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray], np.ndarray]:
    """First entries and weights that take grid nodes, and midpoints, to the output nodes.

    And the midpoint near each output node.
    """
    assert EDGE_ROWS[1:7] == ("zeta_1", "D", "epsilon", "h", "sigma_c", "v_p")
    whole, rest = np.divmod(np.arange(nodes) * count, nodes)
    part = rest / nodes
    early = part < 0.5
    at_midpoints = _stencil(whole - early, part + np.where(early, 0.5, -0.5))
    return (*_stencil(whole, part), *at_midpoints), whole


def _stencil(whole: np.ndarray, part: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    weights = np.empty((whole.size, TAPS))
    for row, beyond in zip(weights, part, strict=True):
        lagrange_weights(beyond, row)
    return HALO + whole - BEFORE, weights
