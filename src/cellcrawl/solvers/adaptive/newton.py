"""The matrix of an implicit step: ``(1 - c J) change = residual``, nearly, in two sweeps.

Kept of the Jacobian ``J`` is what is fast: reaction, diffusion and drift of the linkers, drift of
the shape and its pull on its own curvature, all tridiagonal, and the one tension that couples every
point of the edge, a row and a column. What is left out grows or decays no faster than the cell
moves. Kernels use the paper's letters.
"""

from __future__ import annotations

import math
from typing import Final

import numpy as np

from cellcrawl._compile import kernel
from cellcrawl.physics.laws import friction_slope
from cellcrawl.solvers.adaptive.rates import (
    AREA,
    LENGTH,
    ORIGIN_X,
    ORIGIN_Y,
    RATE,
    TENSION,
    TENSION_RATE,
)
from cellcrawl.solvers.adaptive.staggered import HALO, difference_ahead, fill_halo
from cellcrawl.solvers.cyclic import FACTOR_ROWS, factor_cyclic_tridiagonal, solve_factored

# rows of a matrix: how U answers to n and to sigma, how n answers to sigma within a step, kappa
BY_LINKERS, BY_TENSION, ANSWER, KAPPA, SCALARS = range(5)
_LINKERS: Final = 5  # first row of the factors for n
_SHAPE: Final = _LINKERS + FACTOR_ROWS  # and for the angle
_SCRATCH: Final = _SHAPE + FACTOR_ROWS
MATRIX_ROWS: Final = _SCRATCH + 4
# A compact second difference, within 3 % of the tenth-order one for every wave on the grid
_COMPACT: Final = 0.125
_COMPACT_SCALE: Final = 1.0 + 2.0 * _COMPACT
_SHAPE_SCALE: Final = 1.4  # of the plain one: 1.7 would fit the shortest waves, 1.0 the long ones
_LEAST_PIVOT: Final = (
    0.3  # where a reaction or the tension grows on its own; only the speed suffers
)
_HALO = np.uint64(HALO)


@kernel
def _blend(a: np.ndarray, out: np.ndarray) -> None:
    """Left side of the compact second difference, applied to ``a``."""
    last = a.size - 1
    for i in range(1, last):
        out[i] = a[i] + _COMPACT * (a[i - 1] + a[i + 1])
    out[0] = a[0] + _COMPACT * (a[last] + a[1])
    out[last] = a[last] + _COMPACT * (a[last - 1] + a[0])


