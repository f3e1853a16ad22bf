"""One time step of the paper's scheme, and many.

State: tangent angle ``theta``, bound fraction ``n`` and ``y``, the force on a bond, at the nodes,
and the scalars length, tension, position of node 0 and area. The area is that of the shape, so that
the Euler step of ``sigma_t = G A_t`` keeps ``sigma - G A`` to rounding. Every step ends with the
outline closed again: angle and length advance apart, and nothing in their equations takes a gap
away.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from cellcrawl.laws.force_balance import SOLVED
from cellcrawl.laws.functions import binding, off_rate, partials, velocity
from cellcrawl.numerics.cyclic import solve_cyclic_tridiagonal
from cellcrawl.numerics.kernels import kernel
from cellcrawl.solvers.paper.tangent_angle import (
    central_difference,
    close,
    curvature,
    enclosed_area,
    points,
    tangential_velocity,
)
from cellcrawl.surroundings.place import balance_in_place

LENGTH, TENSION, ORIGIN_X, ORIGIN_Y, AREA, CLOSURE = range(6)  # rows of `scalars`
STEPPED = 0
NO_ROOT = 1
NOT_FINITE = 2
WORK_ROWS = 20


@kernel
def crank_nicolson(
    n: np.ndarray,
    bind: np.ndarray,
    loss: np.ndarray,
    tangential: np.ndarray,
    spacing: float,
    dt: float,
    diffusivity: np.ndarray,
    work: np.ndarray,
) -> None:
    """Advance ``n_t = B(n) + D n_ss + T n_s`` by ``dt`` in place; off-rate and ``T`` are held.

    ``bind`` is the binding ``B`` at ``n`` and ``loss`` its slope, less than 0. ``work`` has shape
    (6, nodes).
    """
    nodes = n.size
    lower, diagonal, upper, right = work[0], work[1], work[2], work[3]
    half = 0.5 * dt
    for i in range(nodes):
        spread = half * diffusivity[i] / (spacing * spacing)
        drift = half * tangential[i] / (2.0 * spacing)
        lower[i] = drift - spread
        upper[i] = -drift - spread
        diagonal[i] = 1.0 - half * loss[i] + 2.0 * spread
        before = n[i - 1] if i > 0 else n[nodes - 1]
        after = n[i + 1] if i < nodes - 1 else n[0]
        right[i] = (1.0 - half * loss[i] - 2.0 * spread) * n[i] + dt * bind[i]
        right[i] -= lower[i] * before + upper[i] * after
    solve_cyclic_tridiagonal(lower, diagonal, upper, right, work[4:6])
    for i in range(nodes):
        n[i] = right[i]


@kernel
def measure(
    theta: np.ndarray,
    scalars: np.ndarray,
    tension_rate: float,
    cosine: np.ndarray,
    sine: np.ndarray,
    kappa: np.ndarray,
    x: np.ndarray,
    z: np.ndarray,
    new: np.ndarray,
) -> None:
    """Close a new edge, and leave its shape from node 0 and its closure, area and tension.

    ``new`` has the length already; ``scalars`` are those of the edge before.
    """
    for i in range(theta.size):
        cosine[i] = math.cos(theta[i])
        sine[i] = math.sin(theta[i])
    close(theta, cosine, sine)
    curvature(theta, new[LENGTH], kappa)
    gap = points(new[LENGTH], cosine, sine, kappa, x, z)
    new[CLOSURE] = max(scalars[CLOSURE], gap)
    new[AREA] = enclosed_area(new[LENGTH], cosine, sine, x, z)
    new[TENSION] = scalars[TENSION] + tension_rate * (new[AREA] - scalars[AREA])


@kernel
def advance(
    laws: Any,
    around: Any,
    time: float,
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
    """Take up to ``steps`` steps in place, from ``time``.

    ``around`` is None, or surroundings at work, as in `cellcrawl.surroundings.place`; it then holds
    the parameters where the edge is at ``time``.

    ``edge`` holds the law's parameters, shape (rows, nodes); ``work`` has shape
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
    kappa, speed, slope, tangential = work[0], work[1], work[2], work[3]
    x, z, cosine, sine, r = work[4], work[5], work[6], work[7], work[8]
    new_theta, new_n, new_y, spare = work[9], work[10], work[11], work[12:18]
    bind, loss = work[18], work[19]
    new = scalars.copy()
    local = edge
    if around is not None:
        local = around.local
    for step in range(steps):
        length = scalars[LENGTH]
        curvature(theta, length, kappa)
        for i in range(nodes):
            r[i] = off_rate(laws, y[i], local, i)
            speed[i] = velocity(laws, y[i], r[i], scalars[TENSION], kappa[i], local, i)
        central_difference(speed, length / nodes, 0.0, slope)
        growth = tangential_velocity(kappa, speed, length, tangential, spare)

        for i in range(nodes):
            new_theta[i] = theta[i] + dt * (tangential[i] * kappa[i] - slope[i])
        new[LENGTH] = length + dt * length * growth
        new[ORIGIN_X] = scalars[ORIGIN_X] + dt * speed[0] * math.sin(theta[0])
        new[ORIGIN_Y] = scalars[ORIGIN_Y] - dt * speed[0] * math.cos(theta[0])
        if not (0.0 < new[LENGTH] < np.inf):
            return NOT_FINITE, 0, step

        measure(new_theta, scalars, tension_rate, cosine, sine, kappa, x, z, new)

        new_n[:] = n
        for i in range(nodes):
            bind[i] = binding(laws, y[i], r[i], n[i], local, i)
            _, _, _, _, _, _, _, _, loss[i] = partials(laws, y[i], r[i], n[i], 0.0, 0.0, local, i)
        spacing = new[LENGTH] / nodes
        crank_nicolson(new_n, bind, loss, tangential, spacing, dt, local[2], spare)
        new_y[:] = y
        if not (math.isfinite(new[TENSION]) and math.isfinite(new_n.sum() + kappa.sum())):
            return NOT_FINITE, _first_not_finite(new_n, kappa), step
        if around is not None:
            for i in range(nodes):
                x[i] += new[ORIGIN_X]
                z[i] += new[ORIGIN_Y]
        failed = balance_in_place(
            laws,
            around,
            time + (step + 1) * dt,
            x,
            z,
            cosine,
            sine,
            kappa,
            new[TENSION],
            new_n,
            new_y,
            edge,
        )
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
