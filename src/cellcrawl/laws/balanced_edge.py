"""An edge in balance and at rest, in kernels: Python gets the same bits."""

from __future__ import annotations

from typing import Any, Final

import numpy as np

from cellcrawl.laws.functions import balance, binding, off_rate, partials, velocity
from cellcrawl.numerics.kernels import inlined_kernel

TRIALS: Final = 2400  # forces on a bond at which a change of sign is looked for
_HALVINGS: Final = 200
_NEWTON_STEPS: Final = 30
_ROUND_OFF: Final = 1e-14
_BY_N_OF_BINDING, _BY_SIGMA_OF_BALANCE = 8, 2  # of `partials`


@inlined_kernel
def trial_force(k: int) -> float:
    """Force on a bond number ``k`` of those looked at: denser below 1."""
    return 1e-6 + k * 0.0025 if k < 400 else 1.0 + (k - 400) * 0.0195


@inlined_kernel
def at_bond_force(
    laws: Any, phi: float, kappa: float, edge: np.ndarray
) -> tuple[float, float, float, float]:
    """Velocity of an edge whose bonds bear ``phi``, off-rate, bound fraction and tension.

    ``edge`` holds the local parameters, shape (rows, 1).
    """
    r = off_rate(laws, phi, edge, 0)
    n = 0.5
    for _ in range(_NEWTON_STEPS):
        slope = partials(laws, phi, r, n, 0.0, kappa, edge, 0)[_BY_N_OF_BINDING]
        step = binding(laws, phi, r, n, edge, 0) / slope
        n = n - step
        if not abs(step) > _ROUND_OFF * (1.0 + abs(n)):
            break
    sigma = 1000.0
    for _ in range(_NEWTON_STEPS):
        slope = partials(laws, phi, r, n, sigma, kappa, edge, 0)[_BY_SIGMA_OF_BALANCE]
        step = balance(laws, phi, r, n, sigma, kappa, edge, 0)[0] / slope
        sigma = sigma - step
        if not abs(step) > _ROUND_OFF * (1.0 + abs(sigma)):
            break
    return velocity(laws, phi, r, sigma, kappa, edge, 0), r, n, sigma


@inlined_kernel
def force_at_rest(laws: Any, low: float, high: float, kappa: float, edge: np.ndarray) -> float:
    """Force on a bond at which the edge rests, between two at which it moves in and out."""
    outward = at_bond_force(laws, low, kappa, edge)[0] > 0.0
    for _ in range(_HALVINGS):
        middle = 0.5 * (low + high)
        if middle in (low, high):
            break
        if (at_bond_force(laws, middle, kappa, edge)[0] > 0.0) == outward:
            low = middle
        else:
            high = middle
    return low
