"""Growth rates measured in the nonlinear solvers, against the linear theory.

For a wavenumber the amplitudes of radius and bound fraction make a vector of two that obeys two
linear equations. Two short runs, each started on one eigenmode, give the matrix that takes this
vector from one time to another; its eigenvalues grow as ``exp(lam t)``. Both roots come from it,
however fast one outgrows the other, and nothing of the theory but the start goes in.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any, Final, NamedTuple

import numpy as np

from cellcrawl.bench.cases import LAWS
from cellcrawl.linear import growth_rates
from cellcrawl.linear.eigenmodes import linear_mode
from cellcrawl.parameters import Parameters
from cellcrawl.starts import Eigenmode
from cellcrawl.verification.check import Result, at_most, complex_text, near
from cellcrawl.verification.engines import frames, started
from cellcrawl.verification.modal import modal_amplitudes

WAVENUMBERS: Final = tuple(range(21))
POINTS: Final = ((25, 600), (16, 600), (24, 540), (36, 560), (56, 560), (25, 200))
MORE_POINTS: Final = ((26, 600), (26, 400), (10, 500), (200, 600), (40, 1500))
SLOWEST: Final = 0.1  # a slower root moves too little within the time the faster one allows
FASTEST: Final = 200.0
AMPLITUDE: Final = 1e-4
RTOL: Final = 1e-8
VISIBLE: Final = 1e-4  # a smaller change with the step shows no order
_TIMES: Final = 4  # in a fit
_LARGEST_GROWTH: Final = 2.0  # in powers of e, of the faster root


class Root(NamedTuple):
    """A growth rate, as the theory has it and as a solver shows it."""

    k: int
    branch: str
    theory: complex
    measured: complex

    @property
    def error(self) -> float:
        """Relative error, of growth and frequency together."""
        return abs(self.measured - self.theory) / abs(self.theory)


def measured_roots(
    parameters: Parameters,
    k: int,
    solver: str = "adaptive",
    *,
    step: float | None = None,
    **options: Any,
) -> list[Root]:
    """Return the roots of ``k`` whose size is between 0.1 and 200, measured in a solver.

    The times looked at are whole multiples of ``step``, if given. ``options`` are the solver's.
    """
    theory = growth_rates(parameters, k)
    roots = []
    for index, branch in enumerate("+-"):
        rate = complex(theory[index])
        if SLOWEST < abs(rate) < FASTEST:
            times = _times(theory, rate, step)
            found = _fitted(parameters, k, rate, solver, times, options)
            roots.append(Root(k, branch, rate, found))
    return roots


def _times(theory: np.ndarray, rate: complex, step: float | None) -> np.ndarray:
    """Return the times of a fit: long enough for this root, not too long for the other."""
    apart = min(1.0 / abs(rate), _LARGEST_GROWTH / max(float(theory[0].real), 1e-9)) / _TIMES
    if step is not None:
        apart = step * max(1, round(apart / step))
    return apart * np.arange(1, _TIMES + 1)


def _fitted(
    parameters: Parameters,
    k: int,
    rate: complex,
    solver: str,
    times: np.ndarray,
    options: dict[str, Any],
) -> complex:
    """Return the ``lam`` whose ``lam t`` fits the logarithms of the eigenvalue near ``rate``."""
    starts = _starts(parameters, k)
    runs = [_amplitudes(parameters, k, start, solver, times, options) for start in starts]
    series = np.stack(runs, axis=-1)
    carried = series[1:] @ np.linalg.inv(series[0])
    rates = np.log(np.linalg.eigvals(carried).astype(complex)) / times[:, None]
    nearest = np.abs(rates - rate).argmin(axis=1)
    found = rates[np.arange(times.size), nearest]
    return complex(times**2 @ found / (times @ times))


def _starts(parameters: Parameters, k: int) -> list[Eigenmode]:
    """Return two eigenmodes that differ in what they hold of radius and bound fraction.

    A breathing pair has one real motion; its other start is a quarter of a turn on.
    """
    if k == 0 and growth_rates(parameters, 0)[0].imag > 0.0:
        return [_sized(parameters, k, "+", carrier) for carrier in ("radius", "bound_fraction")]
    return [_sized(parameters, k, branch) for branch in "+-"]


def _sized(parameters: Parameters, k: int, branch: str, carrier: str | None = None) -> Eigenmode:
    """Return the eigenmode whose largest field has the amplitude `AMPLITUDE`."""
    rate = complex(growth_rates(parameters, k)["+-".index(branch)])
    mode = linear_mode(parameters, k, rate)
    sizes = {"radius": abs(mode.radius), "bound_fraction": abs(mode.bound_fraction)}
    slope = max(k, 1) * sizes["radius"]
    largest = max(slope, sizes["bound_fraction"], abs(mode.off_rate) / parameters.r_p)
    if carrier is None:
        carrier = "radius" if slope >= sizes["bound_fraction"] else "bound_fraction"
    return Eigenmode(k, AMPLITUDE * sizes[carrier] / largest, branch, carrier)


def _amplitudes(
    parameters: Parameters,
    k: int,
    start: Eigenmode,
    solver: str,
    times: np.ndarray,
    options: dict[str, Any],
) -> np.ndarray:
    """Return amplitudes of the mode at 0 and at ``times``, shape (1 + times, 2).

    For the breathing mode their odd part in the amplitude: the even part is of second order.
    """
    signs = (1.0, -1.0) if k == 0 else (1.0,)
    runs = []
    for sign in signs:
        one = Eigenmode(k, sign * start.amplitude, start.branch, start.carrier)
        runs.append(sign * _run(parameters, k, one, solver, times, options))
    return np.asarray(sum(runs) / len(runs))


def _run(
    parameters: Parameters,
    k: int,
    start: Eigenmode,
    solver: str,
    times: np.ndarray,
    options: dict[str, Any],
) -> np.ndarray:
    made = frames(started(solver, parameters, start, **options), (0.0, *times))
    return np.array([modal_amplitudes(frame, k, parameters.n_bar) for frame in made])


class Convergence(NamedTuple):
    """A root measured in the paper's scheme at three steps and two grids."""

    k: int
    branch: str
    order: float
    """Observed order in the step."""
    change: float
    """Relative change of the root from the longest to the middle step."""
    limit_error: float
    """Relative error of the root extrapolated in step and nodes."""


