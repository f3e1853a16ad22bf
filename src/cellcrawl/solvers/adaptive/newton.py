"""The matrix of an implicit step: ``(1 - c J) change = residual``, nearly, in two sweeps.

Kept of the Jacobian ``J`` is what is fast: reaction, diffusion and drift of the linkers, drift of
the shape and its pull on its own curvature, all tridiagonal, and the one tension that couples every
point of the edge, a row and a column. What is left out grows or decays no faster than the cell
moves. Kernels use the paper's letters.
"""

from __future__ import annotations

import math
from typing import Any, Final

import numpy as np

from cellcrawl.laws.addresses import AROUND, NOTHING, NUMBER, ROW, ROWS, called_by_address
from cellcrawl.laws.functions import balance, partials, velocity
from cellcrawl.numerics.cyclic import FACTOR_ROWS, factor_cyclic_tridiagonal, solve_factored
from cellcrawl.numerics.elementary import cosine, sine
from cellcrawl.numerics.kernels import inlined_kernel, kernel
from cellcrawl.solvers.adaptive.entries import (
    AREA,
    LENGTH,
    ORIGIN_X,
    ORIGIN_Y,
    TENSION,
    TENSION_RATE,
)
from cellcrawl.solvers.adaptive.mesh import FINE, FINE_NODE
from cellcrawl.solvers.adaptive.place import MORE_CURVED, bent_midpoints
from cellcrawl.solvers.adaptive.rates import RATE
from cellcrawl.solvers.adaptive.staggered import HALO, difference_ahead, dot, fill_halo
from cellcrawl.surroundings.motion import BENDS

# rows of a matrix: how U answers to n and to sigma, how n answers to sigma within a step, g kappa,
# a few numbers, g times the first
BY_LINKERS, BY_TENSION, ANSWER, BEND, SCALARS, ASKED, LOOSENED = range(7)
_LINKERS: Final = 7  # first row of the factors for n
_SHAPE: Final = _LINKERS + FACTOR_ROWS  # and for the angle
_SCRATCH: Final = _SHAPE + FACTOR_ROWS
MATRIX_ROWS: Final = _SCRATCH + 3
# A compact second difference, within 3 % of the tenth-order one for every wave on the grid
_COMPACT: Final = 0.125
_COMPACT_SCALE: Final = 1.0 + 2.0 * _COMPACT
_SHAPE_SCALE: Final = 1.4  # of the plain one: 1.7 would fit the shortest waves, 1.0 the long ones
_MIDDLING: Final = 4.0  # of the plain second difference, for waves of middle length
_LEAST_PIVOT: Final = (
    0.3  # where a reaction or the tension grows on its own; only the speed suffers
)
_HALO = np.uint64(HALO)
_1 = np.uint64(1)


@kernel
def _blend(a: np.ndarray, out: np.ndarray) -> None:
    """Left side of the compact second difference, applied to ``a``."""
    last = a.size - 1
    for i in range(_1, np.uint64(last)):
        out[i] = a[i] + _COMPACT * (a[i - _1] + a[i + _1])
    out[0] = a[0] + _COMPACT * (a[last] + a[1])
    out[last] = a[last] + _COMPACT * (a[last - 1] + a[0])


@inlined_kernel
def _through_the_parameters(
    laws: Any,
    y: float,
    r: float,
    n: float,
    sigma: float,
    kappa: float,
    local: np.ndarray,
    bent: np.ndarray,
    i: int,
) -> tuple[float, float]:
    """How balance and velocity answer to the curvature by way of the local parameters."""
    before, _, _ = balance(laws, y, r, n, sigma, kappa, local, i)
    after, _, _ = balance(laws, y, r, n, sigma, kappa, bent, i)
    slower = velocity(laws, y, r, sigma, kappa, local, i)
    faster = velocity(laws, y, r, sigma, kappa, bent, i)
    return (after - before) / MORE_CURVED, (faster - slower) / MORE_CURVED


