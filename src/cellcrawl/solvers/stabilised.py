"""Fourth-order stabilised explicit steps with an embedded third-order error estimate.

The family has the structure of ROCK4 (Abdulle, SIAM J. Sci. Comput. 23, 2002): a three-term
recurrence for all but four stages, then four stages that complete order four, with a nearly optimal
real stability interval of about ``0.35 degree**2``. Its coefficients were derived anew; see
``tools/stabilised_scheme.py``.
"""

from __future__ import annotations

from typing import Final

import numpy as np

from cellcrawl._compile import kernel
from cellcrawl.solvers.stage_rates import stage_rates
from cellcrawl.solvers.step_error import relative_size

ORDER: Final = 4
START, START_RATES, END, END_RATES = 2, 3, 4, 5  # rows of `states`
BEFORE, NOW = 6, 7  # and then the rates of the last four stages
STATE_ROWS: Final = 12


@kernel
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
    start, end = states[START], states[END]
    now, before = states[NOW], states[BEFORE]
    f = states[END_RATES]
    f1, f2, f3, f4 = states[8], states[9], states[10], states[11]
    size = start.size
    first = h * recurrence[0, 0]
    f0 = states[START_RATES]
    for k in range(size):
        before[k] = start[k]
        now[k] = start[k] + first * f0[k]
    for j in range(1, degree - 4):
        mu, nu, kappa = h * recurrence[j, 0], recurrence[j, 1], recurrence[j, 2]
        if not stage_rates(recurrence[j, 3], now, f, y, edges, mixed, work):
            return False, np.inf
        for k in range(size):
            before[k] = mu * f[k] + nu * now[k] + kappa * before[k]
        now, before = before, now
    stage = before
    if not stage_rates(finish[15], now, f1, y, edges, mixed, work):
        return False, np.inf
    a21 = h * finish[0]
    for k in range(size):
        stage[k] = now[k] + a21 * f1[k]
    if not stage_rates(finish[16], stage, f2, y, edges, mixed, work):
        return False, np.inf
    a31, a32 = h * finish[1], h * finish[2]
    for k in range(size):
        stage[k] = now[k] + a31 * f1[k] + a32 * f2[k]
    if not stage_rates(finish[17], stage, f3, y, edges, mixed, work):
        return False, np.inf
    a41, a42, a43 = h * finish[3], h * finish[4], h * finish[5]
    for k in range(size):
        stage[k] = now[k] + a41 * f1[k] + a42 * f2[k] + a43 * f3[k]
    if not stage_rates(finish[18], stage, f4, y, edges, mixed, work):
        return False, np.inf
    b1, b2, b3, b4 = h * finish[6], h * finish[7], h * finish[8], h * finish[9]
    for k in range(size):
        end[k] = now[k] + b1 * f1[k] + b2 * f2[k] + b3 * f3[k] + b4 * f4[k]
    if not stage_rates(1.0, end, f, y, edges, mixed, work):
        return False, np.inf
    e1, e2, e3, e4 = h * finish[10], h * finish[11], h * finish[12], h * finish[13]
    e5 = h * finish[14]
    for k in range(size):
        stage[k] = e1 * f1[k] + e2 * f2[k] + e3 * f3[k] + e4 * f4[k] + e5 * f[k]
    return True, relative_size(stage, end, y.size, relief, contrast)
