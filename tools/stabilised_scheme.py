"""Derive the fourth-order stabilised methods and write their table of coefficients.

    python tools/stabilised_scheme.py src/cellcrawl/solvers/adaptive/stabilised_coefficients.txt

The structure is that of ROCK4 (Abdulle, SIAM J. Sci. Comput. 23, 2002, 2041-2054): a stability
polynomial of degree s and order 4 is split into its s - 4 real roots, made by a three-term
recurrence, and four complex ones, made by four stages that also meet the nonlinear conditions of
order 4. Here the polynomial comes from a linear program (as Ketcheson & Ahmadia, 2012), the
recurrence from the Lanczos process on the real roots, and the stages from a least-norm Newton
iteration on the order conditions. Needs SciPy; takes about three minutes.
"""

from __future__ import annotations

import math
import sys
from pathlib import Path

import numpy as np
from numpy.polynomial import chebyshev
from scipy.optimize import least_squares, linprog

ORDER = 4
DAMPING = 0.95
DEGREES = (*range(5, 17), 18, 20, 22, 24, 27, 30, 34, 38, 43, 48, 54, 61, 69, 78, 88, 100)
HEADER = """\
# Coefficients of cellcrawl's fourth-order stabilised steps; made by tools/stabilised_scheme.py.
# 'degree s limit': s - 4 lines 'mu nu kappa c' of the recurrence follow, then one line with
# a21 a31 a32 a41 a42 a43 b1 b2 b3 b4, e1..e5 (error) and c of the last four stages.
"""


def flattest(degree: int, length: float) -> tuple[float, np.ndarray]:
    """Polynomial of order 4 that stays smallest on [-length, 0], in Chebyshev coefficients.

    Returned with its largest value over what damping allows.
    """
    x = np.cos(np.linspace(0.0, np.pi, 30 * degree))
    z = 0.5 * (x - 1.0) * length
    x, z = x[z < -1e-9], z[z < -1e-9]
    allowed = np.where(z > -4.0, np.maximum(DAMPING, np.minimum(1.0, np.exp(0.02 * z))), DAMPING)
    basis = chebyshev.chebvander(x, degree)
    at_zero = [
        [
            chebyshev.chebval(1.0, chebyshev.chebder(row, k)) * (2.0 / length) ** k
            for row in np.eye(degree + 1)
        ]
        for k in range(ORDER + 1)
    ]
    found = linprog(
        np.append(np.zeros(degree + 1), 1.0),
        A_ub=np.block([[basis, -allowed[:, None]], [-basis, -allowed[:, None]]]),
        b_ub=np.zeros(2 * z.size),
        A_eq=np.hstack([at_zero, np.zeros((ORDER + 1, 1))]),
        b_eq=np.ones(ORDER + 1),
        bounds=[(None, None)] * (degree + 1) + [(0.0, None)],
        method="highs",
    )
    return (found.x[-1], found.x[:-1]) if found.status == 0 else (np.inf, np.zeros(1))


def longest(degree: int) -> tuple[float, np.ndarray]:
    """Longest stable interval, by bisection, and its polynomial."""
    low, high, best = 0.2 * degree**2, 0.5 * degree**2, np.zeros(1)
    for _ in range(18):
        middle = 0.5 * (low + high)
        size, polynomial = flattest(degree, middle)
        if size <= 1.0 + 1e-7:
            low, best = middle, polynomial
        else:
            high = middle
    return low, best


def recurrence(degree: int, length: float, polynomial: np.ndarray) -> np.ndarray:
    """Rows ``(mu, nu, kappa)`` of the recurrence through the real roots."""
    roots = chebyshev.chebroots(polynomial)
    real = np.sort(roots[np.abs(roots.imag) <= 1e-7].real)
    if real.size != degree - 4:
        raise RuntimeError(f"degree {degree}: {real.size} real roots")
    far = np.ones(real.size)
    for root in roots[np.abs(roots.imag) > 1e-7]:
        far *= 2.0 * np.abs(real - root)
    alpha, beta = lanczos(real, np.maximum(far**2, 1e-30))
    rows, ratio = [], 1.0
    for j in range(real.size):
        back = beta[j - 1] / ratio if j else 0.0
        ratio = 1.0 - alpha[j] - back
        rows.append((2.0 / length / ratio, (1.0 - alpha[j]) / ratio, -back / ratio))
    return np.array(rows)


