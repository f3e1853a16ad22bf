"""Second-order Runge-Kutta-Chebyshev steps (Sommeijer, Shampine & Verwer 1998)."""

from __future__ import annotations

from typing import Final

import numpy as np

from cellcrawl._compile import kernel
from cellcrawl.solvers.adaptive_rates import rates
from cellcrawl.solvers.step_error import relative_size

_DAMPING: Final = 2.0 / 13.0
DEGREES: Final = np.array([*range(2, 31), 35, 40, 50, 60, 80, 100, 130, 160, 200])
ERROR_ORDER: Final = 3  # the error estimate goes as this power of the step


def coefficients() -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return stability limits, first rows, and rows ``(a0, a1, a2, b0, b1, c)`` of every degree."""
    first, rows = [], []
    for s in (int(degree) for degree in DEGREES):
        first.append(len(rows))
        w0 = 1.0 + _DAMPING / s**2
        t, d, e = np.zeros((3, s + 1))  # Chebyshev polynomials and derivatives at w0
        t[0], t[1], d[1] = 1.0, w0, 1.0
        for j in range(2, s + 1):
            t[j] = 2.0 * w0 * t[j - 1] - t[j - 2]
            d[j] = 2.0 * t[j - 1] + 2.0 * w0 * d[j - 1] - d[j - 2]
            e[j] = 4.0 * d[j - 1] + 2.0 * w0 * e[j - 1] - e[j - 2]
        w1 = d[s] / e[s]
        b = np.zeros(s + 1)
        b[2:] = e[2:] / d[2:] ** 2
        b[0] = b[1] = b[2]
        c = np.zeros(s + 1)
        c[2:] = w1 * e[2:] / d[2:]
        c[1] = c[2] / (4.0 * w0)
        rows.append((1.0, 0.0, 0.0, b[1] * w1, 0.0, 0.0))
        for j in range(2, s + 1):
            mu, nu = 2.0 * b[j] * w0 / b[j - 1], -b[j] / b[j - 2]
            slope = 2.0 * b[j] * w1 / b[j - 1]
            start = -(1.0 - b[j - 1] * t[j - 1]) * slope
            rows.append((1.0 - mu - nu, mu, nu, start, slope, c[j - 1]))
    limits = (DEGREES**2 - 1.0) * (2.0 / 3.0) * (1.0 - 2.0 * _DAMPING / 15.0)
    return limits, np.array(first), np.array(rows)


@kernel
def step(
    h: float,
    degree: int,
    rows: np.ndarray,
    states: np.ndarray,
    y: np.ndarray,
    edges: np.ndarray,
    tension_rates: np.ndarray,
    work: np.ndarray,
) -> tuple[bool, float]:
    """Try a step from state 2 with rates 3; the end goes to 4 with rates 5. Returns the error."""
    y0, f0, f = states[2], states[3], states[5]
    now, before = states[4], states[6]
    size = y0.size
    for k in range(size):
        before[k] = y0[k]
        now[k] = y0[k] + h * rows[0, 3] * f0[k]
    for j in range(1, degree):
        if not rates(now, f, y, edges[0], tension_rates[0], work):
            return False, np.inf
        a0, a1, a2 = rows[j, 0], rows[j, 1], rows[j, 2]
        b0, b1 = h * rows[j, 3], h * rows[j, 4]
        for k in range(size):
            before[k] = a0 * y0[k] + a1 * now[k] + a2 * before[k] + b0 * f0[k] + b1 * f[k]
        now, before = before, now
    if degree % 2 == 0:
        for k in range(size):
            before[k] = now[k]
        now = before
    if not rates(now, f, y, edges[0], tension_rates[0], work):
        return False, np.inf
    error = states[6]
    for k in range(size):
        error[k] = 0.8 * (y0[k] - now[k]) + 0.4 * h * (f0[k] + f[k])
    return True, relative_size(error, now, y.size)
