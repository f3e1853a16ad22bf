"""Many steps in one call: remeshing, steps split where stability needs it, breakdowns."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from cellcrawl.numerics.kernels import kernel
from cellcrawl.solvers.spline.balance import (
    BALANCED,
    UNSETTLED,
    fastest_explicit_rate,
    solve_balance_in_place,
)
from cellcrawl.solvers.spline.linkers import LINKER_ROWS
from cellcrawl.solvers.spline.outline import (
    KAPPA,
    SHAPE_ROWS,
    XU,
    YU,
    X,
    Y,
    copy,
    enclose,
    measure,
    sharpest_turn,
    unevenness,
)
from cellcrawl.solvers.spline.periodic import ZIGZAG
from cellcrawl.solvers.spline.remeshing import SPREAD_ROWS, remesh
from cellcrawl.solvers.spline.runge_kutta import EXPLICIT_LIMIT, between_ends, step
from cellcrawl.surroundings.place import surround_edge

# `scalars`: the tangent's angle at the first marker, continuous; the area the tension goes with
TENSION, ANGLE, AREA = range(3)
SCALARS = 3
STEPS, PARTS, REMESHINGS, RETRIES, MOST_PARTS = range(5)  # `counters`
STEPPED = BALANCED
UNRESOLVED, TOO_STIFF = UNSETTLED + 1, UNSETTLED + 2

UNEVEN = 1.3  # largest over smallest spacing that calls for even markers
LARGEST_TURN = 1.5  # radians from marker to marker beyond which a shape is not resolved
LARGEST_PARTS = 20_000
_RETRIES = 3  # each splits the step four times as fine

WORK_ROWS = SHAPE_ROWS + 4 + max(LINKER_ROWS, SPREAD_ROWS)


@kernel
def advance(
    laws: Any,
    around: Any,
    time: float,
    steps: int,
    dt: float,
    varies: bool,
    ends: np.ndarray,
    tension_rates: np.ndarray,
    fields: np.ndarray,
    scalars: np.ndarray,
    counters: np.ndarray,
    before_fields: np.ndarray,
    before_scalars: np.ndarray,
    slopes: np.ndarray,
    work: np.ndarray,
) -> tuple[int, int, int]:
    """Take up to ``steps`` steps of ``dt`` in place, from ``time``.

    ``around`` is None, or surroundings at work, as in `cellcrawl.surroundings.place`.

    ``fields`` has shape (4, markers): x, y, n, log r; ``ends`` (2, rows, markers) and
    ``tension_rates`` (2,) are the parameters at both ends of the call, which differ only if
    ``varies`` (then ``steps`` is 1); ``slopes`` has shape
    (STAGES, 4, markers) and ``work`` (WORK_ROWS, markers). ``before_fields`` and ``before_scalars``
    are left at the beginning of the last step, on the same markers as its end.

    Returns
    -------
    code : int
        `STEPPED`, or why the next step cannot be taken. The state is then the last valid one.
    marker : int
        The marker it happened at.
    taken : int
        Steps taken.
    """
    shape = work[:SHAPE_ROWS]
    spare = work[SHAPE_ROWS:]
    edge = np.empty(ends.shape[1:])
    measure(fields, shape)
    for taken in range(steps):
        copy(fields, before_fields)
        for row in range(SCALARS):
            before_scalars[row] = scalars[row]
        between_ends(ends, 0.0, edge)
        if unevenness(shape) > UNEVEN:
            remesh(fields, shape, spare)
            enclose(scalars[AREA], fields, shape)
            code, marker = solve_balance_in_place(
                laws, around, time + taken * dt, fields, scalars[TENSION], shape, edge
            )
            if code != BALANCED:
                copy(before_fields, fields)
                return code, marker, taken
            counters[REMESHINGS] += 1
            copy(fields, before_fields)
        turn, marker = sharpest_turn(shape)
        if turn > LARGEST_TURN:
            return UNRESOLVED, marker, taken
        local = edge
        if around is not None:
            now = time + taken * dt
            x, y, kappa = fields[X], fields[Y], shape[KAPPA]
            surround_edge(around, now, x, y, shape[XU], shape[YU], kappa, edge)
            local = around.local
        rate = fastest_explicit_rate(laws, fields, scalars[TENSION], shape, local, ZIGZAG)
        if not rate * dt < EXPLICIT_LIMIT * LARGEST_PARTS:
            return TOO_STIFF, marker, taken
        parts = math.floor(rate * dt / EXPLICIT_LIMIT) + 1
        code = UNSETTLED
        for _ in range(1 + _RETRIES):
            tension, area = scalars[TENSION], scalars[AREA]
            for part in range(parts):
                code, marker, tension, area = step(
                    laws,
                    around,
                    time + (taken + part / parts) * dt,
                    dt / parts,
                    part / parts,
                    (part + 1) / parts,
                    varies,
                    ends,
                    tension_rates,
                    fields,
                    tension,
                    area,
                    shape,
                    edge,
                    slopes,
                    spare,
                )
                if code != BALANCED:
                    break
            counters[PARTS] += part + 1
            if code == BALANCED:
                break
            counters[RETRIES] += 1
            copy(before_fields, fields)
            measure(fields, shape)
            between_ends(ends, 0.0, edge)
            parts *= 4
        if code != BALANCED:
            return code, marker, taken
        scalars[TENSION], scalars[AREA] = tension, area
        turned = (math.atan2(shape[YU, 0], shape[XU, 0]) - scalars[ANGLE]) / (2.0 * math.pi)
        scalars[ANGLE] += 2.0 * math.pi * (turned - math.floor(turned + 0.5))
        counters[STEPS] += 1
        counters[MOST_PARTS] = max(counters[MOST_PARTS], parts)
    return STEPPED, 0, steps
