"""Second-order Runge-Kutta-Chebyshev steps (Sommeijer, Shampine & Verwer 1998).

Every stage is consistent to second order, so a stiff tension stays close to its slow course; the
fourth-order family amplifies the curvature of that course by the cube of the stiffness.
"""

from __future__ import annotations

import functools
from typing import Final

import numpy as np

from cellcrawl._compile import kernel, woven_kernel
from cellcrawl.solvers.adaptive.drive import (
    BEFORE,
    END,
    END_RATES,
    GO_ON,
    NOW,
    PAUSED,
    START,
    START_RATES,
    Rules,
    after_step,
    error_scales,
    next_step,
)
from cellcrawl.solvers.adaptive.family import Family
from cellcrawl.solvers.adaptive.scheme import Scheme
from cellcrawl.solvers.adaptive.stage_rates import stage_rates
from cellcrawl.solvers.adaptive.step_error import relative_size

_DAMPING: Final = 2.0 / 13.0
_DEGREES: Final = (*range(2, 25), 27, 30, 34, 38, 43, 48, 54, 61, 69, 78, 88, 100, 115, 130, 150)


@functools.cache
def chebyshev_scheme() -> Scheme:
    """Return the family; the rows of ``recurrence`` are ``(a0, a1, a2, b0, b1, c)``."""
    degrees = np.array(_DEGREES)
    limits = (degrees**2 - 1.0) * (2.0 / 3.0) * (1.0 - 2.0 * _DAMPING / 15.0)
    recurrences = [_recurrence(degree) for degree in _DEGREES]
    first = np.cumsum([0, *(len(rows) for rows in recurrences[:-1])])
    unused = np.zeros((degrees.size, 1))
    return Scheme(limits, degrees, first, np.concatenate(recurrences), unused)


def _recurrence(degree: int) -> np.ndarray:
    w0 = 1.0 + _DAMPING / degree**2
    t, d, e = np.zeros((3, degree + 1))  # Chebyshev polynomials and two derivatives at w0
    t[0], t[1], d[1] = 1.0, w0, 1.0
    for j in range(2, degree + 1):
        t[j] = 2.0 * w0 * t[j - 1] - t[j - 2]
        d[j] = 2.0 * t[j - 1] + 2.0 * w0 * d[j - 1] - d[j - 2]
        e[j] = 4.0 * d[j - 1] + 2.0 * w0 * e[j - 1] - e[j - 2]
    w1 = d[degree] / e[degree]
    b = np.ones(degree + 1) * e[2] / d[2] ** 2
    b[2:] = e[2:] / d[2:] ** 2
    c = np.zeros(degree + 1)
    c[2:] = w1 * e[2:] / d[2:]
    c[1] = c[2] / (4.0 * w0)
    rows = np.zeros((degree, 6))
    rows[0] = 1.0, 0.0, 0.0, b[1] * w1, 0.0, 0.0
    for j in range(2, degree + 1):
        mu, nu = 2.0 * b[j] * w0 / b[j - 1], -b[j] / b[j - 2]
        slope = 2.0 * b[j] * w1 / b[j - 1]
        start = -(1.0 - b[j - 1] * t[j - 1]) * slope
        rows[j - 1] = 1.0 - mu - nu, mu, nu, start, slope, c[j - 1]
    return rows


@woven_kernel
def step(
    h: float,
    degree: int,
    recurrence: np.ndarray,
    relief: float,
    contrast: float,
    states: np.ndarray,
    y: np.ndarray,
    edges: np.ndarray,
    mixed: np.ndarray,
    work: np.ndarray,
) -> tuple[bool, float]:
    """Try a step from START to END, with the rates there; return whether it could, and the error.

    ``relief`` lessens the error of a tension that decays within the step anyway;
    ``contrast`` is the size of the waves on the edge.
    """
    start, f0, end, f = states[START], states[START_RATES], states[END], states[END_RATES]
    now, before = states[NOW], states[BEFORE]
    size = start.size
    first = h * recurrence[0, 3]
    for k in range(size):
        before[k] = start[k]
        now[k] = start[k] + first * f0[k]
    for j in range(1, degree + 1):
        part = recurrence[j, 5] if j < degree else 1.0
        if not stage_rates(part, now, f, y, edges, mixed, work):
            return False, np.inf
        if j == degree:
            break
        a0, a1, a2 = recurrence[j, 0], recurrence[j, 1], recurrence[j, 2]
        b0, b1 = h * recurrence[j, 3], h * recurrence[j, 4]
        for k in range(size):
            before[k] = a0 * start[k] + a1 * now[k] + a2 * before[k] + b0 * f0[k] + b1 * f[k]
        now, before = before, now
    for k in range(size):
        end[k] = now[k]
    for k in range(size):
        before[k] = 0.8 * (start[k] - end[k]) + 0.4 * h * (f0[k] + f[k])
    return True, relative_size(before, end, y.size, relief, contrast)


@kernel
def run(
    target: float,
    end: float,
    most_steps: int,
    rules: Rules,
    scheme: Scheme,
    control: np.ndarray,
    counters: np.ndarray,
    states: np.ndarray,
    y: np.ndarray,
    edges: np.ndarray,
    mixed: np.ndarray,
    work: np.ndarray,
) -> int:
    """Step until ``target`` is reached or something is for the caller to do; see `drive`."""
    for _ in range(most_steps):
        code, h, k = next_step(target, end, scheme, control, counters)
        if code != GO_ON:
            return code
        relief, contrast = error_scales(h, rules, control)
        rows = scheme.recurrence[scheme.first[k] :]
        solved, size = step(
            h, scheme.degrees[k], rows, relief, contrast, states, y, edges, mixed, work
        )
        code = after_step(h, solved, size, end, rules, control, counters, states, y, edges, work)
        if code != GO_ON:
            return code
    return PAUSED


FAMILY: Final = Family(
    order=2,
    power=2.0 / 3.0,  # the estimate is of third order
    amplified=0.05,
    tension_weight=1.0,
    tolerance=lambda rtol: (10.0 * rtol) ** 1.5,
    scheme=chebyshev_scheme,
    run=run,
)
