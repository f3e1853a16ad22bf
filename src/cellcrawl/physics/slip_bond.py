"""The off-rate of a slip bond from the force balance (equation 8), for kernels without a law set.

``friction(y, n) = F`` for ``y = log r >= 0``.

``friction`` rises and is convex in ``y`` for ``y >= 0``, so a pull ``F >= 0`` has exactly one root
with ``r >= 1``; ``F < 0`` has none there, and the model has left its range.
"""

from __future__ import annotations

import math

import numpy as np

from cellcrawl._compile import inlined_kernel, kernel
from cellcrawl.physics.exponential import exponential
from cellcrawl.physics.laws import driving_force, friction, friction_bend, friction_slope

SOLVED = -1  # what `solve_off_rate` returns when every node has its root
ROUND_OFF = 3e-14  # residual over (1 + F) below which the root is as good as rounding allows


@inlined_kernel
def halley_step(y: float, r: float, n: float, zeta_1: float, force: float) -> float:
    """Step in ``y`` towards ``friction(y, n) = force``; the error is cubed."""
    g = friction(y, r, n, zeta_1) - force
    slope = friction_slope(y, r, n, zeta_1)
    return -2.0 * g * slope / (2.0 * slope * slope - g * friction_bend(y, r))


@kernel
def balance(y: float, n: float, zeta_1: float, force: float) -> float:
    """``y = log r`` from any guess, by Newton steps that cannot miss; NaN if there is no root."""
    if not (force >= 0.0 and force < np.inf and n == n and zeta_1 * n >= 0.0):
        return np.nan
    highest = math.log1p(force)  # friction(highest) >= force, whatever n >= 0 is
    y = min(max(y, 0.0), highest) if y == y else highest
    for _ in range(100):
        r = math.exp(y)
        step = (friction(y, r, n, zeta_1) - force) / friction_slope(y, r, n, zeta_1)
        y_next = min(max(y - step, 0.0), highest)
        if abs(y_next - y) <= 1e-16 * (1.0 + y):
            return y_next
        y = y_next
    return y


@kernel
def solve_off_rate(
    y: np.ndarray,
    n: np.ndarray,
    sigma: float,
    kappa: np.ndarray,
    zeta_1: np.ndarray,
    sigma_c: np.ndarray,
    h: np.ndarray,
) -> int:
    """Solve every node in place from the last ``y``; return `SOLVED` or a node without a root.

    Two Halley steps reach rounding from a near guess and vectorise; nodes they do not settle are
    solved one by one. Arrays have shape (nodes,).
    """
    nodes = n.size
    unsettled = 0
    for i in range(nodes):
        force = driving_force(sigma, kappa[i], sigma_c[i], h[i])
        z = y[i]
        for _ in range(2):
            z = z + halley_step(z, exponential(z), n[i], zeta_1[i], force)
        residual = friction(z, exponential(z), n[i], zeta_1[i]) - force
        good = (abs(residual) <= ROUND_OFF * (1.0 + abs(force))) & (z >= 0.0)
        y[i] = z
        unsettled += 0 if good else 1
    if unsettled == 0:
        return SOLVED
    for i in range(nodes):
        y[i] = balance(y[i], n[i], zeta_1[i], driving_force(sigma, kappa[i], sigma_c[i], h[i]))
        if y[i] != y[i]:
            return i
    return SOLVED