def lanczos(x: np.ndarray, weights: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Recurrence coefficients of the polynomials orthogonal on ``x``."""
    vectors = [np.sqrt(weights / weights.sum())]
    alpha, beta = [], []
    for j in range(x.size):
        v = x * vectors[j]
        alpha.append(v @ vectors[j])
        for _ in range(3):
            for u in vectors:
                v = v - u * (u @ v)
        if j < x.size - 1:
            beta.append(np.linalg.norm(v))
            vectors.append(v / beta[-1])
    return np.array(alpha), np.array(beta) ** 2


def tableau(rows: np.ndarray, last: np.ndarray) -> np.ndarray:
    """Butcher matrix of the whole method, with the weights as its last row."""
    m = len(rows)
    a = np.zeros((m + 5, m + 5))
    for j, (mu, nu, kappa) in enumerate(rows, start=1):
        a[j] = nu * a[j - 1] + (kappa * a[j - 2] if j > 1 else 0.0)
        a[j, j - 1] += mu
    used = 0
    for stage in range(1, 5):
        a[m + stage] = a[m]
        a[m + stage, m : m + stage] += last[used : used + stage]
        used += stage
    return a


def order_conditions(a: np.ndarray) -> np.ndarray:
    """Residuals of the eight conditions of order 4."""
    b, c = a[-1], a.sum(axis=1)
    return np.array(
        [
            b.sum() - 1.0,
            b @ c - 1.0 / 2.0,
            b @ c**2 - 1.0 / 3.0,
            b @ a @ c - 1.0 / 6.0,
            b @ c**3 - 1.0 / 4.0,
            b @ (c * (a @ c)) - 1.0 / 8.0,
            b @ a @ c**2 - 1.0 / 12.0,
            b @ a @ a @ c - 1.0 / 24.0,
        ]
    )


def last_stages(rows: np.ndarray, guess: np.ndarray | None) -> np.ndarray:
    """``a21, a31, a32, a41, a42, a43, b1..b4`` of small norm that complete order 4."""

    def residual(last: np.ndarray) -> np.ndarray:
        return order_conditions(tableau(rows, last))

    random = np.random.default_rng(0)
    starts = [guess] if guess is not None else list(random.normal(0.2, 0.4, (60, 10)))
    best = None
    for start in starts:
        last = least_squares(
            lambda v: np.concatenate([1e3 * residual(v), 1e-2 * v]), start, max_nfev=400
        ).x
        for _ in range(30):
            slopes = [
                (residual(last + 1e-6 * e) - residual(last - 1e-6 * e)) / 2e-6 for e in np.eye(10)
            ]
            change = np.linalg.lstsq(np.transpose(slopes), -residual(last), rcond=1e-10)[0]
            last = last + change
            if np.abs(change).max() < 1e-14:
                break
        exact = np.abs(residual(last)).max() < 1e-12
        if exact and (best is None or np.linalg.norm(last) < np.linalg.norm(best)):
            best = last
    if best is None:
        raise RuntimeError(f"degree {len(rows) + 4}: no stages found")
    return best


def error_weights(a: np.ndarray) -> np.ndarray:
    """Weights on the last five stages' rates that vanish to order 3 and not to order 4."""
    c, last = a.sum(axis=1), slice(-5, None)
    conditions = np.array([np.ones(5), c[last], c[last] ** 2, (a @ c)[last]])
    weights = np.linalg.svd(conditions)[2][-1]
    return np.asarray(weights * np.sign(weights[-1]))


def main(path: str) -> None:
    """Write the table."""
    text, guess = HEADER, None
    for degree in DEGREES:
        length, polynomial = longest(degree)
        rows = recurrence(degree, length, polynomial)
        guess = last_stages(rows, guess)
        a = tableau(rows, guess)
        c = a.sum(axis=1)
        finish = np.concatenate([guess, error_weights(a), c[degree - 4 : degree]])
        text += f"degree {degree} {math.floor(0.999e6 * length) / 1e6:.6f}\n"
        for row, at in zip(rows, c, strict=False):
            text += " ".join(repr(float(value)) for value in (*row, at)) + "\n"
        text += " ".join(repr(float(value)) for value in finish) + "\n"
        print(f"degree {degree}: stable to {length:.3f} = {length / degree**2:.4f} degree**2")
    Path(path).write_text(text)


if __name__ == "__main__":
    main(sys.argv[1])
