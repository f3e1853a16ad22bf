"""Nodes that follow the cell: close together where the edge bends or its linkers change.

The spacing of the nodes is ``L g / nodes``, ``g`` a field of mean 1 at the midpoints. It
relaxes towards what the shape asks for; the nodes' tangential velocity follows from it, so that
any density gives the same cell. Kernels use the paper's letters.
"""

from __future__ import annotations

import math
from typing import Final

import numpy as np

from cellcrawl.numerics.exponential import exponential
from cellcrawl.numerics.fourier import BEFORE, TAPS, lagrange_weights
from cellcrawl.numerics.kernels import expanded_kernel, inlined_kernel, kernel
from cellcrawl.solvers.adaptive.staggered import (
    HALO,
    cell_mean,
    central_difference,
    difference_ahead,
    fill_halo,
    mean_ahead,
    mean_behind,
    running_sum,
    total,
)

# rows of a mesh: rate of g and 1 / g at the midpoints, 1 / g at the nodes, room to work in
CHANGE, FINE, FINE_NODE, GOAL, SCRATCH = range(5)
MESH_ROWS: Final = 6
_LINKER_WEIGHT = 2.0  # of the slopes of n beside the curvature
_SMOOTHING = 0.02  # of the ring, twice
_UNEVEN = 0.004  # a cell whose density would vary less than this keeps equal spacing
_FASTEST = 10.0  # rate at which the density relaxes
_REACH = (0.0, 2.0, 2.0, 2.0, 2.0, 2.0)  # most of it in a step, by order
_LEAST_DENSITY = 0.02
_HALO = np.uint64(HALO)


@expanded_kernel
def hold(g: np.ndarray, mesh: np.ndarray, nodes: int) -> None:
    """Leave in ``mesh`` what the rates need of a density, whose halo is filled here."""
    fine, fine_node = mesh[FINE], mesh[FINE_NODE]
    fill_halo(g, nodes)
    for i in range(np.uint64(nodes + 2 * HALO)):
        fine[i] = 1.0 / g[i]
    for i in range(np.uint64(nodes)):
        fine_node[i + _HALO] = mean_behind(fine, i + _HALO)
    fill_halo(fine_node, nodes)


@kernel
def aim(w: np.ndarray, n: np.ndarray, g: np.ndarray, mesh: np.ndarray, nodes: int) -> None:
    """Leave in row `GOAL` of ``mesh`` the density that the shape asks for.

    ``mesh`` must `hold` the present density, and the halos of ``w`` and ``n`` be filled. The
    weight of a place grows with its curvature and with the slope of ``n``; it is smoothed along
    the ring of nodes.
    """
    per_turn = nodes / (2.0 * math.pi)
    fine, goal, weight, spare = mesh[FINE], mesh[GOAL], mesh[SCRATCH], mesh[SCRATCH + 1]
    for i in range(np.uint64(nodes)):
        j = i + _HALO
        bend = (1.0 + per_turn * difference_ahead(w, j)) * fine[j]
        slope = _LINKER_WEIGHT * per_turn * central_difference(n, j) * fine[j]
        weight[j] = math.sqrt(1.0 + bend * bend + slope * slope)
    _smooth(weight[HALO : HALO + nodes], spare[HALO : HALO + nodes], nodes)
    for i in range(np.uint64(nodes)):
        goal[i + _HALO] = 1.0 / weight[i + _HALO]
    light = total(goal, nodes) / nodes
    uneven = (total(weight, nodes) / nodes * light - 1.0) / _UNEVEN
    strength = uneven * uneven / (1.0 + uneven * uneven)
    # Nodes that are ahead of their place see the weight of a place that is not theirs: without
    # taking it back the density chases itself where the weight is steep
    for i in range(np.uint64(nodes)):
        j = i + _HALO
        goal[j] = 1.0 - strength + strength / light * goal[j]
        weight[j] = g[j] / goal[j]
        spare[j] = weight[j]
    fill_halo(goal, nodes)
    share = nodes / total(weight, nodes)
    running_sum(weight, nodes)
    limit = 1.0 / (_SMOOTHING * nodes) ** 2
    for i in range(np.uint64(nodes)):
        j = i + _HALO
        ahead = share * (weight[j] + 0.5 * spare[j]) - (np.float64(i) + 0.5)
        spare[j] = ahead / (1.0 + limit * ahead * ahead) * central_difference(goal, j)
    surplus = total(spare, nodes) / nodes
    for i in range(np.uint64(nodes)):
        goal[i + _HALO] -= spare[i + _HALO] - surplus


