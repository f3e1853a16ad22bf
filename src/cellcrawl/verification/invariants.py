"""What no run may break: tension and area, the force balance, symmetries, rest."""

from __future__ import annotations

import math
from collections.abc import Iterator
from functools import partial
from typing import Any, Final

import numpy as np
import xarray as xr

from cellcrawl.bench.cases import LAWS, check_start
from cellcrawl.parameters import Parameters
from cellcrawl.simulation import simulate
from cellcrawl.simulation.dataset import decode_attribute
from cellcrawl.solvers import SOLVERS, Frame
from cellcrawl.starts import CellState, PerturbedCircle
from cellcrawl.verification.check import Result, at_most
from cellcrawl.verification.engines import frames, started
from cellcrawl.verification.transformations import Given, reflected, rotated

OPTIONS: Final[dict[str, dict[str, Any]]] = {
    "adaptive": {"rtol": 1e-7},
    "paper": {"nodes": 800, "dt": 2.5e-4},
    "spline": {},
}
_CELL: Final = Parameters(r_on=26, zeta_1=600)
_T_END: Final = 5.0
# by solver: tension against area (area), closure (length), force balance (force)
_LIMITS: Final = {
    "adaptive": (2e-6, 1e-7, 1e-9),
    "paper": (1e-9, 3e-3, 1e-9),
    "spline": (2e-6, 1e-9, 1e-9),
}


def area_drift(dataset: xr.Dataset, parameters: Parameters) -> float:
    """Return by how much ``sigma / G - A`` changes in a run, at most."""
    kept = dataset["tension"] / parameters.tension_rate - dataset["area"]
    return float(np.abs(kept - kept[0]).max())


def force_residual(dataset: xr.Dataset, parameters: Parameters) -> float:
    """Return by how much ``(r + zeta_1 n) log r`` misses ``sigma_c + sigma (1 + kappa h)``."""
    p, r, n = parameters, dataset["off_rate"], dataset["bound_fraction"]
    pull = p.sigma_c + dataset["tension"] * (1.0 + p.h * dataset["curvature"])
    return float(np.abs((r + p.zeta_1 * n) * np.log(r) - pull).max())


def outside_fraction(dataset: xr.Dataset) -> float:
    """Return how far the bound fraction leaves [0, 1], 0 if it does not."""
    n = dataset["bound_fraction"].values
    return max(0.0, -float(n.min()), float(n.max()) - 1.0)


def closure(dataset: xr.Dataset) -> float:
    """Return the largest gap between the ends of the edge, over its length."""
    return float(decode_attribute(dataset, "diagnostics").get("largest_closure_error", math.nan))


def restlessness(parameters: Parameters, solver: str, **options: Any) -> float:
    """Return how far the resting circle gets from rest by t = 0.5, relative in every field."""
    ds = simulate(parameters, 0.5, start=PerturbedCircle(), solver=solver, **options)
    p = parameters
    rest = {"bound_fraction": p.n_bar, "off_rate": p.r_p, "tension": p.sigma_bar, "curvature": 1.0}
    return max(float(np.abs(ds[name] / value - 1.0).max()) for name, value in rest.items())


def turned_miss(state: CellState, angle: float, frame: Any) -> float:
    """Return how far the run of a turned start is from the turned run.

    ``frame`` is a function from a state to the `Frame` it ends in.
    """
    plain, other = frame(state), frame(rotated(state, angle))
    place = (plain.x + 1j * plain.y) * np.exp(1j * angle)
    return float(np.abs(other.x + 1j * other.y - place).max())


def mirrored_miss(state: CellState, frame: Any) -> float:
    """Return how far the run of a mirrored start is from the mirrored run."""
    plain, other = frame(state), frame(reflected(state))
    back = np.roll(np.arange(plain.x.size)[::-1], 1)
    place = (plain.x - 1j * plain.y)[back]
    return float(np.abs(other.x + 1j * other.y - place).max())


def of_runs(solver: str, full: bool) -> Iterator[Result]:
    """Measure what one solver keeps, over a run from the check start."""
    drift, gap, force = _LIMITS[solver]
    for law in LAWS:
        p = _CELL.replace(elasticity=law)
        ds = simulate(p, _T_END, start=check_start(p), solver=solver, **OPTIONS[solver])
        told = f"{solver} solver, {law}, t = 0 to {_T_END:g}"
        yield at_most(f"change of sigma / G - A, {told}", area_drift(ds, p), drift)
        yield at_most(f"residual of the force balance, {told}", force_residual(ds, p), force)
        yield at_most(f"bound fraction outside [0, 1], {told}", outside_fraction(ds), 0.0)
        if solver != "spline":  # its markers are joined whatever they do
            yield at_most(f"gap in the edge over its length, {told}", closure(ds), gap)
        rest = restlessness(p, solver, **OPTIONS[solver])
        yield at_most(f"motion of the resting circle, {solver} solver, {law}", rest, 1e-6)


def of_symmetry(full: bool) -> Iterator[Result]:
    """Measure that turned and mirrored starts give turned and mirrored runs."""
    limits = {"adaptive": (1e-8, 1e-4), "paper": (1e-9, 1e-9), "spline": (1e-8, 1e-8)}
    options: dict[str, dict[str, Any]] = {
        "adaptive": {"rtol": 1e-5},
        "paper": {"nodes": 300, "dt": 5e-4},
        "spline": {"nodes": 128},
    }
    for solver, (turning, mirroring) in limits.items():
        scheme = SOLVERS[solver]
        nodes = scheme.checked_nodes(options[solver].get("nodes"))
        state = check_start(_CELL).state(_CELL, scheme.start_nodes(nodes))
        frame = partial(_frame, solver, options[solver])
        yield at_most(
            f"a turned start gives the turned run, {solver} solver, t = 2",
            turned_miss(state, 0.7, frame),
            turning,
        )
        yield at_most(
            f"a mirrored start gives the mirrored run, {solver} solver, t = 2",
            mirrored_miss(state, frame),
            mirroring,
        )


def _frame(solver: str, options: dict[str, Any], state: CellState) -> Frame:
    return frames(started(solver, _CELL, Given(state), **options), [2.0])[0]
