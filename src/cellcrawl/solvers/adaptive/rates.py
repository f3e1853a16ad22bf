"""Rates of change of the whole state on the staggered grid, and how stiff they are.

A state is one flat array: ``w = theta - winding`` at the nodes, ``n`` and the density ``g`` of the
arclength at the midpoints, all with halos, then the scalars length, tension, area and position of
node 0. Between nodes lies an arclength of ``L g / nodes``. Kernels use the paper's letters: ``U``
edge velocity, ``T`` tangential velocity of the nodes, ``y = log r``.
"""

from __future__ import annotations

import math
from typing import Final

import numpy as np

from cellcrawl._compile import inlined_kernel, kernel, woven_kernel
from cellcrawl.physics.exponential import exponential
from cellcrawl.physics.force_balance import SOLVED, halley_step, solve_off_rate
from cellcrawl.physics.laws import (
    binding_rate,
    driving_force,
    edge_velocity,
)
from cellcrawl.solvers.adaptive.mesh import CHANGE, FINE, FINE_NODE
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

LENGTH, TENSION, AREA, ORIGIN_X, ORIGIN_Y = range(5)  # scalars, after the two fields
SCALARS: Final = 8  # room kept for them
FIELDS: Final = 3
TENSION_RATE: Final = 7  # row of `edge` after the local parameters
WORK_ROWS: Final = 6
RATE: Final = 4  # row of `work` that keeps r beside the last y, from stage to stage
_HALO = np.uint64(HALO)
_NEAR = 0.12  # a first step in log r this short is followed by a second that reaches rounding
_SETTLED = 4e-6  # a second step this short leaves an error of its cube


@inlined_kernel
def growth(x: float) -> float:
    """``exp(x)`` to rounding for |x| < 0.12."""
    p = 1.0 / 40320.0
    p = p * x + 1.0 / 5040.0
    p = p * x + 1.0 / 720.0
    p = p * x + 1.0 / 120.0
    p = p * x + 1.0 / 24.0
    p = p * x + 1.0 / 6.0
    p = p * x + 0.5
    p = p * x + 1.0
    return p * x + 1.0


@woven_kernel
def velocities(
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

    Leaves ``log r`` in ``y``, shape (nodes,), and in the rows of ``work``, which have halos: ``U``,
    ``g kappa U`` and ``r_on (1 - n) - r n``. Row `RATE` must hold ``exp(y)``, where `renew_rates`
    puts it. ``fine`` is ``1 / g``.
    """
    nodes = y.size
    per_spacing = nodes / length
    winding = 2.0 * math.pi / length
    r_on, zeta_1, epsilon = edge[0], edge[1], edge[3]
    h, sigma_c, v_p = edge[4], edge[5], edge[6]
    speed, stretch, binding, kappa, rate = work[0], work[1], work[2], work[3], work[RATE]
    unsettled = 0
    for i in range(np.uint64(nodes)):
        j = i + _HALO
        bend = winding + per_spacing * difference_ahead(w, j)
        stretch[j] = bend
        kappa[i] = bend * fine[j]
        force = driving_force(sigma, kappa[i], sigma_c[i], h[i])
        near = y[i]
        r = rate[i]
        first = halley_step(near, r, n[j], zeta_1[i], force)
        near = near + first
        r = r * growth(first)
        second = halley_step(near, r, n[j], zeta_1[i], force)
        near = near + second
        rate[i] = r * (1.0 + second * (1.0 + 0.5 * second))
        good = (abs(first) < _NEAR) & (abs(second) < _SETTLED) & (near >= 0.0) & (r > 0.5)
        unsettled += 0 if good else 1
        y[i] = near
    if unsettled > 0:
        bound = n[HALO : HALO + nodes]
        if solve_off_rate(y, bound, sigma, kappa[:nodes], zeta_1, sigma_c, h) != SOLVED:
            return False
        for i in range(np.uint64(nodes)):
            rate[i] = exponential(y[i])
    for i in range(np.uint64(nodes)):
        j = i + _HALO
        speed[j] = edge_velocity(y[i], rate[i], v_p[i], epsilon[i])
        binding[j] = binding_rate(n[j], rate[i], r_on[i])
        stretch[j] *= speed[j]
    fill_halo(speed, nodes)
    return True


@kernel
def rates(
    state: np.ndarray,
    out: np.ndarray,
    y: np.ndarray,
    edge: np.ndarray,
    mesh: np.ndarray,
    work: np.ndarray,
) -> bool:
    """Write the rates of change of ``state`` to ``out``; False where there is no off-rate.

    Fills the halos of ``state``. ``y`` is the last ``log r`` and becomes the new one. ``edge``
    holds the parameters at the midpoints and in its last row G, shape (8, nodes); ``mesh`` what
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
    if not (length > 0.0 and velocities(w, n, length, scalars[TENSION], edge, fine, y, work)):
        return False
    spacing = length / nodes
    per_spacing = nodes / length
    turn = 2.0 * math.pi / nodes
    speed, stretch, binding, slide, flux = work[0], work[1], work[2], work[3], work[5]
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
    diffusivity = edge[2]
    for i in range(np.uint64(nodes)):
        j = i + _HALO
        spread = diffusivity[i] * (per_spacing * fine[j]) * difference_ahead(flux, j)
        n_t[j] = binding[j] + spread + mean_ahead(stretch, j)
    first_speed = mean_behind(speed, _HALO)
    scalars_t[LENGTH] = length * mean_stretch
    scalars_t[TENSION] = edge[TENSION_RATE, 0] * area_t
    scalars_t[AREA] = area_t
    scalars_t[ORIGIN_X] = first_speed * math.sin(w[HALO])
    scalars_t[ORIGIN_Y] = -first_speed * math.cos(w[HALO])
    return True


@kernel
def renew_rates(y: np.ndarray, work: np.ndarray) -> None:
    """Make ``r = exp(y)`` in row `RATE` of ``work`` anew."""
    rate = work[RATE]
    for i in range(np.uint64(y.size)):
        rate[i] = exponential(y[i])
