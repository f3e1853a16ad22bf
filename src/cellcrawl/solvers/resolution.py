"""How many nodes a state needs, from the Fourier spectrum of its shape and bound fraction."""

from __future__ import annotations

import math
from typing import Final

import numpy as np

NODE_COUNTS: Final = tuple(
    count for k in range(4, 12) for count in (2 ** (k + 2), 3 * 2 ** (k + 1)) if count <= 4096
)  # 64, 96, 128, 192, ... 4096
_CUTOFF = 2.2  # phase per node up to which the stencils are right to a tenth
_POWER = 10
_COARSEN = 0.1  # leave a grid for a coarser one only if that one has this much to spare


def spectrum(angle: np.ndarray, bound: np.ndarray) -> np.ndarray:
    """Size of every wave in curvature and bound fraction, shape (nodes // 2 + 1,).

    ``angle`` is the tangent angle less its winding. Scaled so that the squares sum to the mean
    square.
    """
    k = np.arange(angle.size // 2 + 1)
    waves = np.abs(np.fft.rfft(np.stack([angle, bound]), axis=1)) / angle.size
    return np.asarray(k * np.hypot(waves[0], waves[1]) * math.sqrt(2.0))


def grid_error(waves: np.ndarray, nodes: int) -> float:
    """Mean-square error the stencils on ``nodes`` nodes make in a state with these waves."""
    phase = (2.0 * math.pi / nodes) * np.arange(waves.size)
    missed = np.minimum((phase / _CUTOFF) ** _POWER, 1.0)
    return float(np.sqrt(np.sum((missed * waves) ** 2)))


def fewest_nodes(waves: np.ndarray, allowed: float, low: int, high: int) -> int:
    """Return the smallest node count from ``low`` to ``high`` with an error up to ``allowed``.

    One more than the largest, ``high + 1``, if none will do.
    """
    for nodes in NODE_COUNTS:
        if low <= nodes <= high and grid_error(waves, nodes) <= allowed:
            return nodes
    return high + 1


def wanted_nodes(waves: np.ndarray, nodes: int, allowed: float, low: int, high: int) -> int:
    """Return the node count to go on with from ``nodes``; ``high + 1`` asks for more than allowed."""
    if grid_error(waves, nodes) > allowed:
        finer = [count for count in NODE_COUNTS if nodes < count <= high]
        return finer[0] if finer else high + 1
    return min(nodes, fewest_nodes(waves, _COARSEN * allowed, low, high))
