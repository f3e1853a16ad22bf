"""General ODE solvers on the model as a plain system, `bench.uniform_grid`.

The grid is fixed; everything else is theirs: CVODE's BDF with GMRES (SUNDIALS, through
scikit-sundae) and SciPy's LSODA and BDF.
"""

from __future__ import annotations

import importlib.util
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from cellcrawl.bench.uniform_grid import UniformGrid

Rival = Callable[[UniformGrid, Sequence[float], float], np.ndarray]
"""Gives the states at some times after 0, shape (times, unknowns), to a relative tolerance."""


def cvode(system: UniformGrid, times: Sequence[float], rtol: float) -> np.ndarray:
    """Solve with CVODE, BDF and unpreconditioned GMRES."""
    from sksundae.cvode import CVODE

    solver = CVODE(
        system, method="BDF", linsolver="gmres", rtol=rtol, atol=rtol, max_num_steps=10_000_000
    )
    # given two times it returns every step between, given more the values at these
    asked = [0.0, 0.5 * times[0], *times]
    return np.asarray(solver.solve(asked, system.start).y[2:])


def lsoda(system: UniformGrid, times: Sequence[float], rtol: float) -> np.ndarray:
    """Solve with SciPy's LSODA."""
    return _scipy("LSODA", system, times, rtol)


def bdf(system: UniformGrid, times: Sequence[float], rtol: float) -> np.ndarray:
    """Solve with SciPy's BDF."""
    return _scipy("BDF", system, times, rtol)


def available() -> dict[str, Rival]:
    """Return the rivals that are installed, by name."""
    found: dict[str, Rival] = {}
    if importlib.util.find_spec("sksundae") is not None:
        found["CVODE BDF+GMRES"] = cvode
    if importlib.util.find_spec("scipy") is not None:
        found.update({"SciPy LSODA": lsoda, "SciPy BDF": bdf})
    return found


def solved(solve: Rival, system: UniformGrid, times: Sequence[float], rtol: float) -> np.ndarray:
    """Return length, tension, area and centroid at the times, shape (times, 5).

    NaN from where it gives up on, or goes where there is no off-rate.
    """
    found = np.full((len(times), 5), np.nan)
    try:
        states = solve(system, times, rtol)
    except (ValueError, RuntimeError, ArithmeticError):
        return found
    for row, state in zip(found, states, strict=False):
        row[:] = system.whole(state)
    return found


def _scipy(method: Any, system: UniformGrid, times: Sequence[float], rtol: float) -> np.ndarray:
    from scipy.integrate import solve_ivp

    ended = solve_ivp(
        system.function,
        (0.0, times[-1]),
        system.start,
        method=method,
        rtol=rtol,
        atol=rtol,
        t_eval=np.array(times),
    )
    return np.asarray(ended.y.T)
