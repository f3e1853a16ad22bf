"""Back onto what the model conserves: an edge that closes, with the area its tension belongs to.

The angle and length that a solver integrates know nothing of either; what their errors do to both
adds up. The change is the smallest smooth one, and keeps node 0 or the centroid in place.
"""

from __future__ import annotations

import math
from typing import Final

import numpy as np

from cellcrawl.curve.sines import sine_and_cosine
from cellcrawl.numerics.elementary import hypotenuse
from cellcrawl.numerics.kernels import expanded_kernel, kernel
from cellcrawl.solvers.adaptive.entries import AREA, LENGTH, ORIGIN_X, ORIGIN_Y
from cellcrawl.solvers.adaptive.staggered import (
    HALO,
    cell_mean,
    fill_halo,
    mean_ahead,
    mean_behind,
    running_sum,
    total,
)

# rows of `work` that `trace` fills: position from node 0 at the nodes, its tangent at the midpoints
X, Y, COSINE, SINE, SPARE = range(5)
TRACE_ROWS: Final = 5
_HALO = np.uint64(HALO)


@kernel
def tangent(w: np.ndarray, nodes: int, work: np.ndarray) -> None:
    """Leave cosine and sine of the tangent's angle at the midpoints, with halos."""
    turn = 2.0 * math.pi / nodes
    cosine, sine = work[COSINE], work[SINE]
    for i in range(np.uint64(nodes)):
        j = i + _HALO
        sine[j], cosine[j] = sine_and_cosine(mean_ahead(w, j) + turn * (np.float64(i) + 0.5))
    fill_halo(cosine, nodes)
    fill_halo(sine, nodes)


@kernel
def trace(
    g: np.ndarray, length: float, nodes: int, work: np.ndarray
) -> tuple[float, float, float, float, float]:
    """Gap of the edge in x and y, area, and centroid from node 0, from what `tangent` left.

    Leaves the positions of the nodes with halos; a gap is spread evenly over the nodes.
    """
    spacing = length / nodes
    x, y, cosine, sine, spare = work[X], work[Y], work[COSINE], work[SINE], work[SPARE]
    gap_x = _integral(cosine, g, spacing, nodes, spare, x)
    gap_y = _integral(sine, g, spacing, nodes, spare, y)
    # 2 area and 3 area * centroid are the integrals of the support x . n and of x (x . n)
    area = moment_x = moment_y = 0.0
    for i in range(np.uint64(nodes)):
        j = i + _HALO
        middle_x, middle_y = mean_ahead(x, j), mean_ahead(y, j)
        support = (middle_x * sine[j] - middle_y * cosine[j]) * g[j]
        area += support
        moment_x += middle_x * support
        moment_y += middle_y * support
    share = 2.0 / (3.0 * area)
    return gap_x, gap_y, 0.5 * spacing * area, share * moment_x, share * moment_y


@expanded_kernel
def _integral(
    slope: np.ndarray, g: np.ndarray, spacing: float, nodes: int, spare: np.ndarray, x: np.ndarray
) -> float:
    """Integrate from node 0 along the edge; return the whole, which is spread evenly over it."""
    for i in range(np.uint64(nodes + 2 * HALO)):
        spare[i] = slope[i] * g[i]
    for i in range(np.uint64(nodes)):
        x[i + _HALO] = spacing * cell_mean(spare, i + _HALO)
    whole = total(x, nodes)
    running_sum(x, nodes)
    for i in range(nodes):
        x[HALO + i] -= whole * i / nodes
    fill_halo(x, nodes)
    return whole


@kernel
def project(state: np.ndarray, nodes: int, work: np.ndarray) -> tuple[float, float]:
    """Close the edge of a state and give it its area.

    Fills the halos of the state, and leaves the trace of the new edge in ``work``.

    Returns
    -------
    gap : float
        How far the edge was from closed, over its length.
    excess : float
        How far its area was from that of the tension law, over that area.
    """
    span = nodes + 2 * HALO
    w, g, scalars = state[:span], state[2 * span : 3 * span], state[3 * span :]
    fill_halo(w, nodes)
    fill_halo(g, nodes)
    tangent(w, nodes, work)
    cosine, sine = work[COSINE], work[SINE]
    gap_x = gap_y = cc = cs = ss = 0.0
    for i in range(HALO, HALO + nodes):
        gap_x += cosine[i] * g[i]
        gap_y += sine[i] * g[i]
        cc += cosine[i] * cosine[i] * g[i]
        cs += cosine[i] * sine[i] * g[i]
        ss += sine[i] * sine[i] * g[i]
    # d angle = p sine + q cosine with -p ss - q cs = -gap_x and p cs + q cc = -gap_y
    inverse = 1.0 / (ss * cc - cs * cs)
    p = (gap_x * cc + gap_y * cs) * inverse
    q = -(gap_x * cs + gap_y * ss) * inverse
    for i in range(np.uint64(nodes)):
        j = i + _HALO
        w[j] += p * mean_behind(sine, j) + q * mean_behind(cosine, j)
    fill_halo(w, nodes)
    for i in range(np.uint64(nodes + 2 * HALO)):
        a, b = sine[i], cosine[i]
        turned = p * a + q * b
        less = 1.0 - 0.5 * turned * turned
        sine[i], cosine[i] = a * less + b * turned, b * less - a * turned
    _, _, area, x, y = trace(g, scalars[LENGTH], nodes, work)
    ratio = scalars[AREA] / area
    if not 0.25 < ratio < 4.0:
        return np.inf, np.inf
    factor = math.sqrt(ratio)
    scalars[LENGTH] *= factor
    scalars[ORIGIN_X] += (1.0 - factor) * x
    scalars[ORIGIN_Y] += (1.0 - factor) * y
    return hypotenuse(gap_x, gap_y) / nodes, abs(1.0 / ratio - 1.0)
