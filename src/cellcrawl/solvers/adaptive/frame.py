"""A frame of output from the adaptive solver's state, as accurate as the state itself.

Positions come from the tangent angle by a tenth-order running integral along the solver's own
nodes; values at equal arclengths lie on polynomials through the twelve nodes around them.
"""

from __future__ import annotations

import math
from typing import Any, Final, NamedTuple

import numpy as np

from cellcrawl.laws.addresses import AROUND, NOTHING, NUMBER, ROWS, called_by_address
from cellcrawl.laws.force_balance import SOLVED, bond_force, solve_bonds
from cellcrawl.laws.functions import friction, off_rate, velocity
from cellcrawl.numerics.elementary import cosine, sine
from cellcrawl.numerics.fourier import BEFORE, TAPS
from cellcrawl.numerics.kernels import expanded_kernel, kernel
from cellcrawl.solvers.adaptive.differences import interpolate
from cellcrawl.solvers.adaptive.entries import FIELDS, LENGTH, ORIGIN_X, ORIGIN_Y, SCALARS, TENSION
from cellcrawl.solvers.adaptive.mesh import places
from cellcrawl.solvers.adaptive.projection import (
    COSINE,
    SINE,
    TRACE_ROWS,
    X,
    Y,
    project,
    tangent,
    trace,
)
from cellcrawl.solvers.adaptive.staggered import HALO, difference_ahead, fill_halo, mean_ahead
from cellcrawl.solvers.base import Frame, Instant
from cellcrawl.surroundings.motion import MOVES
from cellcrawl.surroundings.place import balance_in_place, surround_edge

KAPPA, PLACE = COSINE, SINE  # rows that hold these once the tangent has been used
_HALO = np.uint64(HALO)
_ROWS: Final = (
    "x",
    "y",
    "theta",
    "curvature",
    "bound_fraction",
    "off_rate",
    "normal_velocity",
    "friction",
)
_VELOCITY, _FRICTION = 6, 7
CLEARLY: Final = 0.1  # in cell radii: far more than the edge does between two midpoints
# what `measure` finds: errors of closure and area before they were mended, relative to length and
# area, and the least support of the edge seen from the centroid: positive if it cannot cross itself
_TENSION, _LENGTH, _AREA, _CENTROID_X, _CENTROID_Y, GAP, EXCESS, CLEARANCE = range(8)
MEASURES: Final = 8
_GUESSES = 4
_BLOCK = 32  # places that are found at once
_SCALES: Final = np.array(
    [
        (-1.0) ** (TAPS - 1 - tap) / (math.factorial(tap) * math.factorial(TAPS - 1 - tap))
        for tap in range(TAPS)
    ]
)


class Shape(NamedTuple):
    """The edge at one instant on the solver's own nodes, and what is measured on it."""

    time: float
    state: np.ndarray
    work: np.ndarray
    """x and y from node 0, and arclength in mean spacings, at the nodes; curvature at the
    midpoints; all with halos, in rows `X`, `Y`, `PLACE` and `KAPPA`."""
    measures: np.ndarray


