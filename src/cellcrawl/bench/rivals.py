"""General ODE solvers on the adaptive solver's own compiled right-hand side.

The grid is fixed; everything else is theirs: CVODE's BDF with GMRES (SUNDIALS, through
scikit-sundae) and SciPy's LSODA and BDF.
"""

from __future__ import annotations

import importlib.util
import math
from collections.abc import Callable
from typing import Any

import numpy as np

from cellcrawl._compile import kernel
from cellcrawl.bench.cases import Case
from cellcrawl.solvers.adaptive import state as layout
from cellcrawl.solvers.adaptive.frame import instant, shape_of
from cellcrawl.solvers.adaptive.rates import TENSION_RATE, WORK_ROWS, rates
from cellcrawl.solvers.adaptive.staggered import HALO

_SCALARS = 5  # length, tension, area, position of node 0


@kernel
def _compact_rates(
    u: np.ndarray,
    out: np.ndarray,
    state: np.ndarray,
    state_t: np.ndarray,
    y: np.ndarray,
    edge: np.ndarray,
    work: np.ndarray,
) -> None:
    """Rates of a state without halos; NaN where the force balance has no root."""
    nodes = y.size
    n_at, scalars_at = nodes + 3 * HALO, 2 * (nodes + 2 * HALO)
    state[HALO : HALO + nodes] = u[:nodes]
    state[n_at : n_at + nodes] = u[nodes : 2 * nodes]
    state[scalars_at : scalars_at + _SCALARS] = u[2 * nodes :]
    if rates(state, state_t, y, edge, work):
        out[:nodes] = state_t[HALO : HALO + nodes]
        out[nodes : 2 * nodes] = state_t[n_at : n_at + nodes]
        out[2 * nodes :] = state_t[scalars_at : scalars_at + _SCALARS]
    else:
        out[:] = np.nan


class FixedGrid:
    """A case as a plain system of ODEs on a fixed number of nodes."""

    def __init__(self, case: Case, nodes: int) -> None:
        conditions = case.conditions
        edge = conditions.edge(0.0, nodes)
        rate = np.full((1, nodes), conditions.tension_rate(0.0))
        self._edge = np.concatenate([edge, rate])
        assert self._edge.shape[0] == TENSION_RATE + 1
        self._state = layout.from_cell(case.start(1024), nodes)
        self._state_t = np.zeros_like(self._state)
        self._y = np.full(nodes, math.log(case.parameters.r_p))
        self._work = np.zeros((WORK_ROWS, nodes + 2 * HALO))
        self._conditions = conditions
        self._nodes = nodes
        self.calls = 0
        scalars = layout.scalars(self._state)[:_SCALARS]
        self.start = np.concatenate([layout.angle(self._state), layout.bound(self._state), scalars])

    def __call__(self, t: float, u: np.ndarray, out: np.ndarray) -> None:
        """Write the rates of ``u`` to ``out``."""
        self.calls += 1
        _compact_rates(u, out, self._state, self._state_t, self._y, self._edge, self._work)

    def function(self, t: float, u: np.ndarray) -> np.ndarray:
        """Return the rates of ``u``."""
        out = np.empty_like(u)
        self(t, u, out)
        return out

    def summary(self, t: float, u: np.ndarray) -> np.ndarray:
        """Return length and centroid of ``u``."""
        nodes = self._nodes
        state = np.zeros_like(self._state)
        layout.angle(state)[:] = u[:nodes]
        layout.bound(state)[:] = u[nodes : 2 * nodes]
        layout.scalars(state)[:_SCALARS] = u[2 * nodes :]
        made = instant(t, shape_of(state))
        return np.array([made.length, made.centroid_x, made.centroid_y])


Rival = Callable[[FixedGrid, float, float], np.ndarray]


def cvode(system: FixedGrid, t_end: float, rtol: float) -> np.ndarray:
    """Solve with CVODE, BDF and unpreconditioned GMRES."""
    from sksundae.cvode import CVODE

    solver = CVODE(
        system, method="BDF", linsolver="gmres", rtol=rtol, atol=rtol, max_num_steps=10_000_000
    )
    return np.asarray(solver.solve([0.0, t_end], system.start).y[-1])


def lsoda(system: FixedGrid, t_end: float, rtol: float) -> np.ndarray:
    """Solve with SciPy's LSODA."""
    return _scipy("LSODA", system, t_end, rtol)


def bdf(system: FixedGrid, t_end: float, rtol: float) -> np.ndarray:
    """Solve with SciPy's BDF."""
    return _scipy("BDF", system, t_end, rtol)


def available() -> dict[str, Rival]:
    """Return the rivals that are installed, by name."""
    found: dict[str, Rival] = {}
    if importlib.util.find_spec("sksundae") is not None:
        found["CVODE BDF+GMRES"] = cvode
    if importlib.util.find_spec("scipy") is not None:
        found.update({"SciPy LSODA": lsoda, "SciPy BDF": bdf})
    return found


def _scipy(method: Any, system: FixedGrid, t_end: float, rtol: float) -> np.ndarray:
    from scipy.integrate import solve_ivp

    solved = solve_ivp(
        system.function, (0.0, t_end), system.start, method=method, rtol=rtol, atol=rtol
    )
    return np.asarray(solved.y[:, -1])
