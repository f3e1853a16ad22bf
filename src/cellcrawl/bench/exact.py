"""What is known exactly of long runs: the tension law, travelling states, periods.

States and periods come from an independent continuation code, not from time stepping. They hold
for the family of the unperturbed circle, sigma_bar at the area pi, to which a random start of 1e-4
belongs but for its square; the deterministic check start encloses another area and does not.
"""

from __future__ import annotations

import math
from typing import Any, Final, NamedTuple

import numpy as np
import xarray as xr

from cellcrawl.bench.cases import check_start
from cellcrawl.numerics import fourier
from cellcrawl.parameters import Parameters
from cellcrawl.simulation import simulate
from cellcrawl.starts import RandomPerturbation


class Glide(NamedTuple):
    """A steadily gliding cell; NaN where the value is not known."""

    speed: float
    length: float
    tension: float
    circularity: float


GLIDES: Final = {
    (16, 600, "printed"): Glide(0.1862907286, 7.391549802, 669.308061, 0.725175835),
    (16, 600, "consistent"): Glide(0.1862907091, 7.37740521, math.nan, math.nan),
    (56, 560, "printed"): Glide(0.05453426996, math.nan, 1240.327142, 0.9998130747),
}
PERIODS: Final = {(26, 600): 8.78882, (24, 540): 12.9350}
"""Of the tension; zigzag and rotation, printed law."""
_STEADY: Final = 10.0  # time over which a speed is taken at the end
_SETTLED: Final = 150.0  # a period is taken from here on


def off_law(run: xr.Dataset, parameters: Parameters) -> float:
    """Return by how much the area of the shape misses the tension law, at most, in R_0 squared.

    The area is made anew from the points ``x``, ``y`` of every record, by Fourier series; the law
    is ``sigma - sigma(0) = G (A - A(0))``.
    """
    area = fourier.area(run["x"].values, run["y"].values)
    tension = run["tension"].values
    off = area - area[0] - (tension - tension[0]) / parameters.tension_rate
    return float(np.abs(off).max())


def gap(run: xr.Dataset) -> float:
    """Return the largest gap between the ends of the edge over its length, from its tangents."""
    return float(np.abs(np.exp(1j * run["theta"].values).mean(axis=1)).max())


def lawful_run(
    solver: str, cell: tuple[float, float, str], t_end: float, records: int = 100, **options: Any
) -> tuple[xr.Dataset, Parameters]:
    """Return a run from the check start, and its parameters."""
    p = Parameters(r_on=cell[0], zeta_1=cell[1], elasticity=cell[2])
    run = simulate(
        p, t_end, start=check_start(p), save_every=t_end / records, solver=solver, **options
    )
    return run, p


def glide(cell: tuple[float, float, str], t_end: float, **options: Any) -> Glide:
    """Return what a cell glides with at the end of a run from a random start."""
    p = Parameters(r_on=cell[0], zeta_1=cell[1], elasticity=cell[2])
    run = completed(
        simulate(
            p, t_end, start=RandomPerturbation(seed=1), save_every=_STEADY, nodes=64, **options
        )
    )
    last, before = run.isel(time=-1), run.sel(time=t_end - _STEADY, method="nearest")
    way = [float(last[name] - before[name]) for name in ("centroid_x", "centroid_y")]
    length = float(last["length"])
    return Glide(
        math.hypot(*way) / float(last["time"] - before["time"]),
        length,
        float(last["tension"]),
        4.0 * math.pi * float(last["area"]) / length**2,
    )


def tension_period(cell: tuple[float, float], t_end: float = 600.0, **options: Any) -> float:
    """Return the mean period of the tension of a cell once it is settled."""
    p = Parameters(r_on=cell[0], zeta_1=cell[1])
    run = completed(
        simulate(p, t_end, start=RandomPerturbation(seed=1), save_every=0.1, nodes=64, **options)
    )
    late = run.sel(time=slice(min(_SETTLED, 0.25 * t_end), None))
    return mean_period(late["time"].values, late["tension"].values)


def mean_period(time: np.ndarray, values: np.ndarray) -> float:
    """Return the mean time between upward crossings of the mean; NaN with fewer than two.

    Crossings lie on the cubic through the four samples around them, time as function of value.
    """
    above = values > values.mean()
    ups = np.flatnonzero(~above[1:-2] & above[2:-1]) + 1
    if ups.size < 2:
        return math.nan
    first, last = (_crossing(time, values, int(up)) for up in (ups[0], ups[-1]))
    return (last - first) / (ups.size - 1)


def _crossing(time: np.ndarray, values: np.ndarray, up: int) -> float:
    near = slice(up - 1, up + 3)
    t, v = time[near] - time[up], values[near] - values.mean()
    total = 0.0
    for i in range(4):
        others = [j for j in range(4) if j != i]
        total += t[i] * math.prod(float(-v[j] / (v[i] - v[j])) for j in others)
    return float(time[up] + total)


def completed(run: xr.Dataset) -> xr.Dataset:
    """Return a run that reached its end, or raise."""
    if run.attrs["status"] != "completed":
        raise RuntimeError(run.attrs["status_message"])
    return run
