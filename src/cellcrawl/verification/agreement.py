"""Three solvers that share nothing but the pointwise laws, and what they agree on."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any, Final

import numpy as np
import xarray as xr

from cellcrawl.bench.cases import LAWS, POINTS, check_start
from cellcrawl.parameters import Parameters
from cellcrawl.simulation import simulate
from cellcrawl.verification.check import Result, at_most

CELL: Final = Parameters(r_on=26, zeta_1=600)
CONVERGED: Final = np.array([6.609484, 912.998, 3.165835, 0.458285, 0.030681])
"""The check start at t = 2 in `CELL`, from independent programs: see `summary`."""

_NAMES: Final = ("length", "tension", "area", "centroid_x", "centroid_y")


def last(parameters: Parameters, t_end: float, solver: str, **options: Any) -> xr.Dataset:
    """Return the last record of a run from the check start, or raise if it broke down."""
    start = options.pop("start", check_start(parameters))
    run = simulate(parameters, t_end, start=start, solver=solver, save_every=t_end, **options)
    if run.attrs["status"] != "completed":
        raise RuntimeError(run.attrs["status_message"])
    return run.isel(time=-1)


def summary(record: xr.Dataset) -> np.ndarray:
    """Return length, tension, area and the two coordinates of the centroid."""
    return np.array([record[name].item() for name in _NAMES])


def disagreement(found: np.ndarray, true: np.ndarray) -> float:
    """Return the largest of the relative errors of length, tension, area and of the distance."""
    relative = np.abs(found / true - 1.0)[:3].max()
    return float(max(relative, math.hypot(*(found - true)[3:])))


def with_reference(full: bool) -> Iterator[Result]:
    """Measure every solver on the deterministic check at t = 2."""
    cases: list[tuple[str, dict[str, Any], float]] = [
        ("adaptive", {"rtol": 1e-8}, 1.5e-6),
        ("adaptive", {}, 1e-4),
        ("spline", {"nodes": 512}, 5e-6),
        ("paper", {"nodes": 2000, "dt": 1e-3}, 3e-3),
    ]
    if full:
        cases.append(("paper", {"nodes": 4000, "dt": 1e-4}, 3e-4))
    for solver, options, limit in cases:
        found = summary(last(CELL, 2.0, solver, **options))
        said = ", ".join(f"{name} {value:g}" for name, value in options.items()) or "as it comes"
        yield at_most(
            f"check start at t = 2 against the converged values, {solver} solver, {said}",
            disagreement(found, CONVERGED),
            limit,
            values=dict(zip(_NAMES, found, strict=True)),
        )


def between_solvers(full: bool) -> Iterator[Result]:
    """Measure the solvers against each other at t = 5, five cells, both laws."""
    for point in POINTS:
        for law in LAWS:
            p = Parameters(r_on=point[0], zeta_1=point[1], elasticity=law)
            true = summary(last(p, 5.0, "adaptive", rtol=1e-6))
            yield at_most(
                f"spline against adaptive solver at t = 5, {point}, {law}",
                disagreement(summary(last(p, 5.0, "spline")), true),
                1e-4,
            )
            if full or (point in POINTS[:2] and law == "printed"):
                paper = summary(last(p, 5.0, "paper", nodes=1000, dt=2.5e-4))
                yield at_most(
                    f"paper's scheme (1000 nodes, step 2.5e-4) against adaptive solver at t = 5, "
                    f"{point}, {law}",
                    disagreement(paper, true),
                    5e-3,
                )
