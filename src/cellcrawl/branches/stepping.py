"""The cell carried on by equal explicit steps: a smooth map of its first state.

Orbits and Lyapunov exponents need a flow that answers smoothly to its start: no choice of steps or
nodes may hang on it. The rates are those of the adaptive solver, on even nodes, with a tangential
velocity of mean zero: with another gauge the relabelling of the edge is no symmetry.
"""

from __future__ import annotations

from typing import Any, Final

import numpy as np

from cellcrawl.numerics.elementary import cosine, sine
from cellcrawl.numerics.kernels import kernel
from cellcrawl.solvers.adaptive.entries import ORIGIN_X, ORIGIN_Y
from cellcrawl.solvers.adaptive.rates import rates
from cellcrawl.solvers.adaptive.staggered import (
    HALO,
    central_difference,
    mean_ahead,
    total,
)

STAGE_ROWS: Final = 6
_HALO = np.uint64(HALO)
# classical method of order 4: where its stages lie, and their weights
_NODES = np.array([0.0, 0.5, 0.5, 1.0])
_WEIGHTS = np.array([1.0 / 6.0, 1.0 / 3.0, 1.0 / 3.0, 1.0 / 6.0])


@kernel
def centred_rates(
    laws: Any,
    state: np.ndarray,
    out: np.ndarray,
    y: np.ndarray,
    edge: np.ndarray,
    mesh: np.ndarray,
    work: np.ndarray,
) -> bool:
    """Write the rates of a state on even nodes; False where there is no off-rate.

    The arguments are those of `rates`; ``work`` has a row more.
    """
    if not rates(laws, None, 0.0, state, out, y, edge, mesh, work):
        return False
    nodes = y.size
    span = nodes + 2 * HALO
    w, w_t, n_t = state[:span], out[:span], out[span : 2 * span]
    slide, flux = work[3], work[5]
    drift = total(slide, nodes) / nodes
    turn = 2.0 * np.pi / nodes
    scale = drift * nodes / state[3 * span]
    for i in range(np.uint64(nodes)):
        j = i + _HALO
        w_t[j] -= scale * (turn + central_difference(w, j))
        n_t[j] -= drift * mean_ahead(flux, j)
        out[2 * span + j] = 0.0
    out[3 * span + ORIGIN_X] -= drift * cosine(w[HALO])
    out[3 * span + ORIGIN_Y] -= drift * sine(w[HALO])
    return True


@kernel
def advance(
    laws: Any,
    steps: int,
    h: float,
    state: np.ndarray,
    y: np.ndarray,
    edge: np.ndarray,
    mesh: np.ndarray,
    work: np.ndarray,
    stages: np.ndarray,
) -> bool:
    """Make ``steps`` classical steps of order 4 in place; False where the model has no rates."""
    slope, sum_of, now = stages[0], stages[1], stages[2]
    size = state.size
    for _ in range(steps):
        for k in range(size):
            sum_of[k] = 0.0
            slope[k] = 0.0
        for stage in range(4):
            reach = h * _NODES[stage]
            for k in range(size):
                now[k] = state[k] + reach * slope[k]
            if not centred_rates(laws, now, slope, y, edge, mesh, work):
                return False
            weight = _WEIGHTS[stage]
            for k in range(size):
                sum_of[k] += weight * slope[k]
        for k in range(size):
            state[k] += h * sum_of[k]
        if not abs(state[size // 2]) < 1e6:
            return False
    return True


@kernel
def advance_stabilised(
    laws: Any,
    steps: int,
    h: float,
    coefficients: np.ndarray,
    state: np.ndarray,
    y: np.ndarray,
    edge: np.ndarray,
    mesh: np.ndarray,
    work: np.ndarray,
    stages: np.ndarray,
) -> bool:
    """Make ``steps`` Runge-Kutta-Chebyshev steps of order 2; ``coefficients`` by `chebyshev`."""
    size, count = state.size, coefficients.shape[0]
    first = stages[0]
    for _ in range(steps):
        if not centred_rates(laws, state, first, y, edge, mesh, work):
            return False
        before, last, slope = 1, 2, stages[4]
        for k in range(size):
            stages[1, k] = state[k]
            stages[2, k] = state[k] + coefficients[0, 2] * h * first[k]
        following = 3
        for stage in range(1, count):
            mu, nu, mu_rate, gamma = coefficients[stage]
            if not centred_rates(laws, stages[last], slope, y, edge, mesh, work):
                return False
            for k in range(size):
                stages[following, k] = (
                    (1.0 - mu - nu) * state[k]
                    + mu * stages[last, k]
                    + nu * stages[before, k]
                    + h * (mu_rate * slope[k] + gamma * first[k])
                )
            before, last, following = last, following, before
        for k in range(size):
            state[k] = stages[last, k]
        if not abs(state[size // 2]) < 1e6:
            return False
    return True


def chebyshev(stages: int) -> np.ndarray:
    """Coefficients of the Runge-Kutta-Chebyshev method of order 2, shape (stages, 4).

    ``mu, nu, mu~, gamma~`` of each stage (Sommeijer, Shampine & Verwer, J. Comput. Appl. Math. 88,
    1997); stable for real growth rates down to ``-0.653 (stages^2 - 1) / h``.
    """
    damping = 2.0 / 13.0
    w0 = 1.0 + damping / stages**2
    t, dt, ddt = np.empty((3, stages + 1))
    t[0], t[1], dt[0], dt[1], ddt[0], ddt[1] = 1.0, w0, 0.0, 1.0, 0.0, 0.0
    for j in range(2, stages + 1):
        t[j] = 2.0 * w0 * t[j - 1] - t[j - 2]
        dt[j] = 2.0 * (t[j - 1] + w0 * dt[j - 1]) - dt[j - 2]
        ddt[j] = 2.0 * (2.0 * dt[j - 1] + w0 * ddt[j - 1]) - ddt[j - 2]
    w1 = dt[stages] / ddt[stages]
    b = np.empty(stages + 1)
    b[2:] = ddt[2:] / dt[2:] ** 2
    b[0] = b[1] = b[2]
    made = np.zeros((stages, 4))
    made[0] = 0.0, 0.0, b[1] * w1, 0.0
    for j in range(2, stages + 1):
        mu = 2.0 * b[j] * w0 / b[j - 1]
        rate = 2.0 * b[j] * w1 / b[j - 1]
        made[j - 1] = mu, -b[j] / b[j - 2], rate, -(1.0 - b[j - 1] * t[j - 1]) * rate
    return made