def room_for_shape(size: int) -> tuple[np.ndarray, np.ndarray]:
    """Return arrays that `measure` fills for states of ``size`` entries."""
    return np.empty(size), np.empty((TRACE_ROWS, (size - SCALARS) // FIELDS))


def instant(time: float, measures: np.ndarray) -> Instant:
    """Return the cell as a whole from what was measured."""
    tension, length, area, x, y, gap, excess, clearance = measures.tolist()
    return Instant(
        time=time,
        tension=tension,
        length=length,
        area=area,
        centroid_x=x,
        centroid_y=y,
        surely_simple=clearance > CLEARLY,
        closure_gap=max(gap, excess),
    )


def frame(
    laws: Any, around: Any, shape: Shape, log_rate: np.ndarray, profile: np.ndarray, nodes: int
) -> Frame:
    """Return the cell on ``nodes`` nodes.

    ``log_rate`` is any guess of ``log r`` at the solver's midpoints; ``profile`` holds the local
    parameters at the nodes, or at one place if they are the same all along the edge.
    """
    out, edge = np.empty((len(_ROWS), nodes)), np.empty((len(profile) + 1, nodes))
    fill_frame(laws, around, shape.time, shape.state, shape.work, log_rate, profile, edge, out)
    fields: dict[str, Any] = dict(zip(_ROWS, out, strict=True))
    return Frame(**vars(instant(shape.time, shape.measures)), **fields)


@kernel
def measure(
    steps: float,
    order: int,
    table: np.ndarray,
    state: np.ndarray,
    work: np.ndarray,
    measures: np.ndarray,
    errors: np.ndarray,
) -> None:
    """Measure the edge ``steps`` step sizes after the last state, between -1 and 0.

    ``table`` holds the state and its backward differences. Fills ``state`` and ``work`` as `Shape`
    has them: the edge closes and has the area of the tension law to rounding. ``measures`` are
    named in this module; ``errors`` become the largest of `GAP` and `EXCESS` so far.
    """
    interpolate(steps, order, table, state)
    span = (state.size - SCALARS) // FIELDS
    count = span - 2 * HALO
    w, g = state[:span], state[2 * span : 3 * span]
    scalars = state[3 * span :]
    fill_halo(state[span : 2 * span], count)
    gap, excess = project(state, count, work)
    measures[GAP], measures[EXCESS] = gap, excess
    errors[0], errors[1] = max(errors[0], gap), max(errors[1], excess)
    tangent(w, count, work)
    _, _, area, center_x, center_y = trace(g, scalars[LENGTH], count, work)
    x, y, cosine, sine = work[X], work[Y], work[COSINE], work[SINE]
    least = math.inf
    for i in range(count):
        j = np.uint64(i) + _HALO
        arm_x, arm_y = mean_ahead(x, j) - center_x, mean_ahead(y, j) - center_y
        support = arm_x * sine[j] - arm_y * cosine[j]
        least = support if support < least else least
    kappa = work[KAPPA]
    turn = 2.0 * math.pi / count
    for i in range(np.uint64(count)):
        j = i + _HALO
        kappa[j] = (turn + difference_ahead(w, j)) * (count / scalars[LENGTH]) / g[j]
    fill_halo(kappa, count)
    places(g, count, work[PLACE])
    measures[_TENSION], measures[_LENGTH], measures[_AREA] = scalars[TENSION], scalars[LENGTH], area
    measures[_CENTROID_X] = center_x + scalars[ORIGIN_X]
    measures[_CENTROID_Y] = center_y + scalars[ORIGIN_Y]
    measures[CLEARANCE] = least


@kernel
def fill_frame(
    laws: Any,
    around: Any,
    time: float,
    state: np.ndarray,
    work: np.ndarray,
    log_rate: np.ndarray,
    profile: np.ndarray,
    edge: np.ndarray,
    out: np.ndarray,
) -> None:
    """Fill the rows of ``out`` at equal arclengths.

    ``profile`` holds the parameters far from all surroundings, at one place if they are the same
    all along the edge; ``edge`` has room for them at every node, and a row more.
    """
    nodes, rows = out.shape[1], profile.shape[0]
    _sample(state, work, log_rate, edge[rows], out)
    for row in range(rows):
        for i in range(nodes):
            edge[row, i] = profile[row, 0 if profile.shape[1] == 1 else i]
    balance_frame(laws, around, time, state[state.size - SCALARS + TENSION], edge, out)


@called_by_address(NOTHING, AROUND, NUMBER, NUMBER, ROWS, ROWS)
def balance_frame(
    laws: Any, around: Any, time: float, sigma: float, edge: np.ndarray, out: np.ndarray
) -> None:
    """Fill the rows of ``out`` that follow from the balance of forces; see `fill_frame`.

    The last row of ``edge`` has a guess of phi.
    """
    nodes, rows = out.shape[1], edge.shape[0] - 1
    y = edge[rows]
    if around is not None:
        for i in range(nodes):
            out[_VELOCITY, i] = cosine(out[2, i])
            out[_FRICTION, i] = sine(out[2, i])
        x, z, tangent_x, tangent_z, kappa = out[0], out[1], out[_VELOCITY], out[_FRICTION], out[3]
        far = edge[:rows]
        if around.motion[MOVES] > 0.0:
            phi = y.copy()  # the last bits of a frame do not tell how often the balance was solved
            balance_in_place(
                laws, around, time, x, z, tangent_x, tangent_z, kappa, sigma, out[4], phi, far
            )
        else:
            surround_edge(around, time, x, z, tangent_x, tangent_z, kappa, far)
        _balance(laws, sigma, around.local, y, out)
    else:
        _balance(laws, sigma, edge, y, out)


@expanded_kernel
def _sample(
    state: np.ndarray, work: np.ndarray, log_rate: np.ndarray, y: np.ndarray, out: np.ndarray
) -> None:
    """Fill ``out`` with shape and bound fraction at equal arclengths, ``y`` with a guess of phi."""
    nodes, count = out.shape[1], log_rate.size
    span = count + 2 * HALO
    w, n, g = state[:span], state[span : 2 * span], state[2 * span : 3 * span]
    scalars = state[3 * span :]
    place, turn, apart = work[PLACE], 2.0 * math.pi / count, count / nodes
    weights = np.empty((TAPS + 1, _BLOCK))
    part, half, linear = np.empty(_BLOCK), np.empty(_BLOCK), np.empty(_BLOCK)
    growth, change = np.empty(_BLOCK), np.empty(_BLOCK)
    here, slope = np.empty(_BLOCK), np.empty(_BLOCK)
    first, middle = np.empty(_BLOCK, np.uint64), np.empty(_BLOCK, np.uint64)
    before = HALO  # the node at or before the place
    for start in range(0, nodes, _BLOCK):
        size = min(_BLOCK, nodes - start)
        for b in range(size):
            wanted = (start + b) * apart
            while before < HALO + count - 1 and place[before + 1] <= wanted:
                before += 1
            back = place[before] - place[before - 1]
            spacing = place[before + 1] - place[before]
            ahead = place[before + 2] - place[before + 1]
            part[b] = linear[b] = (wanted - place[before]) / spacing
            growth[b] = 0.5 * (ahead - back) / spacing
            change[b] = (ahead - 2.0 * spacing + back) / (3.0 * spacing)
            first[b] = before - BEFORE
            out[2, start + b] = turn * (before - HALO)
            y[start + b] = log_rate[before - HALO]
        for _ in range(_GUESSES):  # on the cubic through the four nodes around
            for b in range(size):
                bend = growth[b] + (part[b] - 0.5) * change[b]
                part[b] = linear[b] + 0.5 * part[b] * (1.0 - part[b]) * bend
        _lagrange(part, weights, size)
        _weighted(place, first, weights, size, here)
        _to_midpoints(part, first, half, middle, size)
        _lagrange(half, weights, size)
        _weighted(g, middle, weights, size, slope)
        for b in range(size):
            step = ((start + b) * apart - here[b]) / slope[b]
            part[b] += step - 0.5 * growth[b] * step * step
        for b in range(size):
            part[b] = min(max(part[b], 0.0), 1.0)
        _lagrange(part, weights, size)
        _weighted(work[X], first, weights, size, out[0, start:])
        _weighted(work[Y], first, weights, size, out[1, start:])
        _weighted(w, first, weights, size, here)
        for b in range(size):
            out[0, start + b] += scalars[ORIGIN_X]
            out[1, start + b] += scalars[ORIGIN_Y]
            out[2, start + b] += here[b] + turn * part[b]
        _to_midpoints(part, first, half, middle, size)
        _lagrange(half, weights, size)
        _weighted(work[KAPPA], middle, weights, size, out[3, start:])
        _weighted(n, middle, weights, size, out[4, start:])


@kernel
def _balance(laws: Any, sigma: float, edge: np.ndarray, y: np.ndarray, out: np.ndarray) -> None:
    """Fill ``out`` with what follows from the balance of forces."""
    nodes, kappa, bound = y.size, out[3], out[4]
    failed = solve_bonds(laws, y, bound, sigma, kappa, edge)
    if failed != SOLVED:  # the edge left the model's range between the solver's midpoints
        for i in range(failed, nodes):
            root = bond_force(laws, y[i], bound[i], sigma, kappa[i], edge, i)
            y[i] = root if root == root else 0.0
    for i in range(nodes):
        r = off_rate(laws, y[i], edge, i)
        out[5, i] = r
        out[_VELOCITY, i] = velocity(laws, y[i], r, sigma, kappa[i], edge, i)
        out[_FRICTION, i] = friction(laws, y[i], r, bound[i], edge, i)


@kernel
def _to_midpoints(
    part: np.ndarray, first: np.ndarray, half: np.ndarray, middle: np.ndarray, size: int
) -> None:
    """Turn places between nodes into the same between midpoints."""
    for b in range(size):
        early = part[b] < 0.5
        half[b] = part[b] + (0.5 if early else -0.5)
        middle[b] = first[b] - np.uint64(1 if early else 0)


@kernel
def _lagrange(part: np.ndarray, weights: np.ndarray, size: int) -> None:
    """Weights of `TAPS` equal steps, from `BEFORE` before to places ``part`` after one.

    Many places at once, which lets the loops vectorise; the last row of ``weights`` is spare.
    """
    above = weights[TAPS]
    for b in range(size):
        weights[0, b] = above[b] = 1.0
    for tap in range(1, TAPS):
        for b in range(size):
            weights[tap, b] = weights[tap - 1, b] * (part[b] + (BEFORE + 1 - tap))
    for tap in range(TAPS - 1, -1, -1):
        for b in range(size):
            weights[tap, b] *= _SCALES[tap] * above[b]
            above[b] *= part[b] + (BEFORE - tap)


@kernel
def _weighted(
    a: np.ndarray, first: np.ndarray, weights: np.ndarray, size: int, out: np.ndarray
) -> None:
    for b in range(size):
        even = odd = 0.0
        for tap in range(0, TAPS, 2):
            even += weights[tap, b] * a[first[b] + np.uint64(tap)]
            odd += weights[tap + 1, b] * a[first[b] + np.uint64(tap + 1)]
        out[b] = even + odd
