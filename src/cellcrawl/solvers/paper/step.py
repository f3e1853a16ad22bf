"""One time step of the paper's scheme, and many.

State: tangent angle ``theta``, bound fraction ``n`` and ``y = log r`` at the nodes, and the scalars
length, tension, position of node 0 and area. The area is that of the shape, so the Euler step of
``sigma_t = G A_t`` keeps ``sigma - G A`` to rounding. Every step ends with the outline closed
again: angle and length advance apart, and nothing in their equations takes a gap away.
"""

from __future__ import annotations

import math

import numpy as np

from cellcrawl._compile import kernel
from cellcrawl.physics.exponential import exponential
from cellcrawl.physics.force_balance import SOLVED, solve_off_rate
from cellcrawl.physics.laws import edge_velocity
from cellcrawl.solvers.cyclic import solve_cyclic_tridiagonal
from cellcrawl.solvers.paper.tangent_angle import (
    central_difference,
    close,
    curvature,
    enclosed_area,
    points,
    tangential_velocity,
)

LENGTH, TENSION, ORIGIN_X, ORIGIN_Y, AREA, CLOSURE = range(6)  # rows of `scalars`
STEPPED = 0
NO_ROOT = 1
NOT_FINITE = 2
WORK_ROWS = 18


@kernel
def crank_nicolson(
    n: np.ndarray,
    r: np.ndarray,
    tangential: np.ndarray,
    spacing: float,
    dt: float,
    r_on: np.ndarray,
    diffusivity: np.ndarray,
    work: np.ndarray,
) -> None:
    """Advance ``n_t = r_on (1 - n) - r n + D n_ss + T n_s`` by ``dt`` in place; ``r``, ``T`` held.

    ``work`` has shape (6, nodes).
    """
    nodes = n.size
    lower, diagonal, upper, right = work[0], work[1], work[2], work[3]
    half = 0.5 * dt
    for i in range(nodes):
        spread = half * diffusivity[i] / (spacing * spacing)
        drift = half * tangential[i] / (2.0 * spacing)
        lower[i] = drift - spread
        upper[i] = -drift - spread
        diagonal[i] = 1.0 + half * (r_on[i] + r[i]) + 2.0 * spread
    for i in range(nodes):
        before = n[i - 1] if i > 0 else n[nodes - 1]
        after = n[i + 1] if i < nodes - 1 else n[0]
        right[i] = (2.0 - diagonal[i]) * n[i] - lower[i] * before - upper[i] * after + dt * r_on[i]
    solve_cyclic_tridiagonal(lower, diagonal, upper, right, work[4:6])
    for i in range(nodes):
        n[i] = right[i]


@kernel
def advance(
    steps: int,
    dt: float,
    tension_rate: float,
    edge: np.ndarray,
    theta: np.ndarray,
    n: np.ndarray,
    y: np.ndarray,
    scalars: np.ndarray,
    work: np.ndarray,
) -> tuple[int, int, int]:
    """Take up to ``steps`` steps in place.

    ``edge`` has shape (7, nodes): r_on, zeta_1, D, epsilon, h, sigma_c, v_p. ``work`` has shape
    (WORK_ROWS, nodes).

    Returns
    -------
    code : int
        `STEPPED`, or why the next step cannot be taken: `NO_ROOT` or `NOT_FINITE`. The state is
        then the last valid one.
    node : int
        The node it happened at.
    taken : int
        Steps taken.
    """
    nodes = theta.size
    r_on, zeta_1, diffusivity = edge[0], edge[1], edge[2]
    epsilon, h, sigma_c, v_p = edge[3], edge[4], edge[5], edge[6]
    kappa, velocity, slope, tangential = work[0], work[1], work[2], work[3]
    x, z, cosine, sine, r = work[4], work[5], work[6], work[7], work[8]
    new_theta, new_n, new_y, spare = work[9], work[10], work[11], work[12:18]
    new = scalars.copy()
    for step in range(steps):
        length = scalars[LENGTH]
        for i in range(nodes):
            r[i] = exponential(y[i])
            velocity[i] = edge_velocity(y[i], r[i], v_p[i], epsilon[i])
        curvature(theta, length, kappa)
        central_difference(velocity, length / nodes, 0.0, slope)
        growth = tangential_velocity(kappa, velocity, length, tangential, spare)

        for i in range(nodes):
            new_theta[i] = theta[i] + dt * (tangential[i] * kappa[i] - slope[i])
        new[LENGTH] = length + dt * length * growth
        new[ORIGIN_X] = scalars[ORIGIN_X] + dt * velocity[0] * math.sin(theta[0])
        new[ORIGIN_Y] = scalars[ORIGIN_Y] - dt * velocity[0] * math.cos(theta[0])
        if not (0.0 < new[LENGTH] < np.inf):
            return NOT_FINITE, 0, step

        for i in range(nodes):
            cosine[i] = math.cos(new_theta[i])
            sine[i] = math.sin(new_theta[i])
        close(new_theta, cosine, sine)
        curvature(new_theta, new[LENGTH], kappa)
        gap = points(new[LENGTH], cosine, sine, kappa, x, z)
        new[CLOSURE] = max(scalars[CLOSURE], gap)
        new[AREA] = enclosed_area(new[LENGTH], cosine, sine, x, z)
        new[TENSION] = scalars[TENSION] + tension_rate * (new[AREA] - scalars[AREA])

        new_n[:] = n
        crank_nicolson(new_n, r, tangential, new[LENGTH] / nodes, dt, r_on, diffusivity, spare)
        new_y[:] = y
        if not (math.isfinite(new[TENSION]) and math.isfinite(new_n.sum() + kappa.sum())):
            return NOT_FINITE, _first_not_finite(new_n, kappa), step
        failed = solve_off_rate(new_y, new_n, new[TENSION], kappa, zeta_1, sigma_c, h)
        if failed != SOLVED:
            return NO_ROOT, failed, step

        theta[:] = new_theta
        n[:] = new_n
        y[:] = new_y
        scalars[:] = new
    return STEPPED, 0, steps


@kernel
def _first_not_finite(n: np.ndarray, kappa: np.ndarray) -> int:
    for i in range(n.size):
        if not math.isfinite(n[i] + kappa[i]):
            return i
    return 0