def paper_convergence(
    parameters: Parameters, k: int, dt: float, nodes: int = 256
) -> list[Convergence]:
    """Return how the roots of ``k`` in the paper's scheme converge in step and nodes."""
    grids = [
        [
            measured_roots(parameters, k, "paper", step=dt, nodes=count, dt=dt / part)
            for part in (1, 2, 4)
        ]
        for count in (nodes, 2 * nodes)
    ]
    found = []
    for index, root in enumerate(grids[0][0]):
        coarse, fine = (np.array([step[index].measured for step in grid]) for grid in grids)
        in_time = [(v[0] - 6.0 * v[1] + 8.0 * v[2]) / 3.0 for v in (coarse, fine)]
        limit = (4.0 * in_time[1] - in_time[0]) / 3.0
        ratio = abs((fine[0] - fine[1]) / (fine[1] - fine[2]))
        found.append(
            Convergence(
                k,
                root.branch,
                math.log2(ratio),
                abs(fine[0] - fine[1]) / abs(root.theory),
                abs(limit - root.theory) / abs(root.theory),
            )
        )
    return found


def growth_in_adaptive(full: bool) -> Iterator[Result]:
    """Measure the worst root of every cell in the adaptive solver."""
    for point in (*POINTS, *MORE_POINTS) if full else POINTS:
        for law in LAWS:
            p = Parameters(r_on=point[0], zeta_1=point[1], elasticity=law)
            roots = [root for k in WAVENUMBERS for root in measured_roots(p, k, rtol=RTOL)]
            worst = max(roots, key=lambda root: root.error)
            pairs = sum(root.theory.imag != 0.0 for root in roots)
            yield at_most(
                f"error of the growth rates of k = 0 to {WAVENUMBERS[-1]} in the adaptive solver, "
                f"{point}, {law}",
                worst.error,
                1e-4,
                note=f"{len(roots)} roots, {pairs} of them complex; worst k = {worst.k}, "
                f"{complex_text(worst.theory)}",
                values={"roots": len(roots), "complex_roots": pairs, "worst_k": worst.k},
            )


def growth_in_paper(full: bool) -> Iterator[Result]:
    """Measure the order in the step, and the limit, of the roots in the paper's scheme."""
    some = (0, 1, 2, 5, 8, 12, 20)
    for point in POINTS[:2] if full else POINTS[:1]:
        wavenumbers = WAVENUMBERS if full and point == POINTS[0] else some
        for law, dt in zip(LAWS, (2e-4, 1e-4), strict=True):
            p = Parameters(r_on=point[0], zeta_1=point[1], elasticity=law)
            roots = [root for k in wavenumbers for root in paper_convergence(p, k, dt)]
            in_step = [root for root in roots if root.change > VISIBLE]
            orders = [root.order for root in in_step]
            off = max(orders, key=lambda order: abs(order - 1.0))
            yield near(
                f"order in the step of the growth rates in the paper's scheme, {point}, {law}",
                off,
                1.0,
                0.06,
                note=f"the one farthest from 1 of {len(in_step)} roots",
                values={"lowest": min(orders), "highest": max(orders)},
            )
            worst = max(roots, key=lambda root: root.limit_error)
            yield at_most(
                "error of the growth rates in the paper's scheme extrapolated in step and nodes, "
                f"{point}, {law}",
                worst.limit_error,
                1e-3,
                note=f"{len(roots)} roots; worst k = {worst.k}",
            )
