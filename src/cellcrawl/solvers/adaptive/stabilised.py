"""Fourth-order stabilised explicit steps with an embedded third-order error estimate.

The family has the structure of ROCK4 (Abdulle, SIAM J. Sci. Comput. 23, 2002): a three-term
recurrence for all but four stages, then four stages that complete order four, with a nearly optimal
real stability interval of about ``0.35 degree**2``. Its coefficients were derived anew; see
``tools/stabilised_scheme.py``.
"""

from __future__ import annotations

from typing import Final

import numpy as np

from cellcrawl._compile import kernel, woven_kernel
from cellcrawl.solvers.adaptive.drive import (
    BEFORE,
    END,
    END_RATES,
    FIRST_OF_FOUR,
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
from cellcrawl.solvers.adaptive.scheme import Scheme, fourth_order_scheme
from cellcrawl.solvers.adaptive.stage_rates import stage_rates
from cellcrawl.solvers.adaptive.step_error import relative_size

_STAGE_TIMES: Final = 15  # where they begin in `finish`


@woven_kernel
def add(part: float, values: np.ndarray, out: np.ndarray) -> None:
    """Add ``part`` of ``values`` to ``out``."""
    for k in range(out.size):
        out[k] += part * values[k]


@woven_kernel
def step(
    h: float,
    degree: int,
    recurrence: np.ndarray,
    finish: np.ndarray,
    relief: float,
    contrast: float,
    states: np.ndarray,
    y: np.ndarray,
    edges: np.ndarray,
    mixed: np.ndarray,
    work: np.ndarray,
) -> tuple[bool, float]:
    """Try a step from START to END, with the rates there; return whether it could, and the error.

    ``recurrence`` has rows ``(mu, nu, kappa, c)``; ``finish`` the coefficients of the last stages.
    ``relief`` lessens the error of a tension that decays within the step anyway;
    ``contrast`` is the size of the waves on the edge.
    """
    start, f0, end, f = states[START], states[START_RATES], states[END], states[END_RATES]
    now, before = states[NOW], states[BEFORE]
    size = start.size
    first = h * recurrence[0, 0]
    for k in range(size):
        before[k] = start[k]
        now[k] = start[k] + first * f0[k]
    for j in range(1, degree - 4):
        if not stage_rates(recurrence[j, 3], now, f, y, edges, mixed, work):
            return False, np.inf
        mu, nu, kappa = h * recurrence[j, 0], recurrence[j, 1], recurrence[j, 2]
        for k in range(size):
            before[k] = mu * f[k] + nu * now[k] + kappa * before[k]
        now, before = before, now
    weight = 0  # of `finish`: a21, a31, a32, a41, a42, a43, b1..b4, e1..e5, c of four stages
    for stage in range(5):
        for k in range(size):
            end[k] = now[k]
        for j in range(stage):
            add(h * finish[weight], states[FIRST_OF_FOUR + j], end)
            weight += 1
        part = finish[_STAGE_TIMES + stage] if stage < 4 else 1.0
        out = states[FIRST_OF_FOUR + stage] if stage < 4 else f
        if not stage_rates(part, end, out, y, edges, mixed, work):
            return False, np.inf
    error = before
    e5 = h * finish[weight + 4]
    for k in range(size):
        error[k] = e5 * f[k]
    for j in range(4):
        add(h * finish[weight + j], states[FIRST_OF_FOUR + j], error)
    return True, relative_size(error, end, y.size, relief, contrast)


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
            h,
            scheme.degrees[k],
            rows,
            scheme.finish[k],
            relief,
            contrast,
            states,
            y,
            edges,
            mixed,
            work,
        )
        code = after_step(h, solved, size, end, rules, control, counters, states, y, edges, work)
        if code != GO_ON:
            return code
    return PAUSED


FAMILY: Final = Family(
    order=4,
    power=1.0,
    amplified=0.002,
    tension_weight=6.0,
    tolerance=lambda rtol: 10.0 * rtol * (rtol / 1e-4) ** 0.15,
    scheme=fourth_order_scheme,
    run=run,
)
