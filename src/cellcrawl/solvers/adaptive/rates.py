"""Rates of change of the whole state on the staggered grid, and how stiff they are.

A state is one flat array: ``w = theta - winding`` at the nodes, ``n`` and the density ``g`` of the
arclength at the midpoints, all with halos, then the scalars length, tension, area and position of
node 0. Between nodes lies an arclength of ``L g / nodes``. Kernels use the paper's letters: ``U``
edge velocity, ``T`` tangential velocity of the nodes, ``y`` the force on a bond, ``log r`` in the
paper's law.
"""

from __future__ import annotations

import math
from typing import Any, Final

import numpy as np

from cellcrawl.laws.addresses import AROUND, NOTHING, NUMBER, ROW, ROWS, TRUTH, called_by_address
from cellcrawl.laws.force_balance import SOLVED, halley_step, solve_bonds
from cellcrawl.laws.functions import (
    binding,
    nearly_renewed_rate,
    off_rate,
    renewed_rate,
    velocity,
)
from cellcrawl.numerics.elementary import cosine, sine
from cellcrawl.numerics.kernels import expanded_kernel
from cellcrawl.solvers.adaptive.entries import (
    AREA,
    LENGTH,
    ORIGIN_X,
    ORIGIN_Y,
    TENSION,
    TENSION_RATE,
)
from cellcrawl.solvers.adaptive.mesh import CHANGE, FINE, FINE_NODE
from cellcrawl.solvers.adaptive.place import settle_midpoints, surround_midpoints
from cellcrawl.solvers.adaptive.staggered import (
    HALO,
    cell_mean,
    central_difference,
    difference_ahead,
    difference_behind,
    fill_halo,
    mean_ahead,
    mean_behind,
    running_sum,
    total,
)
from cellcrawl.surroundings.place import SETTLED, UNSETTLED

WORK_ROWS: Final = 6
RATE: Final = 4  # row of `work` that keeps r beside the last y, from stage to stage
_HALO = np.uint64(HALO)
_NEAR = 0.12  # a first step in log r this short is followed by a second that reaches rounding
_SETTLED = 4e-6  # a second step this short leaves an error of its cube


@expanded_kernel
def velocities(
    laws: Any,
    w: np.ndarray,
    n: np.ndarray,
    length: float,
    sigma: float,
    edge: np.ndarray,
    fine: np.ndarray,
    y: np.ndarray,
    work: np.ndarray,
) -> bool:
    """Solve the force balance at the midpoints; False where it has no root.

    Leaves ``phi`` in ``y``, shape (nodes,), and in the rows of ``work``, which have halos: ``U``,
    ``g kappa U`` and the binding. Row `RATE` must hold the off-rate at ``y``, where `renew_rates`
    puts it. ``fine`` is ``1 / g``.
    """
    nodes = y.size
    per_spacing = nodes / length
    winding = 2.0 * math.pi / length
    speed, stretch, bind, kappa, rate = work[0], work[1], work[2], work[3], work[RATE]
    unsettled = 0
    for i in range(np.uint64(nodes)):
        j = i + _HALO
        bend = winding + per_spacing * difference_ahead(w, j)
        stretch[j] = bend
        kappa[i] = bend * fine[j]
        near = y[i]
        r = rate[i]
        first = halley_step(laws, near, r, n[j], sigma, kappa[i], edge, i)
        near = near + first
        r = renewed_rate(laws, r, near, first, edge, i)
        second = halley_step(laws, near, r, n[j], sigma, kappa[i], edge, i)
        near = near + second
        rate[i] = nearly_renewed_rate(laws, r, near, second, edge, i)
        good = (abs(first) < _NEAR) & (abs(second) < _SETTLED) & (near >= 0.0)
        unsettled += 0 if good else 1
        y[i] = near
    if unsettled > 0:
        if solve_bonds(laws, y, n[HALO : HALO + nodes], sigma, kappa[:nodes], edge) != SOLVED:
            return False
        for i in range(np.uint64(nodes)):
            rate[i] = off_rate(laws, y[i], edge, i)
    for i in range(np.uint64(nodes)):
        j = i + _HALO
        speed[j] = velocity(laws, y[i], rate[i], sigma, kappa[i], edge, i)
        bind[j] = binding(laws, y[i], rate[i], n[j], edge, i)
        stretch[j] *= speed[j]
    fill_halo(speed, nodes)
    return True


