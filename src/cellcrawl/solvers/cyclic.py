"""Cyclic tridiagonal systems: ``lower[i] x[i-1] + diagonal[i] x[i] + upper[i] x[i+1] = right[i]``.

Indices wrap. Gaussian elimination with a rank-one (Sherman-Morrison) correction for the two
corners; the matrices must be diagonally dominant.
"""

from __future__ import annotations

from typing import Final

import numpy as np

from cellcrawl._compile import kernel

_RATIO, _INVERSE, _UPPER, _CORNER, _SCALARS = range(5)
FACTOR_ROWS: Final = 5  # what `factor_cyclic_tridiagonal` leaves, each of shape (nodes,)


@kernel
def factor_cyclic_tridiagonal(
    lower: np.ndarray, diagonal: np.ndarray, upper: np.ndarray, factors: np.ndarray
) -> None:
    """Leave in ``factors``, shape (FACTOR_ROWS, nodes), what `solve_factored` needs."""
    nodes = diagonal.size
    ratio, inverse, scaled, corner = factors[0], factors[1], factors[2], factors[3]
    shift = -diagonal[0]
    last_diagonal = diagonal[nodes - 1] - lower[0] * upper[nodes - 1] / shift
    ratio[0] = 0.0
    inverse[0] = 1.0 / (diagonal[0] - shift)
    scaled[0] = upper[0] * inverse[0]
    corner[0] = shift
    for i in range(1, nodes):
        ratio[i] = lower[i] * inverse[i - 1]
        pivot = diagonal[i] if i < nodes - 1 else last_diagonal
        inverse[i] = 1.0 / (pivot - lower[i] * scaled[i - 1])
        scaled[i] = upper[i] * inverse[i]
        corner[i] = (upper[i] if i == nodes - 1 else 0.0) - ratio[i] * corner[i - 1]
    corner[nodes - 1] *= inverse[nodes - 1]
    for i in range(nodes - 2, -1, -1):
        corner[i] = corner[i] * inverse[i] - scaled[i] * corner[i + 1]
    weight = lower[0] / shift
    factors[_SCALARS, 0] = weight
    factors[_SCALARS, 1] = 1.0 / (1.0 + corner[0] + weight * corner[nodes - 1])


@kernel
def solve_factored(factors: np.ndarray, right: np.ndarray) -> None:
    """Replace ``right``, shape (nodes,), by the solution."""
    nodes = right.size
    ratio, inverse, scaled, corner = factors[0], factors[1], factors[2], factors[3]
    for i in range(1, nodes):
        right[i] -= ratio[i] * right[i - 1]
    solved = right[nodes - 1] * inverse[nodes - 1]
    right[nodes - 1] = solved
    for i in range(nodes - 2, -1, -1):
        solved = right[i] * inverse[i] - scaled[i] * solved
        right[i] = solved
    part = (right[0] + factors[_SCALARS, 0] * right[nodes - 1]) * factors[_SCALARS, 1]
    for i in range(nodes):
        right[i] -= part * corner[i]


@kernel
def solve_cyclic_tridiagonal(
    lower: np.ndarray, diagonal: np.ndarray, upper: np.ndarray, right: np.ndarray, work: np.ndarray
) -> None:
    """Replace ``right`` by the solution, in one go. ``work`` has shape (2, nodes)."""
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
