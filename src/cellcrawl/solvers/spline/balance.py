"""Velocities from the force balance, and the tension in step with the off-rate it causes.

Kernels use the paper's letters: ``n`` bound fraction, ``y`` force on a bond, ``sigma`` tension.
``edge`` holds the law's parameters, shape (rows, markers).
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from cellcrawl.laws.force_balance import SOLVED, solve_bonds
from cellcrawl.laws.functions import binding, off_rate, partials, velocity
from cellcrawl.numerics.kernels import kernel
from cellcrawl.solvers.spline.outline import KAPPA, LOG_R, SPEED, XU, YU, N, X, Y
from cellcrawl.surroundings.place import balance_in_place

BALANCED, NO_ROOT, NOT_FINITE, NEGATIVE, UNSETTLED = range(5)
_TOLERANCE = 1e-12  # of the tension, relative
_MOST_ITERATIONS = 25


@kernel
def solve_balance(
    laws: Any, fields: np.ndarray, sigma: float, shape: np.ndarray, edge: np.ndarray
) -> tuple[int, int]:
    """Off-rate of every marker in place from its last value; a code and the marker it is about."""
    failed = solve_bonds(laws, fields[LOG_R], fields[N], sigma, shape[KAPPA], edge)
    return _told(failed, fields, sigma, shape)


@kernel
def solve_balance_in_place(
    laws: Any,
    around: Any,
    time: float,
    fields: np.ndarray,
    sigma: float,
    shape: np.ndarray,
    edge: np.ndarray,
) -> tuple[int, int]:
    """The same after the parameters in place, which `around` then holds if it is not None."""
    failed = balance_in_place(
        laws,
        around,
        time,
        fields[X],
        fields[Y],
        shape[XU],
        shape[YU],
        shape[KAPPA],
        sigma,
        fields[N],
        fields[LOG_R],
        edge,
    )
    return _told(failed, fields, sigma, shape)


@kernel
def _told(failed: int, fields: np.ndarray, sigma: float, shape: np.ndarray) -> tuple[int, int]:
    """A code and a marker from what `solve_bonds` returns."""
    n, kappa = fields[N], shape[KAPPA]
    if failed == SOLVED:
        return BALANCED, 0
    for i in range(n.size):
        if not math.isfinite(n[i] + kappa[i] + sigma):
            return NOT_FINITE, i
    return (NEGATIVE if n[failed] < 0.0 else NO_ROOT), failed


@kernel
def solve_tension(
    laws: Any,
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
        code, marker = solve_balance(laws, fields, sigma, shape, edge)
        if code != BALANCED:
            return code, marker, sigma
        area_rate = slope = 0.0
        for i in range(n.size):
            r = off_rate(laws, y[i], edge, i)
            g, kappa = shape[SPEED, i], shape[KAPPA, i]
            area_rate += g * velocity(laws, y[i], r, sigma, kappa, edge, i)
            by_phi, _, by_sigma, _, u_phi, u_sigma, _, _, _ = partials(
                laws, y[i], r, n[i], sigma, kappa, edge, i
            )
            slope += g * (u_sigma - u_phi * by_sigma / by_phi)
        change = (known + weight * area_rate - sigma) / (1.0 - weight * slope)
        if abs(change) <= _TOLERANCE * (1.0 + abs(sigma)):
            return BALANCED, 0, sigma
        sigma += change
    return UNSETTLED, 0, sigma


@kernel
def rates(
    laws: Any,
    fields: np.ndarray,
    sigma: float,
    shape: np.ndarray,
    edge: np.ndarray,
    out: np.ndarray,
) -> float:
    """Velocity of the markers and binding of linkers in rows x, y, n; returns ``dA/dt``."""
    y, n = fields[LOG_R], fields[N]
    area_rate = 0.0
    for i in range(n.size):
        r = off_rate(laws, y[i], edge, i)
        speed = velocity(laws, y[i], r, sigma, shape[KAPPA, i], edge, i)
        per_speed = speed / shape[SPEED, i]
        out[X, i] = per_speed * shape[YU, i]
        out[Y, i] = -per_speed * shape[XU, i]
        out[N, i] = binding(laws, y[i], r, n[i], edge, i)
        area_rate += speed * shape[SPEED, i]
    return area_rate


@kernel
def fastest_explicit_rate(
    laws: Any,
    fields: np.ndarray,
    sigma: float,
    shape: np.ndarray,
    edge: np.ndarray,
    zigzag: float,
) -> float:
    """Bound on the decay rates that are stepped explicitly: curvature smoothing and binding.

    A shape wave of height 1 from marker to marker has a curvature of ``zigzag / g**2``.
    """
    y, n = fields[LOG_R], fields[N]
    smoothing = losing = 0.0
    for i in range(n.size):
        r = off_rate(laws, y[i], edge, i)
        g = shape[SPEED, i]
        by_phi, _, _, by_kappa, u_phi, _, u_kappa, _, b_n = partials(
            laws, y[i], r, n[i], sigma, shape[KAPPA, i], edge, i
        )
        pull = abs(u_kappa - u_phi * by_kappa / by_phi)
        smoothing = max(smoothing, zigzag * pull / (g * g))
        losing = max(losing, -b_n)
    return smoothing + losing
