"""Steady cells and their branches: numbers of an independent code, theory, and time stepping."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any, Final

import numpy as np

from cellcrawl.branches import circle, from_circle, gliding, onset_slope, onsets, turning
from cellcrawl.linear import growth_rates
from cellcrawl.parameters import Parameters
from cellcrawl.simulation import simulate
from cellcrawl.verification.check import Result, at_most, near

_HIGH: Final = Parameters(r_on=56.0, zeta_1=560.0)
_SHARP: Final = Parameters(r_on=16.0, zeta_1=600.0)
_SPINNING: Final = Parameters(r_on=50.0, zeta_1=560.0)
_WAVES = 20
_TURNS = {"printed": 44.330986, "consistent": 43.9728}


def states(full: bool) -> Iterator[Result]:
    """Gliding and turning cells, against digits of an independent code and against runs."""
    sharp, smooth, spinning = gliding(_SHARP), gliding(_HIGH), turning(_SPINNING)
    yield near("speed of the gliding cell (16, 600)", sharp.speed, 0.1862907286, 1e-9)
    yield near("its circularity", sharp.circularity, 0.725175835, 1e-8)
    yield near("its tension", sharp.tension, 669.308061, 1e-5)
    yield near("the curvature of its corners", sharp.largest_curvature, 15.9034, 1e-4)
    yield near("its slowest growth rate", float(sharp.eigenvalues[0].real), -0.0071, 1e-4)
    yield near("speed of the gliding cell (56, 560)", smooth.speed, 0.05453426996, 1e-10)
    yield near("its tension", smooth.tension, 1240.327142, 1e-5)
    turn = abs(spinning.turning_rate)
    yield near("turning rate of the turning cell (50, 560)", turn, 0.509857369, 1e-8)
    yield near("radius of its path", spinning.path_radius, 0.26857541, 1e-7)
    neutral = np.abs(sharp.neutral_eigenvalues).max()
    yield at_most("neutral eigenvalues at (16, 600)", float(neutral), 1e-8)
    for elasticity in ("printed", "consistent"):
        yield at_most(
            f"circle's growth rates, k = 0 to {_WAVES}, less those of the quadratics, "
            f"{elasticity} law",
            _spectrum_error(Parameters(elasticity=elasticity)),
            1e-10,
        )
    run = simulate(_SHARP, 4.0, start=sharp, rtol=1e-7, save_every=1.0)
    apart = run["centroid_x"].values, run["centroid_y"].values
    moved = math.hypot(apart[0][-1] - apart[0][0], apart[1][-1] - apart[1][0]) / 4.0
    yield at_most("speed of a run from (16, 600), less the state's", abs(moved - sharp.speed), 1e-7)


def crossings(full: bool) -> Iterator[Result]:
    """Where gliding begins, turns and wobbles, against digits of an independent code."""
    low, high = onsets(_HIGH, "r_on", 1.0, 200.0)
    yield near("r_on where the circle begins to glide at zeta_1 = 560", low, 13.296270189, 1e-8)
    yield near("r_on where it ceases to", high, 57.379211156, 1e-8)
    for at, slope in ((13.0, -153.488), (57.0, -441.859)):
        beta = onset_slope(_HIGH, near=at)[1]
        yield near(f"slope of r_on in the square of speed near {at:g}", beta, slope, 1e-2)
    branch = from_circle(_HIGH).continue_in("r_on", 16.9 if full else 54.0)
    fork = branch.points("pitchfork")[0]
    yield near("r_on where gliding begins to turn", fork.value, 54.817202, 1e-6)
    if full:
        wobble: Any = branch.special_points[-1]
        yield near("r_on where gliding begins to wobble", wobble.value, 17.576447, 1e-6)
        yield near("frequency there", wobble.frequency, 0.832108, 1e-6)
    for elasticity, wanted in _TURNS.items():
        cell = _HIGH.replace(elasticity=elasticity)
        gliding_branch = from_circle(cell).continue_in("r_on", 54.0)
        other = gliding_branch.points("pitchfork")[0].branch_off().continue_in("r_on", 43.9)
        ends = other.points("Hopf")
        found = ends[0].value if ends else math.nan
        within = 1e-6 if elasticity == "printed" else 1e-4
        yield near(f"r_on where steady turning ends, {elasticity} law", found, wanted, within)


def _spectrum_error(parameters: Parameters) -> float:
    found = np.concatenate(list(circle(parameters).eigenvalues_by_symmetry.values()))
    worst = 0.0
    for k in range(_WAVES + 1):
        rates = growth_rates(parameters, k)
        if k == 1:
            rates = rates[np.argmax(np.abs(rates))][None]
        for rate in rates:
            worst = max(worst, float(np.abs(found - rate).min() / max(1.0, abs(rate))))
    return worst