@called_by_address(TRUTH, AROUND, NUMBER, ROW, ROW, ROW, ROWS, ROWS, ROWS)
def rates(
    laws: Any,
    around: Any,
    time: float,
    state: np.ndarray,
    out: np.ndarray,
    y: np.ndarray,
    edge: np.ndarray,
    mesh: np.ndarray,
    work: np.ndarray,
) -> bool:
    """Write the rates of change of ``state`` to ``out``; False where there is no off-rate.

    ``around`` is None or what `place.Around` holds, which then has the parameters at ``time``.

    Fills the halos of ``state``. ``y`` is the last ``phi`` and becomes the new one. ``edge``
    holds the law's parameters at the midpoints and in its last row G, (rows, nodes); ``mesh`` what
    `mesh.hold` makes of the density, and its rate, which is copied.
    """
    nodes = y.size
    span = nodes + 2 * HALO
    w, n, g = state[:span], state[span : 2 * span], state[2 * span : 3 * span]
    w_t, n_t, g_t = out[:span], out[span : 2 * span], out[2 * span : 3 * span]
    scalars, scalars_t = state[3 * span :], out[3 * span :]
    fine, fine_node, change = mesh[FINE], mesh[FINE_NODE], mesh[CHANGE]
    length = scalars[LENGTH]
    fill_halo(w, nodes)
    fill_halo(n, nodes)
    local = edge
    if around is not None:
        local = around.local
        if length > 0.0:
            surround_midpoints(around, time, w, g, scalars, fine, edge)
    if not length > 0.0:
        return False
    while True:
        if not velocities(laws, w, n, length, scalars[TENSION], local, fine, y, work):
            return False
        if around is None:
            break
        settled = settle_midpoints(around, time, w, g, scalars, fine, work[0], edge)
        if settled == SETTLED:
            break
        if settled == UNSETTLED:
            return False
    spacing = length / nodes
    per_spacing = nodes / length
    turn = 2.0 * math.pi / nodes
    speed, stretch, bind, slide, flux = work[0], work[1], work[2], work[3], work[5]
    mean_stretch = total(stretch, nodes) / nodes
    for i in range(np.uint64(nodes)):
        j = i + _HALO
        slide[j] = speed[j] * g[j]
        stretch[j] = spacing * (mean_stretch * g[j] + change[j] - stretch[j])
        g_t[j] = change[j]
    area_t = spacing * total(slide, nodes)
    fill_halo(stretch, nodes)
    for i in range(np.uint64(nodes)):
        slide[i + _HALO] = cell_mean(stretch, i + _HALO)
    running_sum(slide, nodes)
    for i in range(np.uint64(nodes)):
        j = i + _HALO
        scale = per_spacing * fine_node[j]
        bend = turn + central_difference(w, j)
        w_t[j] = scale * (slide[j] * bend - difference_behind(speed, j))
        flux[j] = scale * difference_behind(n, j)
        stretch[j] = slide[j] * flux[j]
    fill_halo(slide, nodes)
    fill_halo(flux, nodes)
    fill_halo(stretch, nodes)
    diffusivity = local[2]
    for i in range(np.uint64(nodes)):
        j = i + _HALO
        spread = diffusivity[i] * (per_spacing * fine[j]) * difference_ahead(flux, j)
        n_t[j] = bind[j] + spread + mean_ahead(stretch, j)
    first_speed = mean_behind(speed, _HALO)
    scalars_t[LENGTH] = length * mean_stretch
    scalars_t[TENSION] = local[TENSION_RATE, 0] * area_t
    scalars_t[AREA] = area_t
    scalars_t[ORIGIN_X] = first_speed * sine(w[HALO])
    scalars_t[ORIGIN_Y] = -first_speed * cosine(w[HALO])
    return True


@called_by_address(NOTHING, ROW, ROWS, ROWS)
def renew_rates(laws: Any, y: np.ndarray, edge: np.ndarray, work: np.ndarray) -> None:
    """Make the off-rate at ``y`` in row `RATE` of ``work`` anew."""
    rate = work[RATE]
    for i in range(np.uint64(y.size)):
        rate[i] = off_rate(laws, y[i], edge, i)
