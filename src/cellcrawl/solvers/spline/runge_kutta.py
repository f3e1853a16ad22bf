"""One step of third order: explicit for shape and binding, implicit for diffusion and tension.

ARK3(2)4L[2]SA of Kennedy & Carpenter (Appl. Numer. Math. 44, 139, 2003). Markers and binding take
its explicit part, diffusion and tension its implicit, L-stable part. A stage's markers are known
before its diffusion, and both before its tension, so that every implicit solve is small: a cyclic
tridiagonal system, then one number. The area that the tension stands for is weighed like it, stage
by stage, and the outline scaled to it at the end of the step: otherwise errors of the step add up
in ``sigma - G A``, and nothing takes them away.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from cellcrawl.numerics.kernels import kernel
from cellcrawl.solvers.spline.balance import (
    BALANCED,
    NO_ROOT,
    rates,
    solve_balance_in_place,
    solve_tension,
)
from cellcrawl.solvers.spline.linkers import DIFFUSIVITY, second_derivative_after
from cellcrawl.solvers.spline.outline import KAPPA, LOG_R, XU, YU, N, X, Y, copy, enclose, measure
from cellcrawl.surroundings.place import SETTLED, UNSETTLED, settle, surround_edge

STAGES = 4
EXPLICIT_LIMIT = 2.5  # step times decay rate; the explicit part alone is stable up to 3.66
SPREADING = 3  # row of a stage's `slopes` after those of x, y and n: D n_ss

_GAMMA = 1767732205903 / 4055673282236
_B1 = 1471266399579 / 7840856788654
_B2 = -4482444167858 / 7529755066697
_B3 = 11266239266428 / 11593286722821
_TIMES = np.array([0.0, 2.0 * _GAMMA, 0.6, 1.0])
_WEIGHTS = np.array([_B1, _B2, _B3, _GAMMA])
_EXPLICIT = np.array(
    [
        [0.0, 0.0, 0.0],
        [2.0 * _GAMMA, 0.0, 0.0],
        [5535828885825 / 10492691773637, 788022342437 / 10882634858940, 0.0],
        [
            6485989280629 / 16251701735622,
            -4246266847089 / 9704473918619,
            10755448449292 / 10357097424841,
        ],
    ]
)
_IMPLICIT = np.array(
    [
        [0.0, 0.0, 0.0],
        [_GAMMA, 0.0, 0.0],
        [2746238789719 / 10658868560708, -640167445237 / 6845629431997, 0.0],
        [_B1, _B2, _B3],
    ]
)


@kernel
def between_ends(ends: np.ndarray, part: float, out: np.ndarray) -> None:
    """Edge parameters at ``part`` of the way from ``ends[0]`` to ``ends[1]``."""
    for row in range(out.shape[0]):
        for i in range(out.shape[1]):
            out[row, i] = ends[0, row, i] + part * (ends[1, row, i] - ends[0, row, i])


@kernel
def step(
    laws: Any,
    around: Any,
    time: float,
    dt: float,
    begin: float,
    end: float,
    varies: bool,
    ends: np.ndarray,
    tension_rates: np.ndarray,
    fields: np.ndarray,
    tension: float,
    area: float,
    shape: np.ndarray,
    edge: np.ndarray,
    slopes: np.ndarray,
    work: np.ndarray,
) -> tuple[int, int, float, float]:
    """Advance ``fields`` (x, y, n, log r at the markers) by ``dt`` in place.

    Parameters
    ----------
    around
        None, or surroundings at work, as in `cellcrawl.surroundings.place`.
    time : float
        At the beginning of the step.
    begin, end : float
        Where the step lies between the times of ``ends`` and ``tension_rates``, if ``varies``.
    ends : array, shape (2, rows, markers)
        Parameters along the edge, linear in time between the two.
    tension_rates : array, shape (2,)
        ``G`` likewise.
    tension, area : float
        The area is the one that goes with the tension: ``dA = d sigma / G``.
    shape : array, shape (SHAPE_ROWS, markers)
        The `measure` of the markers before and after.
    edge : array, shape (rows, markers)
        The parameters now; left at those of the end.
    slopes : array, shape (STAGES, 4, markers)
    work : array, shape (4 + LINKER_ROWS, markers)

    Returns
    -------
    code, marker : int
        `BALANCED`, or why there is no step and where; ``fields`` are then of no use.
    tension, area : float
    """
    stage, spare = work[:4], work[4:]
    rate = tension_rates[0]
    tension_slopes, area_slopes = np.zeros(STAGES), np.zeros(STAGES)
    copy(fields, stage)
    sigma = tension
    for i in range(STAGES):
        if varies:
            part = begin + _TIMES[i] * (end - begin)
            between_ends(ends, part, edge)
            rate = tension_rates[0] + part * (tension_rates[1] - tension_rates[0])
        own = slopes[i]
        implicit = 0.0 if i == 0 else dt * _GAMMA
        if i > 0:
            _combine(dt, i, fields, slopes, stage)
            measure(stage, shape)
        local = edge
        if around is not None:
            now = time + _TIMES[i] * dt
            x, y, xu, yu, kappa = stage[X], stage[Y], shape[XU], shape[YU], shape[KAPPA]
            surround_edge(around, now, x, y, xu, yu, kappa, edge)
            local = around.local
        second_derivative_after(stage, local, implicit, shape, own[SPREADING], spare)
        for node in range(stage.shape[1]):
            own[SPREADING, node] *= local[DIFFUSIVITY, node]
            stage[N, node] += implicit * own[SPREADING, node]
        if i > 0:
            known = tension
            for j in range(i):
                known += dt * _IMPLICIT[i, j] * tension_slopes[j]
            while True:
                code, marker, sigma = solve_tension(
                    laws, stage, sigma, known, implicit * rate, shape, local
                )
                if code != BALANCED:
                    return code, marker, tension, area
                if around is None:
                    break
                phi = stage[LOG_R]
                state = settle(laws, around, now, x, y, xu, yu, kappa, sigma, phi, edge)
                if state == UNSETTLED:
                    return NO_ROOT, 0, tension, area
                if state == SETTLED:
                    break
        area_slopes[i] = rates(laws, stage, sigma, shape, local, own)
        tension_slopes[i] = rate * area_slopes[i]

    for j in range(STAGES):
        tension += dt * _WEIGHTS[j] * tension_slopes[j]
        area += dt * _WEIGHTS[j] * area_slopes[j]
        for node in range(fields.shape[1]):
            weight = dt * _WEIGHTS[j]
            fields[X, node] += weight * slopes[j, X, node]
            fields[Y, node] += weight * slopes[j, Y, node]
            fields[N, node] += weight * (slopes[j, N, node] + slopes[j, SPREADING, node])
    measure(fields, shape)
    enclose(area, fields, shape)
    copy(stage[LOG_R:], fields[LOG_R:])
    code, marker = solve_balance_in_place(laws, around, time + dt, fields, tension, shape, edge)
    return code, marker, tension, area


@kernel
def _combine(dt: float, i: int, fields: np.ndarray, slopes: np.ndarray, stage: np.ndarray) -> None:
    """Markers of stage ``i``, and its bound fraction but for the stage's own diffusion."""
    copy(fields[:LOG_R], stage)
    for j in range(i):
        explicit, implicit = dt * _EXPLICIT[i, j], dt * _IMPLICIT[i, j]
        for node in range(fields.shape[1]):
            stage[X, node] += explicit * slopes[j, X, node]
            stage[Y, node] += explicit * slopes[j, Y, node]
            stage[N, node] += explicit * slopes[j, N, node] + implicit * slopes[j, SPREADING, node]
