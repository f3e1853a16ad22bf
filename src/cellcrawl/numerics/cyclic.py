"""Cyclic tridiagonal systems: ``lower[i] x[i-1] + diagonal[i] x[i] + upper[i] x[i+1] = right[i]``.

Indices wrap. Gaussian elimination with a rank-one (Sherman-Morrison) correction for the two
corners; the matrices must be diagonally dominant.
"""

from __future__ import annotations

from typing import Final

import numpy as np

from cellcrawl.numerics.kernels import kernel

_INWARD, _INVERSE, _OUTWARD, _CORNER, _SCALARS = range(5)
FACTOR_ROWS: Final = 5  # what `factor_cyclic_tridiagonal` leaves, each of shape (nodes,)


@kernel
def factor_cyclic_tridiagonal(
    lower: np.ndarray, diagonal: np.ndarray, upper: np.ndarray, factors: np.ndarray
) -> None:
    """Leave in ``factors``, shape (FACTOR_ROWS, nodes), what `solve_factored` needs.

    Elimination goes from both ends to the middle: two chains of divisions side by side take half
    the time of one. ``nodes`` is even and at least 8.
    """
    nodes = diagonal.size
    middle = nodes // 2
    inward, inverse, outward = factors[_INWARD], factors[_INVERSE], factors[_OUTWARD]
    corner = factors[_CORNER]
    shift = -diagonal[0]
    weight = lower[0] / shift
    last = nodes - 1
    for i in range(1, last):
        corner[i] = 0.0
    corner[0], corner[last] = shift, upper[last]
    left = 1.0 / (diagonal[0] - shift)
    right = 1.0 / (diagonal[last] - weight * upper[last])
    inward[0] = inward[last] = 0.0
    inverse[0], inverse[last] = left, right
    outward[0], outward[last] = upper[0] * left, lower[last] * right
    for i in range(1, middle):
        j = last - i
        inward[i] = lower[i] * left
        left = 1.0 / (diagonal[i] - lower[i] * outward[i - 1])
        inverse[i] = left
        outward[i] = upper[i] * left
        if j > middle:
            inward[j] = upper[j] * right
            right = 1.0 / (diagonal[j] - upper[j] * outward[j + 1])
            inverse[j] = right
            outward[j] = lower[j] * right
    inward[middle], outward[middle] = lower[middle] * left, upper[middle] * right
    met = lower[middle] * outward[middle - 1] + upper[middle] * outward[middle + 1]
    inverse[middle] = 1.0 / (diagonal[middle] - met)
    _sweep(inward, inverse, outward, corner)
    factors[_SCALARS, 0] = weight
    factors[_SCALARS, 1] = 1.0 / (1.0 + corner[0] + weight * corner[last])


@kernel
def _sweep(inward: np.ndarray, inverse: np.ndarray, outward: np.ndarray, x: np.ndarray) -> None:
    """Solve without the corners."""
    last = x.size - 1
    middle = x.size // 2
    left, right = x[0], x[last]
    for i in range(1, middle - 1):
        left = x[i] - inward[i] * left
        right = x[last - i] - inward[last - i] * right
        x[i], x[last - i] = left, right
    left = x[middle - 1] - inward[middle - 1] * left
    x[middle - 1] = left
    left = right = (x[middle] - inward[middle] * left - outward[middle] * right) * inverse[middle]
    x[middle] = left
    for i in range(1, middle):
        left = x[middle - i] * inverse[middle - i] - outward[middle - i] * left
        right = x[middle + i] * inverse[middle + i] - outward[middle + i] * right
        x[middle - i], x[middle + i] = left, right
    x[0] = x[0] * inverse[0] - outward[0] * left


@kernel
def solve_factored(factors: np.ndarray, right: np.ndarray) -> None:
    """Replace ``right``, shape (nodes,), by the solution."""
    corner = factors[_CORNER]
    _sweep(factors[_INWARD], factors[_INVERSE], factors[_OUTWARD], right)
    part = right[0] + factors[_SCALARS, 0] * right[right.size - 1]
    part *= factors[_SCALARS, 1]
    for i in range(right.size):
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
