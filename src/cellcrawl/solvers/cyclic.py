"""Cyclic tridiagonal systems."""

from __future__ import annotations

import numpy as np

from cellcrawl._compile import kernel


@kernel
def solve_cyclic_tridiagonal(
    lower: np.ndarray, diagonal: np.ndarray, upper: np.ndarray, right: np.ndarray, work: np.ndarray
) -> None:
    """Solve ``lower[i] x[i-1] + diagonal[i] x[i] + upper[i] x[i+1] = right[i]``, indices wrapped.

    The solution replaces ``right``. Thomas elimination with a rank-one (Sherman-Morrison)
    correction for the two corners; the matrix must be diagonally dominant. ``work`` has shape
    (2, nodes).
    """
    nodes = right.size
    ratio, corner = work[0], work[1]
    gamma = -diagonal[0]
    pivot = diagonal[0] - gamma
    inverse = 1.0 / pivot
    ratio[0] = upper[0] * inverse
    right[0] = right[0] * inverse
    corner[0] = gamma * inverse
    for i in range(1, nodes):
        last = i == nodes - 1
        pivot = diagonal[i] - (lower[0] * upper[i] / gamma if last else 0.0)
        inverse = 1.0 / (pivot - lower[i] * ratio[i - 1])
        ratio[i] = upper[i] * inverse
        right[i] = (right[i] - lower[i] * right[i - 1]) * inverse
        corner[i] = ((upper[i] if last else 0.0) - lower[i] * corner[i - 1]) * inverse
    for i in range(nodes - 2, -1, -1):
        right[i] -= ratio[i] * right[i + 1]
        corner[i] -= ratio[i] * corner[i + 1]
    weight = lower[0] / gamma
    factor = (right[0] + weight * right[nodes - 1]) / (1.0 + corner[0] + weight * corner[nodes - 1])
    for i in range(nodes):
        right[i] -= factor * corner[i]
