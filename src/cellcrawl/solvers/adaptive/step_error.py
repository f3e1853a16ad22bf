"""The size of an error in a state, relative to what a cell is made of."""

from __future__ import annotations

import math

import numpy as np

from cellcrawl.numerics.kernels import kernel
from cellcrawl.solvers.adaptive.entries import AREA, LENGTH, ORIGIN_X, ORIGIN_Y, TENSION
from cellcrawl.solvers.adaptive.staggered import HALO, sum_of_squares

_TENSION_SCALE = 100.0
_DENSITY = 1.0


@kernel
def relative_size(error: np.ndarray, state: np.ndarray, nodes: int, contrast: float) -> float:
    """Root of the summed squares: angle and bound fraction in the mean, scalars relative.

    Angle and bound fraction count against ``contrast``, the size of the waves on the edge: while
    small waves grow, so do their errors. The position counts against a radius of 1. Infinity when
    the error is not a number.
    """
    span = nodes + 2 * HALO
    square = sum_of_squares(error[:span], nodes) + sum_of_squares(error[span:], nodes)
    square /= nodes * contrast**2
    square += sum_of_squares(error[2 * span :], nodes) * (_DENSITY**2 / nodes)
    e, u = error[3 * span :], state[3 * span :]
    square += (e[LENGTH] / u[LENGTH]) ** 2 + (e[AREA] / u[AREA]) ** 2
    square += (e[TENSION] / (abs(u[TENSION]) + _TENSION_SCALE)) ** 2
    square += e[ORIGIN_X] ** 2 + e[ORIGIN_Y] ** 2
    size = math.sqrt(square)
    return size if size == size else np.inf
