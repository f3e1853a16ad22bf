"""How many nodes a state needs: what the grid misses of its shape and bound fraction.

The measure is the tenth difference of the slopes of angle and bound fraction along the edge, which
goes as the error of the tenth-order stencils. It can be taken on the grid, at each step, or from
the Fourier spectrum, which also tells it for other grids.
"""

from __future__ import annotations

import math
from typing import Final

import numpy as np

from cellcrawl.numerics.elementary import sine
from cellcrawl.numerics.kernels import inlined_kernel, kernel
from cellcrawl.solvers.adaptive.entries import FIELDS
from cellcrawl.solvers.adaptive.staggered import (
    HALO,
    difference_ahead,
    fill_halo,
    sum_of_squares,
    total,
)

NODE_COUNTS: Final[tuple[int, ...]] = (
    *(part * 16 * 2**k for k in range(6) for part in (4, 5, 6, 7)),
    2048,
    2560,
    3072,
    3584,
    4096,
)
COARSEN: Final = 0.6  # go to a coarser grid only if it misses this part of what is allowed
COARSER_MISSES: Final = 4.0  # about how much more the next coarser grid misses at its worst
LEAST_ALLOWANCE: Final = 0.25
MOST_ALLOWANCE: Final = 2.0
_FORMING = 8.0  # (measured)
_REFINE = 1.1  # least factor of a refinement
_SCALE = 2.2
_DOUBLE_DIFFERENCES = 5
_FORMED = 0.1  # spread of the bound fraction along the edge of a formed cell
_FLAT = 1e-6  # slopes below this are as good as none
_HALO = np.uint64(HALO)
_1 = np.uint64(1)


@kernel
def missed(state: np.ndarray, nodes: int, work: np.ndarray) -> tuple[float, float]:
    """Part of the slopes that the grid misses, and their size, of a state whose halos are filled.

    ``work`` has two rows with halos.
    """
    span = nodes + 2 * HALO
    square = slopes = 0.0
    for field in range(FIELDS):
        values = state[field * span : (field + 1) * span]
        now, then = work[0], work[1]
        for i in range(np.uint64(nodes)):
            now[i + _HALO] = difference_ahead(values, i + _HALO)
        slopes += sum_of_squares(now, nodes)
        for _ in range(_DOUBLE_DIFFERENCES):
            fill_halo(now, nodes)
            for i in range(np.uint64(nodes)):
                j = i + _HALO
                then[j] = (now[j + _1] - now[j]) - (now[j] - now[j - _1])
            now, then = then, now
        square += sum_of_squares(now, nodes)
    slope = nodes / (2.0 * math.pi)
    size = slope * math.sqrt(slopes / nodes)
    lost = slope * math.sqrt(square / nodes) / _SCALE ** (2 * _DOUBLE_DIFFERENCES)
    return lost / (size + _FLAT), size


@kernel
def formation(n: np.ndarray, nodes: int) -> float:
    """How far the cell has formed, up to 1: the spread of its bound fraction along the edge.

    Until then what a grid misses is soon smoothed away or grown over; then it adds up.
    """
    mean = total(n, nodes) / nodes
    square = 0.0
    for i in range(HALO, HALO + nodes):
        square += (n[i] - mean) ** 2
    return min(math.sqrt(square / nodes) / _FORMED, 1.0)


@inlined_kernel
def allowance(allowed: float, contrast: float, formed: bool) -> float:
    """What may be missed now.

    Less while the waves are small, for their errors grow with them; more until the cell has formed,
    for only what is missed for long adds up.
    """
    share = min(max(contrast, LEAST_ALLOWANCE), MOST_ALLOWANCE)
    return allowed * share * (1.0 if formed else _FORMING)


@kernel
def missed_on(waves: np.ndarray, nodes: int) -> float:
    """Part of the slopes that a grid of ``nodes`` nodes misses of a state with these `slopes`."""
    square = lost = 0.0
    for k in range(waves.size):
        phase = 2.0 * math.pi / nodes * k
        part = 1.0
        if phase <= math.pi:
            part = (2.0 * sine(0.5 * phase) / _SCALE) ** (2 * _DOUBLE_DIFFERENCES)
        square += waves[k] * waves[k]
        lost += (part * waves[k]) ** 2
    return math.sqrt(lost) / (math.sqrt(square) + _FLAT)


@kernel
def fewest_nodes(waves: np.ndarray, allowed: float, low: int, high: int) -> int:
    """Return the smallest node count from ``low`` to ``high`` that misses no more than ``allowed``.

    ``high + 1`` if none will do.
    """
    for nodes in NODE_COUNTS:
        if low <= nodes <= high and missed_on(waves, nodes) <= allowed:
            return nodes
    return high + 1


@inlined_kernel
def finer(nodes: int, high: int) -> int:
    """Return the next larger node count up to ``high``; ``nodes`` if there is none."""
    for count in NODE_COUNTS:
        if _REFINE * nodes <= count <= high:
            return count
    return nodes


@inlined_kernel
def coarser(nodes: int, low: int) -> int:
    """Return the next smaller node count from ``low`` on; ``nodes`` if there is none."""
    found = nodes
    for count in NODE_COUNTS:
        if low <= count and _REFINE * count <= nodes:
            found = count
    return found
