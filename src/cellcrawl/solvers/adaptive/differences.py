"""Backward differences of the state at equal steps: predicting, rescaling, moving on.

The numerical differentiation formulas of Shampine & Reichelt (SIAM J. Sci. Comput. 18, 1997):
backward differentiation of order 1 to 5 with a smaller error at orders 1 to 4. Row ``j`` of a table
is the ``j``-th backward difference of the state at the present step size.
"""

from __future__ import annotations

from typing import Final

import numpy as np

from cellcrawl.numerics.kernels import expanded_kernel, kernel

HIGHEST_ORDER: Final = 5
DIFFERENCES: Final = HIGHEST_ORDER + 3  # rows: one to raise the order by, one for its error
ROOM: Final = HIGHEST_ORDER + 1  # further rows, to work in

_MODIFIER = (0.0, -0.1850, -1.0 / 9.0, -0.0823, -0.0415, 0.0)
_HARMONIC = (0.0, 1.0, 1.5, 11.0 / 6.0, 25.0 / 12.0, 137.0 / 60.0)
WEIGHTS: Final = np.array(_HARMONIC)
LEADING: Final = np.array([(1.0 - m) * s for m, s in zip(_MODIFIER, _HARMONIC, strict=True)])
ERRORS: Final = np.array(
    [m * s + 1.0 / (k + 1) for k, (m, s) in enumerate(zip(_MODIFIER, _HARMONIC, strict=True))]
)


@expanded_kernel
def predict(order: int, table: np.ndarray, predicted: np.ndarray, history: np.ndarray) -> None:
    """Extrapolate by one step; leave also what the past contributes to the formula."""
    leading = LEADING[order]
    first, second = table[0], table[1]
    weight = WEIGHTS[1] / leading
    for k in range(predicted.size):
        predicted[k] = first[k] + second[k]
        history[k] = weight * second[k]
    for j in range(2, order + 1):
        weight = WEIGHTS[j] / leading
        row = table[j]
        for k in range(predicted.size):
            predicted[k] += row[k]
            history[k] += weight * row[k]


@expanded_kernel
def move_on(order: int, table: np.ndarray, correction: np.ndarray) -> None:
    """Take the step whose solution is the prediction plus ``correction``."""
    above, top = table[order + 2], table[order + 1]
    for k in range(correction.size):
        above[k] = correction[k] - top[k]
        top[k] = correction[k]
    for j in range(order, -1, -1):
        lower, upper = table[j], table[j + 1]
        for k in range(correction.size):
            lower[k] += upper[k]


@kernel
def rescale(order: int, factor: float, table: np.ndarray) -> None:
    """Make the differences those of a step ``factor`` times as long, on the same polynomial."""
    size = order + 1
    spread = np.empty((size, size))
    for j in range(size):
        spread[0, j] = 1.0
        for i in range(1, size):
            spread[i, j] = spread[i - 1, j] * (i - 1 - factor * j) / i if j > 0 else 0.0
    whole = np.empty((size, size))  # the same for a factor of 1: its own inverse
    for j in range(size):
        whole[0, j] = 1.0
        for i in range(1, size):
            whole[i, j] = whole[i - 1, j] * (i - 1 - j) / i if j > 0 else 0.0
    for i in range(1, size):
        out = table[DIFFERENCES + i]
        out[:] = 0.0
        for k in range(i, size):
            weight = 0.0
            for j in range(size):
                weight += spread[k, j] * whole[j, i]
            row = table[k]
            for x in range(row.size):
                out[x] += weight * row[x]
    for i in range(1, size):
        new, old = table[DIFFERENCES + i], table[i]
        for x in range(old.size):  # not as whole rows: numba compiles much text for their mismatch
            old[x] = new[x]


@kernel
def interpolate(steps: float, order: int, table: np.ndarray, state: np.ndarray) -> None:
    """Fill ``state`` with that ``steps`` step sizes after the last, between -1 and 0."""
    for k in range(state.size):
        state[k] = table[0, k]
    weight = 1.0
    for j in range(1, order + 1):
        weight *= (steps + j - 1) / j
        for k in range(state.size):
            state[k] += weight * table[j, k]
