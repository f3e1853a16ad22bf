"""Rates of change at a stage of a step, under parameters that may ramp within the step."""

from __future__ import annotations

import numpy as np

from cellcrawl._compile import kernel, woven_kernel
from cellcrawl.solvers.adaptive.rates import rates


@woven_kernel
def mix(values: np.ndarray, part: float, out: np.ndarray) -> np.ndarray:
    """Parameters at ``part`` of a step from their values at 0, 1/3, 2/3 and 1 of it (or one time).

    ``values`` has shape (times, 8, nodes).
    """
    if values.shape[0] == 1:
        still: np.ndarray = values[0]
        return still
    third = 3.0 * part
    w0 = -(third - 1.0) * (third - 2.0) * (third - 3.0) / 6.0
    w1 = third * (third - 2.0) * (third - 3.0) / 2.0
    w2 = -third * (third - 1.0) * (third - 3.0) / 2.0
    w3 = third * (third - 1.0) * (third - 2.0) / 6.0
    for row in range(out.shape[0]):
        for i in range(out.shape[1]):
            out[row, i] = (
                w0 * values[0, row, i]
                + w1 * values[1, row, i]
                + w2 * values[2, row, i]
                + w3 * values[3, row, i]
            )
    return out


@kernel
def stage_rates(
    part: float,
    state: np.ndarray,
    out: np.ndarray,
    y: np.ndarray,
    edges: np.ndarray,
    mixed: np.ndarray,
    work: np.ndarray,
) -> bool:
    """Rates of ``state`` under the parameters at ``part`` of the step."""
    edge = mix(edges, part, mixed)
    return rates(state, out, y, edge, work)