@called_by_address(NOTHING, AROUND, NUMBER, NUMBER, ROW, ROW, ROWS, ROWS, ROWS, ROWS)
def factor(
    laws: Any,
    around: Any,
    time: float,
    c: float,
    state: np.ndarray,
    y: np.ndarray,
    edge: np.ndarray,
    mesh: np.ndarray,
    work: np.ndarray,
    matrix: np.ndarray,
) -> None:
    """Make the matrix for a step with factor ``c``. ``y`` and ``work`` are as `rates` left them."""
    nodes = y.size
    span = nodes + 2 * HALO
    w, n, g = state[:span], state[span : 2 * span], state[2 * span : 3 * span]
    scalars = state[3 * span :]
    local = edge
    if around is not None:
        local = around.local
    fine, fine_node = mesh[FINE], mesh[FINE_NODE]
    per_spacing = nodes / scalars[LENGTH]
    winding = 2.0 * math.pi / scalars[LENGTH]
    sigma = scalars[TENSION]
    by_linkers, by_tension, bend = matrix[BY_LINKERS], matrix[BY_TENSION], matrix[BEND]
    lower, diagonal, upper = matrix[_SCRATCH], matrix[_SCRATCH + 1], matrix[_SCRATCH + 2]
    answer, loosened = matrix[ANSWER], matrix[LOOSENED]
    spreading = _MIDDLING * c * per_spacing**2
    rate = work[RATE]
    pulled, loss, slide = work[0], work[1], work[3]
    bends = False
    if around is not None:
        bends = around.motion[BENDS] > 0.0
        if bends:
            bent_midpoints(around, time, w, scalars, fine, edge)
    for i in range(np.uint64(nodes)):
        j = i + _HALO
        bend[i] = winding + per_spacing * difference_ahead(w, j)
        kappa = bend[i] * fine[j]
        by_phi, by_n, by_sigma, by_kappa, u_phi, u_sigma, u_kappa, b_phi, b_n = partials(
            laws, y[i], rate[i], n[j], sigma, kappa, local, i
        )
        if around is not None and bends:
            more_kappa, more_u = _through_the_parameters(
                laws, y[i], rate[i], n[j], sigma, kappa, local, around.before, i
            )
            by_kappa += more_kappa
            u_kappa += more_u
        yielding = -1.0 / by_phi  # how phi answers to a balance that is off
        share, slip = u_phi * yielding, b_phi * yielding
        by_linkers[i] = share * by_n
        by_tension[i] = share * by_sigma + u_sigma
        kept = max(1.0 - c * (b_n + slip * by_n), _LEAST_PIVOT)
        loss[j] = g[j] * kept
        lower[i] = c * slip * by_sigma * g[j]
        smoothing = max(-share * by_kappa - u_kappa, 0.0) * fine[j]
        loosening = c * max(-slip * by_kappa, 0.0) * fine[j]
        loosened[i] = loosening / (kept + spreading * local[2, i] * fine[j] * fine[j])
        pulled[j] = smoothing + by_linkers[i] * loosened[i]
    _blend(lower, answer)
    fill_halo(loss, nodes)
    fill_halo(pulled, nodes)
    diffusivity = local[2]
    spread = c * per_spacing**2 * _COMPACT_SCALE
    carried = 0.25 * c * per_spacing
    for i in range(np.uint64(nodes)):
        j = i + _HALO
        behind = spread * diffusivity[i] * fine_node[j]
        ahead = spread * diffusivity[i] * fine_node[j + _1]
        drift = carried * (slide[j] + slide[j + _1])
        lower[i] = _COMPACT * loss[j - _1] - behind + drift
        upper[i] = _COMPACT * loss[j + _1] - ahead - drift
        diagonal[i] = loss[j] + behind + ahead
    factor_cyclic_tridiagonal(lower, diagonal, upper, matrix[_LINKERS : _LINKERS + FACTOR_ROWS])
    straighten = c * per_spacing**2 * _SHAPE_SCALE
    for i in range(np.uint64(nodes)):
        j = i + _HALO
        behind = straighten * fine_node[j] * pulled[j - _1]
        ahead = straighten * fine_node[j] * pulled[j]
        drift = 2.0 * carried * slide[j] * fine_node[j]
        lower[i], diagonal[i], upper[i] = drift - behind, 1.0 + behind + ahead, -drift - ahead
    factor_cyclic_tridiagonal(lower, diagonal, upper, matrix[_SHAPE : _SHAPE + FACTOR_ROWS])
    solve_factored(matrix[_LINKERS : _LINKERS + FACTOR_ROWS], answer)
    inner = g[HALO : HALO + nodes]
    asked = matrix[ASKED]
    for i in range(np.uint64(nodes)):
        asked[i] = by_linkers[i] * inner[i]
    pull_back = dot(by_tension, inner)
    slope = pull_back + dot(asked, answer)
    gain = c * local[TENSION_RATE, 0] / per_spacing
    matrix[SCALARS, 0] = gain
    matrix[SCALARS, 2] = local[TENSION_RATE, 0]
    matrix[SCALARS, 1] = 1.0 / max(1.0 - gain * slope, _LEAST_PIVOT)


