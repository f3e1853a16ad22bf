"""Markers spread evenly again along the outline they are on."""

from __future__ import annotations

import numpy as np

from cellcrawl.numerics.kernels import kernel
from cellcrawl.solvers.spline.outline import (
    LOG_R,
    PACE,
    SEGMENT,
    SPEED,
    XU,
    XUU,
    YU,
    YUU,
    N,
    X,
    Y,
    copy,
    measure,
)
from cellcrawl.solvers.spline.periodic import between, derivatives

SPREAD_ROWS = 3


@kernel
def spread_evenly(fields: np.ndarray, shape: np.ndarray, out: np.ndarray, work: np.ndarray) -> None:
    """Fields at nodes equally spaced in arclength, the first at the first marker.

    Values between markers are quintic in the parameter, from the spline's derivatives at both
    ends. ``shape`` is the `measure` of the markers; ``out`` has shape (4, nodes) and may have
    another number of nodes; its off-rates are linear in between, to be solved for anew. ``work``
    has shape (SPREAD_ROWS, markers).
    """
    markers, nodes = fields.shape[1], out.shape[1]
    slope, bend = work[0], work[1]
    derivatives(fields[N], slope, bend, work[2])
    length = 0.0
    for i in range(markers):
        length += shape[SEGMENT, i]
    i, begin = 0, 0.0
    for node in range(nodes):
        wanted = length * node / nodes
        while begin + shape[SEGMENT, i] <= wanted and i < markers - 1:
            begin += shape[SEGMENT, i]
            i += 1
        j = i + 1 if i < markers - 1 else 0
        part = _part_at(shape, i, j, wanted - begin)
        for row, first, second in ((X, XU, XUU), (Y, YU, YUU)):
            out[row, node] = between(
                fields[row, i],
                shape[first, i],
                shape[second, i],
                fields[row, j],
                shape[first, j],
                shape[second, j],
                part,
            )
        out[N, node] = between(
            fields[N, i], slope[i], bend[i], fields[N, j], slope[j], bend[j], part
        )
        out[LOG_R, node] = fields[LOG_R, i] + part * (fields[LOG_R, j] - fields[LOG_R, i])


@kernel
def _part_at(shape: np.ndarray, i: int, j: int, distance: float) -> float:
    """Where between markers i and j the arclength from i is ``distance``, by Newton's method."""
    whole = shape[SEGMENT, i]
    part = distance / whole
    for _ in range(6):
        reached = between(
            0.0, shape[SPEED, i], shape[PACE, i], whole, shape[SPEED, j], shape[PACE, j], part
        )
        speed = shape[SPEED, i] + part * (shape[SPEED, j] - shape[SPEED, i])
        change = (distance - reached) / speed
        part = min(max(part + change, 0.0), 1.0)
        if abs(change) < 1e-15:
            break
    return float(part)


@kernel
def remesh(fields: np.ndarray, shape: np.ndarray, work: np.ndarray) -> None:
    """Move the markers, in place, to equal spacing along their outline; the first stays.

    ``shape`` is the `measure` of the markers before and after. ``work`` has shape
    (4 + SPREAD_ROWS, markers).
    """
    new = work[:4]
    spread_evenly(fields, shape, new, work[4:])
    copy(new, fields)
    measure(fields, shape)
