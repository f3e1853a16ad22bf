"""How many nodes a state needs: what the grid misses of its shape and bound fraction.

The measure is the tenth difference of the slopes of angle and bound fraction along the edge, which
goes as the error of the tenth-order stencils. It can be taken on the grid, at each step, or from
the Fourier spectrum, which also tells it for other grids.
"""

from __future__ import annotations

import math
from typing import Final

import numpy as np

from cellcrawl._compile import kernel
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
COARSER_MISSES: Final = 7.0  # about how much more the next coarser grid misses
LEAST_ALLOWANCE: Final = 0.25
MOST_ALLOWANCE: Final = 2.0
_REFINE = 1.1  # least factor of a refinement
_SCALE = 2.2
_DOUBLE_DIFFERENCES = 5
_FORMED = 0.1  # spread of the bound fraction along the edge of a formed cell
_AMPLIFIED = 5.0  # care with the steps before (measured)
_FLAT = 1e-6  # slopes below this are as good as none
_ROUNDING = 3e-13  # waves smaller than this are what rounding leaves of none
_HALO = np.uint64(HALO)
_1 = np.uint64(1)


@kernel
def missed(state: np.ndarray, nodes: int, work: np.ndarray) -> tuple[float, float]:
    """Part of the slopes that the grid misses, and their size, of a state whose halos are filled.

    ``work`` has two rows with halos.
    """
    span = nodes + 2 * HALO
    square = slopes = 0.0
    for field in range(2):
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
    """How far the cell has formed, up to 1, and far less before: then errors grow with its waves.

    An instability that takes the bound fraction from a spread of 1e-4 to one of 0.1 multiplies the
    errors made on the way as much, so the first steps must be the most accurate ones.
    """
    mean = total(n, nodes) / nodes
    square = 0.0
    for i in range(HALO, HALO + nodes):
        square += (n[i] - mean) ** 2
    spread = min(math.sqrt(square / nodes) / _FORMED, 1.0)
    return 1.0 / (1.0 + _AMPLIFIED * (1.0 - spread))


@kernel
def allowance(allowed: float, contrast: float) -> float:
    """What may be missed now: less while the waves are small, for their errors grow with them."""
    return allowed * min(max(contrast, LEAST_ALLOWANCE), MOST_ALLOWANCE)


def spectrum(angle: np.ndarray, bound: np.ndarray) -> np.ndarray:
    """Size of every wave in the slopes of angle and bound fraction, shape (nodes // 2 + 1,).

    ``angle`` is the tangent angle less its winding. The squares sum to the mean square.
    """
    k = np.arange(angle.size // 2 + 1)
    waves = np.abs(np.fft.rfft(np.stack([angle, bound]), axis=1)) / angle.size
    waves[waves < _ROUNDING] = 0.0
    return np.asarray(k * np.hypot(waves[0], waves[1]) * math.sqrt(2.0))


def missed_on(waves: np.ndarray, nodes: int) -> float:
    """Part of the slopes that a grid of ``nodes`` nodes misses of a state with these waves."""
    phase = (2.0 * math.pi / nodes) * np.arange(waves.size)
    part = (2.0 * np.sin(0.5 * phase) / _SCALE) ** (2 * _DOUBLE_DIFFERENCES)
    part[phase > math.pi] = 1.0
    size = math.sqrt(float(np.sum(waves**2)))
    return math.sqrt(float(np.sum((part * waves) ** 2))) / (size + _FLAT)


def fewest_nodes(waves: np.ndarray, allowed: float, low: int, high: int) -> int:
    """Return the smallest node count from ``low`` to ``high`` that misses no more than ``allowed``.

    ``high + 1`` if none will do.
    """
    for nodes in NODE_COUNTS:
        if low <= nodes <= high and missed_on(waves, nodes) <= allowed:
            return nodes
    return high + 1


def wanted_nodes(waves: np.ndarray, nodes: int, allowed: float, low: int, high: int) -> int:
    """Return the node count to go on with from ``nodes``; ``high + 1`` if it is above ``high``."""
    if missed_on(waves, nodes) > allowed:
        finer = [count for count in NODE_COUNTS if _REFINE * nodes <= count <= high]
        return finer[0] if finer else high + 1
    return min(nodes, fewest_nodes(waves, COARSEN * allowed, low, high))