@kernel
def solve(
    c: float,
    state: np.ndarray,
    mesh: np.ndarray,
    matrix: np.ndarray,
    residual: np.ndarray,
) -> None:
    """Replace ``residual``, laid out like ``state``, by the change of state it asks for.

    Its halos become 0, and the density's part: that one is solved for before.
    """
    nodes = matrix.shape[1]
    span = nodes + 2 * HALO
    per_spacing = nodes / state[3 * span + LENGTH]
    g, fine_node = state[2 * span : 3 * span], mesh[FINE_NODE]
    w, n, scalars = residual[:span], residual[span : 2 * span], residual[3 * span :]
    by_linkers, by_tension, bend = matrix[BY_LINKERS], matrix[BY_TENSION], matrix[BEND]
    answer, gain = matrix[ANSWER], matrix[SCALARS, 0]
    bound, speed, angle = matrix[_SCRATCH], matrix[_SCRATCH + 1], matrix[_SCRATCH + 2]
    for i in range(np.uint64(nodes)):
        angle[i] = n[i + _HALO] * g[i + _HALO]
    _blend(angle, bound)
    solve_factored(matrix[_LINKERS : _LINKERS + FACTOR_ROWS], bound)
    asked = gain * dot(matrix[ASKED], bound)
    sigma = (scalars[TENSION] + asked) * matrix[SCALARS, 1]
    for i in range(np.uint64(nodes)):
        bound[i] += sigma * answer[i]
        n[i + _HALO] = bound[i]
        speed[i] = by_linkers[i] * bound[i] + by_tension[i] * sigma
    growth = c * dot(speed, g[HALO : HALO + nodes]) / per_spacing
    move = c * per_spacing
    angle[0] = w[HALO] - move * fine_node[HALO] * (speed[0] - speed[nodes - 1])
    for i in range(_1, np.uint64(nodes)):
        j = i + _HALO
        angle[i] = w[j] - move * fine_node[j] * (speed[i] - speed[i - _1])
    solve_factored(matrix[_SHAPE : _SHAPE + FACTOR_ROWS], angle)
    loosened = matrix[LOOSENED]
    for i in range(np.uint64(nodes - 1)):
        n[i + _HALO] -= per_spacing * loosened[i] * (angle[i + _1] - angle[i])
    n[HALO + nodes - 1] -= per_spacing * loosened[nodes - 1] * (angle[0] - angle[nodes - 1])
    for i in range(np.uint64(nodes)):
        w[i + _HALO] = angle[i]
    for k in range(HALO):
        w[k] = n[k] = w[HALO + nodes + k] = n[HALO + nodes + k] = 0.0
    for k in range(2 * span, 3 * span):
        residual[k] = 0.0
    first = 0.5 * c * (speed[0] + speed[nodes - 1])
    scalars[AREA] += growth
    scalars[TENSION] += matrix[SCALARS, 2] * growth  # so that sigma - G A stays to rounding
    scalars[LENGTH] += c * dot(speed, bend) / per_spacing
    scalars[ORIGIN_X] += first * sine(state[HALO])
    scalars[ORIGIN_Y] -= first * cosine(state[HALO])
