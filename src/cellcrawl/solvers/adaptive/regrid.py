"""From one number of nodes to another: how many are wanted, and the cell and its past on them."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from cellcrawl.numerics.kernels import inlined_kernel, kernel
from cellcrawl.solvers.adaptive.differences import DIFFERENCES, LEADING
from cellcrawl.solvers.adaptive.drive import (
    CHECK_DUE,
    COARSER,
    CONTRAST,
    FINER,
    KEEP,
    MISSED,
    ORDER,
    PEAK,
    RATES,
    RESIDUAL,
    STEP,
    TIME,
)
from cellcrawl.solvers.adaptive.entries import FIELDS, SCALARS
from cellcrawl.solvers.adaptive.mesh import lay_out, read_profile
from cellcrawl.solvers.adaptive.newton import factor, solve
from cellcrawl.solvers.adaptive.rates import rates, renew_rates
from cellcrawl.solvers.adaptive.resolution import (
    COARSEN,
    allowance,
    coarser,
    fewest_nodes,
    finer,
)
from cellcrawl.solvers.adaptive.staggered import HALO
from cellcrawl.solvers.adaptive.waves import resample, slopes


@inlined_kernel
def wanted_nodes(
    allowed: float,
    fewest: int,
    most: int,
    control: np.ndarray,
    counters: np.ndarray,
    table: np.ndarray,
    nodes: int,
) -> int:
    """Return on how many nodes to go on, and take it as dealt with; ``allowed`` is for `run`."""
    due = counters[CHECK_DUE]
    counters[CHECK_DUE] = KEEP
    if due == FINER:
        return finer(nodes, most)
    if due == COARSER:
        return coarser(nodes, fewest)
    span = nodes + 2 * HALO
    inner = slice(HALO, HALO + nodes)
    w, n, g = table[0, :span], table[0, span : 2 * span], table[0, 2 * span : 3 * span]
    may_miss = COARSEN * allowance(allowed, control[CONTRAST], False)
    return fewest_nodes(slopes(w[inner], n[inner], g[inner]), may_miss, fewest, nodes - 1)


@inlined_kernel
def move_states(states: np.ndarray, moved: np.ndarray) -> None:
    """Fill ``moved`` with an even number of states on another number of nodes, node 0 in place."""
    old = (states.shape[1] - SCALARS) // FIELDS - 2 * HALO
    new = (moved.shape[1] - SCALARS) // FIELDS - 2 * HALO
    for field in range(FIELDS):
        ahead = 0.0 if field == 0 else math.pi / new - math.pi / old
        before = field * (old + 2 * HALO) + HALO
        after = field * (new + 2 * HALO) + HALO
        here, there = slice(before, before + old), slice(after, after + new)
        for row in range(0, states.shape[0], 2):
            resample(
                states[row, here],
                states[row + 1, here],
                ahead,
                moved[row, there],
                moved[row + 1, there],
            )
    for row in range(states.shape[0]):
        for entry in range(SCALARS):
            moved[row, moved.shape[1] - SCALARS + entry] = states[
                row, states.shape[1] - SCALARS + entry
            ]


@inlined_kernel
def move_to_nodes(
    laws: Any,
    around: Any,
    control: np.ndarray,
    counters: np.ndarray,
    old_table: np.ndarray,
    old_y: np.ndarray,
    table: np.ndarray,
    y: np.ndarray,
    profile: np.ndarray,
    edge: np.ndarray,
    mesh: np.ndarray,
    matrix: np.ndarray,
    work: np.ndarray,
) -> None:
    """Take the cell and its past from ``old_table`` and ``old_y`` to ``table`` and ``y``."""
    old, new = old_y.size, y.size
    move_states(old_table[:DIFFERENCES], table[:DIFFERENCES])
    resample(old_y, old_y, math.pi / new - math.pi / old, y, y)
    ratio = old / new  # products, of which Python and a kernel make the same bits
    fourth = (ratio * ratio) * (ratio * ratio)
    control[MISSED] *= (ratio * ratio) * (fourth * fourth)
    control[PEAK] *= ratio * fourth
    span = new + 2 * HALO
    read_profile(profile, table[0, 2 * span : 3 * span], edge, mesh, work)
    counters[RATES] += 1
    bend_history(laws, around, control, counters, table, y, edge, mesh, matrix, work)


@inlined_kernel
def bend_history(
    laws: Any,
    around: Any,
    control: np.ndarray,
    counters: np.ndarray,
    table: np.ndarray,
    y: np.ndarray,
    edge: np.ndarray,
    mesh: np.ndarray,
    matrix: np.ndarray,
    work: np.ndarray,
) -> None:
    """Make the past lead to the present with the rates of a new grid.

    The grids' rates differ by what they miss. Without this the past has a kink there, which costs
    many short steps; stiff parts of the difference are damped as a step would.
    """
    order, h = counters[ORDER], control[STEP]
    state, residual = table[0], table[RESIDUAL]
    nodes = y.size
    span = nodes + 2 * HALO
    w, n, g = state[:span], state[span : 2 * span], state[2 * span : 3 * span]
    lay_out(w, n, g, h, order, mesh, nodes)
    renew_rates(laws, y, edge, work)
    if not rates(laws, around, control[TIME], state, residual, y, edge, mesh, work):
        return
    _find_kink(order, h, table, residual)
    c = h / LEADING[order]
    factor(laws, around, control[TIME], c, state, y, edge, mesh, work, matrix)
    solve(c, state, mesh, matrix, residual)
    _add(residual, table[1])


@kernel
def _add(change: np.ndarray, to: np.ndarray) -> None:
    for k in range(to.size):
        to[k] += change[k]


@kernel
def _find_kink(order: int, h: float, table: np.ndarray, residual: np.ndarray) -> None:
    """Turn rates into what they are off from those of the past, over a step."""
    for k in range(residual.size):
        past = 0.0
        for j in range(1, order + 1):
            past += table[j, k] / j
        residual[k] = h * residual[k] - past
