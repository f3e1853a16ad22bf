"""The force on the bonds from the force balance, ``balance(phi) = 0`` for ``phi >= 0``.

For the paper's bonds ``phi = log r`` (equation 8). Their balance rises and is convex for
``phi >= 0``, so a pull of 0 or more has exactly one root; below there is none, and the model has
left its range.
With other bonds the balance may fall somewhere: a root where it does is none to stay at, and counts
as no root.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from cellcrawl.laws.functions import balance, friction, off_rate
from cellcrawl.numerics.kernels import inlined_kernel, kernel

SOLVED = -1  # what `solve_bonds` returns when every node has its root
ROUND_OFF = 3e-14  # residual over 1 + friction below which the root is as good as rounding allows
_STRONGEST = 700.0  # force on a bond at which an exponential ends


@inlined_kernel
def halley_step(
    laws: Any, phi: float, r: float, n: float, sigma: float, kappa: float, edge: np.ndarray, i: int
) -> float:
    """Step in ``phi`` towards the root of the balance; the error is cubed."""
    g, slope, bend = balance(laws, phi, r, n, sigma, kappa, edge, i)
    step: float = -2.0 * g * slope / (2.0 * slope * slope - g * bend)
    return step


@kernel
def bond_force(
    laws: Any, phi: float, n: float, sigma: float, kappa: float, edge: np.ndarray, i: int
) -> float:
    """``phi`` from any guess, by Newton steps that cannot miss; NaN if there is no root."""
    low, high = 0.0, 1.0
    g, slope, _ = balance(laws, low, off_rate(laws, low, edge, i), n, sigma, kappa, edge, i)
    if not (g <= 0.0 and g > -np.inf and n >= 0.0):
        return np.nan
    while True:
        g, slope, _ = balance(laws, high, off_rate(laws, high, edge, i), n, sigma, kappa, edge, i)
        if g >= 0.0:
            break
        low, high = high, 2.0 * high
        if not high < _STRONGEST:
            return np.nan
    phi = min(max(phi, low), high) if phi == phi else high
    for _ in range(200):
        g, slope, _ = balance(laws, phi, off_rate(laws, phi, edge, i), n, sigma, kappa, edge, i)
        if g > 0.0:
            high = phi
        else:
            low = phi
        step = g / slope
        after = phi - step
        if not (low <= after <= high):
            after = 0.5 * (low + high)
        if abs(after - phi) <= 1e-16 * (1.0 + phi):
            phi = after
            break
        phi = after
    return phi if slope > 0.0 else np.nan


@kernel
def solve_bonds(
    laws: Any, phi: np.ndarray, n: np.ndarray, sigma: float, kappa: np.ndarray, edge: np.ndarray
) -> int:
    """Solve every node in place from the last ``phi``; return `SOLVED` or a node without a root.

    Two Halley steps reach rounding from a near guess and vectorise; nodes they do not settle are
    solved one by one. Arrays have shape (nodes,), ``edge`` (rows, nodes).
    """
    nodes = n.size
    unsettled = 0
    for i in range(nodes):  # as in `bond_force_near`, without the branch
        z = phi[i]
        for _ in range(2):
            r = off_rate(laws, z, edge, i)
            z = z + halley_step(laws, z, r, n[i], sigma, kappa[i], edge, i)
        r = off_rate(laws, z, edge, i)
        g, slope, _ = balance(laws, z, r, n[i], sigma, kappa[i], edge, i)
        scale = 1.0 + abs(friction(laws, z, r, n[i], edge, i))
        good = (abs(g) <= ROUND_OFF * scale) & (z >= 0.0) & (slope > 0.0)
        phi[i] = z
        unsettled += 0 if good else 1
    if unsettled == 0:
        return SOLVED
    for i in range(nodes):
        phi[i] = bond_force(laws, phi[i], n[i], sigma, kappa[i], edge, i)
        if phi[i] != phi[i]:
            return i
    return SOLVED


@kernel
def bond_force_near(
    laws: Any, phi: float, n: float, sigma: float, kappa: float, edge: np.ndarray, i: int
) -> float:
    """Like `bond_force` from a guess that is usually near: two Halley steps, or the search."""
    z = phi
    for _ in range(2):
        r = off_rate(laws, z, edge, i)
        z = z + halley_step(laws, z, r, n, sigma, kappa, edge, i)
    r = off_rate(laws, z, edge, i)
    g, slope, _ = balance(laws, z, r, n, sigma, kappa, edge, i)
    scale = 1.0 + abs(friction(laws, z, r, n, edge, i))
    if abs(g) <= ROUND_OFF * scale and z >= 0.0 and slope > 0.0:
        return z
    return bond_force(laws, phi, n, sigma, kappa, edge, i)