@kernel
def _smooth(a: np.ndarray, b: np.ndarray, nodes: int) -> None:
    """Smooth a ring twice by ``1 / (1 - d^2)`` in place: two passes each way, in two halves.

    Each half starts half a ring before it, where what it does not know has died away.
    """
    keep = exponential(-1.0 / (_SMOOTHING * nodes))
    gain = (1.0 - keep) ** 4
    half, last = nodes // 2, nodes - 1
    p0 = q0 = p1 = q1 = 0.0
    for k in range(half):
        p0 = a[k + half] + keep * p0
        q0 = p0 + keep * q0
        p1 = a[k] + keep * p1
        q1 = p1 + keep * q1
    for k in range(half):
        p0 = a[k] + keep * p0
        q0 = p0 + keep * q0
        p1 = a[k + half] + keep * p1
        q1 = p1 + keep * q1
        b[k], b[k + half] = q0, q1
    p0 = q0 = p1 = q1 = 0.0
    for k in range(half):
        p0 = b[last - k - half] + keep * p0
        q0 = p0 + keep * q0
        p1 = b[last - k] + keep * p1
        q1 = p1 + keep * q1
    for k in range(half):
        p0 = b[last - k] + keep * p0
        q0 = p0 + keep * q0
        p1 = b[last - k - half] + keep * p1
        q1 = p1 + keep * q1
        a[last - k], a[last - k - half] = gain * q0, gain * q1


@kernel
def lay_out(
    w: np.ndarray, n: np.ndarray, g: np.ndarray, h: float, order: int, mesh: np.ndarray, nodes: int
) -> None:
    """Fill all rows of ``mesh``, and the halos, for a state at rest between two steps of ``h``."""
    fill_halo(w, nodes)
    fill_halo(n, nodes)
    hold(g, mesh, nodes)
    aim(w, n, g, mesh, nodes)
    rate = min(_FASTEST, _REACH[order] / h)
    for i in range(HALO, HALO + nodes):
        mesh[CHANGE, i] = rate * (mesh[GOAL, i] - g[i])


@expanded_kernel
def relax(
    c: float,
    h: float,
    order: int,
    g: np.ndarray,
    history: np.ndarray,
    correction: np.ndarray,
    mesh: np.ndarray,
    nodes: int,
) -> bool:
    """Solve the implicit formula for the density; False if nodes would meet.

    ``g`` goes from predicted to final, ``correction`` and the rate in ``mesh`` with it.
    """
    rate = min(_FASTEST, _REACH[order] / h)
    goal, change = mesh[GOAL], mesh[CHANGE]
    share = 1.0 / (1.0 + c * rate)
    least = np.inf
    for i in range(np.uint64(nodes)):
        j = i + _HALO
        step = (c * rate * (goal[j] - g[j]) - history[j]) * share
        correction[j] = step
        g[j] += step
        change[j] = rate * (goal[j] - g[j])
        least = min(least, g[j])
    return least > _LEAST_DENSITY


@kernel
def places(g: np.ndarray, nodes: int, at_nodes: np.ndarray) -> None:
    """Fill ``at_nodes``, with halo, with the arclength from node 0, in units of mean spacings.

    The halo goes on round the edge. The halo of ``g`` is filled.
    """
    for i in range(np.uint64(nodes)):
        at_nodes[i + _HALO] = cell_mean(g, i + _HALO)
    running_sum(at_nodes, nodes)
    for k in range(HALO):
        at_nodes[k] = at_nodes[nodes + k] - nodes
        at_nodes[HALO + nodes + k] = at_nodes[HALO + k] + nodes


@kernel
def edge_on_mesh(profile: np.ndarray, g: np.ndarray, edge: np.ndarray, work: np.ndarray) -> None:
    """Read parameters given at equal arclengths, shape (rows, places), at the midpoints."""
    nodes, count = edge.shape[1], profile.shape[1]
    at_nodes = work[0]
    places(g, nodes, at_nodes)
    weights = np.empty(TAPS)
    for i in range(nodes):
        place = mean_ahead(at_nodes, np.uint64(i) + _HALO) * (count / nodes)
        first = math.floor(place)
        lagrange_weights(place - first, weights)
        for row in range(edge.shape[0]):
            value = 0.0
            for tap in range(TAPS):
                value += weights[tap] * profile[row, (first + tap - BEFORE) % count]
            edge[row, i] = value


@kernel
def fill_uniform(profile: np.ndarray, edge: np.ndarray) -> None:
    """Give every midpoint the parameters, if they are the same all along the edge."""
    if profile.shape[1] == 1:
        for row in range(edge.shape[0]):
            for i in range(edge.shape[1]):
                edge[row, i] = profile[row, 0]


@inlined_kernel
def read_profile(
    profile: np.ndarray, g: np.ndarray, edge: np.ndarray, mesh: np.ndarray, work: np.ndarray
) -> None:
    """Fill ``edge`` with the parameters at the midpoints of nodes of density ``g``."""
    fill_uniform(profile, edge)
    if profile.shape[1] > 1:
        hold(g, mesh, edge.shape[1])
        edge_on_mesh(profile, g, edge, work)


@kernel
def normalise(g: np.ndarray, nodes: int) -> None:
    """Bring the mean of the density back to 1, from which rounding takes it."""
    scale = nodes / total(g, nodes)
    for i in range(HALO, HALO + nodes):
        g[i] *= scale