@kernel
def factor(
    c: float,
    state: np.ndarray,
    y: np.ndarray,
    edge: np.ndarray,
    work: np.ndarray,
    matrix: np.ndarray,
) -> None:
    """Make the matrix for a step with factor ``c``. ``y`` and ``work`` are as `rates` left them."""
    nodes = y.size
    span = nodes + 2 * HALO
    w, n, scalars = state[:span], state[span : 2 * span], state[2 * span :]
    per_spacing = nodes / scalars[LENGTH]
    winding = 2.0 * math.pi / scalars[LENGTH]
    sigma = scalars[TENSION]
    by_linkers, by_tension, kappa = matrix[BY_LINKERS], matrix[BY_TENSION], matrix[KAPPA]
    loss, lower, diagonal, upper = (
        matrix[_SCRATCH],
        matrix[_SCRATCH + 1],
        matrix[_SCRATCH + 2],
        matrix[_SCRATCH + 3],
    )
    answer = matrix[ANSWER]
    r_on, zeta_1, epsilon, h, rate = edge[0], edge[1], edge[3], edge[4], work[RATE]
    stretch, slide = work[0], work[3]
    for i in range(np.uint64(nodes)):
        j = i + _HALO
        r, log_r = rate[i], y[i]
        kappa[i] = winding + per_spacing * difference_ahead(w, j)
        pull = 1.0 + kappa[i] * h[i]
        yielding = 1.0 / friction_slope(log_r, r, n[j], zeta_1[i])
        share = epsilon[i] * r * (1.0 + log_r) * yielding
        slip = n[j] * r * yielding
        by_linkers[i] = share * zeta_1[i] * log_r
        by_tension[i] = -share * pull
        loss[i] = max(1.0 + c * (r_on[i] + r - slip * zeta_1[i] * log_r), _LEAST_PIVOT)
        lower[i] = -c * slip * pull
        stretch[j] = max(share * sigma * h[i], 0.0)
    _blend(lower, answer)
    fill_halo(stretch, nodes)
    spread = c * per_spacing**2 * _COMPACT_SCALE
    carried = 0.25 * c * per_spacing
    for i in range(nodes):
        before, after = loss[i - 1], loss[i + 1 if i < nodes - 1 else 0]
        d = spread * edge[2, i]
        drift = carried * (slide[HALO + i] + slide[HALO + i + 1])
        lower[i] = _COMPACT * before - d + drift
        upper[i] = _COMPACT * after - d - drift
        diagonal[i] = loss[i] + 2.0 * d
    factor_cyclic_tridiagonal(lower, diagonal, upper, matrix[_LINKERS : _LINKERS + FACTOR_ROWS])
    bend = c * per_spacing**2 * _SHAPE_SCALE
    for i in range(nodes):
        behind, ahead = bend * stretch[HALO + i - 1], bend * stretch[HALO + i]
        drift = 2.0 * carried * slide[HALO + i]
        lower[i], diagonal[i], upper[i] = drift - behind, 1.0 + behind + ahead, -drift - ahead
    factor_cyclic_tridiagonal(lower, diagonal, upper, matrix[_SHAPE : _SHAPE + FACTOR_ROWS])
    solve_factored(matrix[_LINKERS : _LINKERS + FACTOR_ROWS], answer)
    slope = 0.0
    for i in range(nodes):
        slope += by_linkers[i] * answer[i] + by_tension[i]
    gain = c * edge[TENSION_RATE, 0] / per_spacing
    matrix[SCALARS, 0] = gain
    matrix[SCALARS, 1] = 1.0 / max(1.0 - gain * slope, _LEAST_PIVOT)


@kernel
def solve(
    c: float,
    state: np.ndarray,
    matrix: np.ndarray,
    residual: np.ndarray,
) -> None:
    """Replace ``residual``, laid out like ``state``, by the change of state it asks for.

    Its halos become 0.
    """
    nodes = matrix.shape[1]
    span = nodes + 2 * HALO
    per_spacing = nodes / state[2 * span + LENGTH]
    w, n, scalars = residual[:span], residual[span : 2 * span], residual[2 * span :]
    by_linkers, by_tension, kappa = matrix[BY_LINKERS], matrix[BY_TENSION], matrix[KAPPA]
    answer, gain = matrix[ANSWER], matrix[SCALARS, 0]
    bound, speed, angle = matrix[_SCRATCH], matrix[_SCRATCH + 1], matrix[_SCRATCH + 2]
    _blend(n[HALO : HALO + nodes], bound)
    solve_factored(matrix[_LINKERS : _LINKERS + FACTOR_ROWS], bound)
    asked = 0.0
    for i in range(nodes):
        asked += by_linkers[i] * bound[i]
    sigma = (scalars[TENSION] + gain * asked) * matrix[SCALARS, 1]
    growth = stretch = 0.0
    for i in range(nodes):
        bound[i] += sigma * answer[i]
        n[HALO + i] = bound[i]
        speed[i] = by_linkers[i] * bound[i] + by_tension[i] * sigma
        growth += speed[i]
        stretch += speed[i] * kappa[i]
    angle[0] = w[HALO] - c * per_spacing * (speed[0] - speed[nodes - 1])
    for i in range(1, nodes):
        angle[i] = w[HALO + i] - c * per_spacing * (speed[i] - speed[i - 1])
    solve_factored(matrix[_SHAPE : _SHAPE + FACTOR_ROWS], angle)
    for i in range(nodes):
        w[HALO + i] = angle[i]
    for k in range(HALO):
        w[k] = n[k] = w[HALO + nodes + k] = n[HALO + nodes + k] = 0.0
    first = 0.5 * c * (speed[0] + speed[nodes - 1])
    scalars[TENSION] += gain * growth  # sigma, written so that sigma - G A stays to rounding
    scalars[AREA] += c * growth / per_spacing
    scalars[LENGTH] += c * stretch / per_spacing
    scalars[ORIGIN_X] += first * math.sin(state[HALO])
    scalars[ORIGIN_Y] -= first * math.cos(state[HALO])
