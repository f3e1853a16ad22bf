"""Velocities from the force balance, and the tension in step with the off-rate it causes.

Kernels use the paper's letters: ``n`` bound fraction, ``y = log r``, ``sigma`` tension. ``edge``
has shape (7, markers): r_on, zeta_1, D, epsilon, h, sigma_c, v_p.
"""

from __future__ import annotations

import math

import numpy as np

from cellcrawl._compile import kernel
from cellcrawl.physics.exponential import exponential
from cellcrawl.physics.force_balance import SOLVED, solve_off_rate
from cellcrawl.physics.laws import binding_rate, edge_velocity, friction_slope
from cellcrawl.solvers.spline.outline import KAPPA, LOG_R, SPEED, XU, YU, N, X, Y

R_ON, ZETA_1, _, EPSILON, H, SIGMA_C, V_P = range(7)  # rows of `edge`
BALANCED, NO_ROOT, NOT_FINITE, NEGATIVE, UNSETTLED = range(5)
_TOLERANCE = 1e-12  # of the tension, relative
_MOST_ITERATIONS = 25


@kernel
def solve_balance(
    fields: np.ndarray, sigma: float, shape: np.ndarray, edge: np.ndarray
) -> tuple[int, int]:
    """Off-rate of every marker in place from its last value; a code and the marker it is about."""
    y, n, kappa = fields[LOG_R], fields[N], shape[KAPPA]
    failed = solve_off_rate(y, n, sigma, kappa, edge[ZETA_1], edge[SIGMA_C], edge[H])
    if failed == SOLVED:
        return BALANCED, 0
    for i in range(n.size):
        if not math.isfinite(n[i] + kappa[i] + sigma):
            return NOT_FINITE, i
    return (NEGATIVE if n[failed] < 0.0 else NO_ROOT), failed


@kernel
def solve_tension(
    fields: np.ndarray,
    guess: float,
    known: float,
    weight: float,
    shape: np.ndarray,
    edge: np.ndarray,
) -> tuple[int, int, float]:
    """Tension with ``sigma = known + weight * dA/dt`` and the off-rate that goes with it.

    ``dA/dt`` falls as the tension rises, since every off-rate rises with it: one equation for one
    number, solved by Newton's method, however stiff (``weight`` is a time times ``G``). ``y`` is
    solved in place. Returns a code, the marker it is about, and the tension.
    """
    y, n = fields[LOG_R], fields[N]
    sigma = guess
    for _ in range(_MOST_ITERATIONS):
        code, marker = solve_balance(fields, sigma, shape, edge)
        if code != BALANCED:
            return code, marker, sigma
        area_rate = slope = 0.0
        for i in range(n.size):
            r = exponential(y[i])
            epsilon, g = edge[EPSILON, i], shape[SPEED, i]
            area_rate += g * edge_velocity(y[i], r, edge[V_P, i], epsilon)
            # the slope of the retrograde velocity is that of the friction without linkers
            yielding = friction_slope(y[i], r, 0.0, 0.0) / friction_slope(
                y[i], r, n[i], edge[ZETA_1, i]
            )
            slope -= g * epsilon * yielding * (1.0 + shape[KAPPA, i] * edge[H, i])
        change = (known + weight * area_rate - sigma) / (1.0 - weight * slope)
        if abs(change) <= _TOLERANCE * (1.0 + abs(sigma)):
            return BALANCED, 0, sigma
        sigma += change
    return UNSETTLED, 0, sigma


@kernel
def rates(
    fields: np.ndarray,
    shape: np.ndarray,
    edge: np.ndarray,
    out: np.ndarray,
) -> float:
    """Velocity of the markers and binding of linkers in rows x, y, n; returns ``dA/dt``."""
    y, n = fields[LOG_R], fields[N]
    area_rate = 0.0
    for i in range(n.size):
        r = exponential(y[i])
        velocity = edge_velocity(y[i], r, edge[V_P, i], edge[EPSILON, i])
        per_speed = velocity / shape[SPEED, i]
        out[X, i] = per_speed * shape[YU, i]
        out[Y, i] = -per_speed * shape[XU, i]
        out[N, i] = binding_rate(n[i], r, edge[R_ON, i])
        area_rate += velocity * shape[SPEED, i]
    return area_rate


@kernel
def fastest_explicit_rate(
    fields: np.ndarray, sigma: float, shape: np.ndarray, edge: np.ndarray, zigzag: float
) -> float:
    """Bound on the decay rates that are stepped explicitly: curvature smoothing and binding.

    A shape wave of height 1 from marker to marker has a curvature of ``zigzag / g**2``.
    """
    y, n = fields[LOG_R], fields[N]
    smoothing = binding = 0.0
    for i in range(n.size):
        r = exponential(y[i])
        g = shape[SPEED, i]
        yielding = friction_slope(y[i], r, 0.0, 0.0) / friction_slope(
            y[i], r, n[i], edge[ZETA_1, i]
        )
        pull = edge[EPSILON, i] * edge[H, i] * abs(sigma) * yielding
        smoothing = max(smoothing, zigzag * pull / (g * g))
        binding = max(binding, edge[R_ON, i] + r)
    return smoothing + binding
