"""A frame of output from the adaptive solver's state, as accurate as the state itself.

Positions come from the tangent angle by a tenth-order running integral on the solver's own grid;
values at the output nodes lie on polynomials through the twelve grid points around them.
"""

from __future__ import annotations

import functools
import math
from typing import Final

import numpy as np

from cellcrawl._compile import inlined_kernel, kernel
from cellcrawl.curve.fourier import BEFORE, TAPS, lagrange_weights
from cellcrawl.parameters import EDGE_ROWS
from cellcrawl.physics.exponential import exponential
from cellcrawl.physics.force_balance import SOLVED, balance, solve_off_rate
from cellcrawl.physics.laws import driving_force, edge_velocity, friction
from cellcrawl.solvers.adaptive import state as layout
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
from cellcrawl.solvers.base import Frame

_HALO = np.uint64(HALO)
_ROWS: Final = ("x", "y", "theta", "curvature", "bound_fraction", "off_rate")
_VELOCITY, _FRICTION = 6, 7


def frame(
    time: float, state: np.ndarray, log_rate: np.ndarray, edge: np.ndarray
) -> tuple[Frame, float]:
    """Return the cell on ``edge.shape[1]`` nodes, and its closure error over the length.

    ``log_rate`` is any guess of ``log r`` at the solver's midpoints.
    """
    nodes, count = edge.shape[1], layout.nodes_of(state)
    scalars = layout.scalars(state)
    out = np.empty((_FRICTION + 1, nodes))
    work = np.empty((5, count + 2 * HALO))
    area, center_x, center_y, gap = _edge_shape(state, work)
    y = log_rate[(np.arange(nodes) * count) // nodes]
    _sample(state, work, *_stencils(count, nodes), edge, y, out)
    made = Frame(
        time=time,
        **{name: out[row] for row, name in enumerate(_ROWS)},
        normal_velocity=out[_VELOCITY],
        friction=out[_FRICTION],
        tension=float(scalars[TENSION]),
        length=float(scalars[LENGTH]),
        area=area,
        centroid_x=center_x + float(scalars[ORIGIN_X]),
        centroid_y=center_y + float(scalars[ORIGIN_Y]),
    )
    return made, gap


@kernel
def _edge_shape(state: np.ndarray, work: np.ndarray) -> tuple[float, float, float, float]:
    """Area, centroid from node 0 and closure error over the length.

    Leaves in ``work``: x and y from node 0 at the nodes and curvature at the midpoints, with halos.
    """
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
    area = moment_x = moment_y = 0.0
    for i in range(count):
        j = np.uint64(i) + _HALO
        x[j] -= gap_x * i / count
        y[j] -= gap_y * i / count
        angle = w[j] + turn * i
        outward = x[j] * math.sin(angle) - y[j] * math.cos(angle)
        area += outward
        moment_x += x[j] * outward
        moment_y += y[j] * outward
    fill_halo(x, count)
    fill_halo(y, count)
    # area = 1/2 and area * centroid = 1/3 of the integral of (x . n) and of x (x . n)
    scale = 2.0 / (3.0 * area)
    return (
        0.5 * spacing * area,
        scale * moment_x,
        scale * moment_y,
        math.hypot(gap_x, gap_y) / length,
    )


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
def _stencils(count: int, nodes: int) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """First entries and weights that take grid nodes, and midpoints, to the output nodes."""
    assert EDGE_ROWS[1:7] == ("zeta_1", "D", "epsilon", "h", "sigma_c", "v_p")
    whole, rest = np.divmod(np.arange(nodes) * count, nodes)
    part = rest / nodes
    early = part < 0.5
    return (
        *_stencil(whole, part),
        *_stencil(whole - early, part + np.where(early, 0.5, -0.5)),
    )


def _stencil(whole: np.ndarray, part: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    weights = np.empty((whole.size, TAPS))
    for row, beyond in zip(weights, part, strict=True):
        lagrange_weights(beyond, row)
    return HALO + whole - BEFORE, weights
