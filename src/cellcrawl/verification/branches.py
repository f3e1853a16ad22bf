"""Steady cells, orbits and branches: numbers of another code, theory, and time stepping."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any, Final

import numpy as np

from cellcrawl.branches import (
    circle,
    from_circle,
    gliding,
    lyapunov_exponent,
    onset_slope,
    onsets,
    orbit,
    threshold_kick,
    turning,
)
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


def orbits(full: bool) -> Iterator[Result]:
    """Zigzag and rotation as periodic orbits, against digits of an independent code."""
    zigzag = orbit(_ended(26.0, 600.0))
    yield near("period of the zigzag (26, 600)", zigzag.period, 8.78882, 5e-5)
    yield near("its multiplier", float(zigzag.multipliers[0].real), -0.867, 5e-4)
    yield near("multiplier of a shift in time", float(zigzag.neutral_multipliers[0]), 1.0, 1e-4)
    rotation = orbit(_ended(24.0, 540.0))
    yield near("period of the rotation (24, 540)", rotation.period, 12.9350, 5e-5)
    yield near("turn in a period", abs(rotation.turn), 1.2225, 5e-5)
    yield near("its multiplier", float(rotation.multipliers[0].real), -0.506, 5e-4)
    yield near("its least tension", rotation.tension_range[0], 776.43, 5e-3)
    if full:
        branch = zigzag.continue_in("r_on", 27.6)
        (fork,) = branch.points("pitchfork")
        yield near("r_on where the zigzag (zeta_1 = 600) becomes lopsided", fork.value, 27.27, 0.02)
        slower = orbit(_ended(24.0, 600.0))
        yield near("period of the zigzag (24, 600)", slower.period, 11.32, 5e-3)


def growth_of_nearby_cells(full: bool) -> Iterator[Result]:
    """Lyapunov exponents against growth rates, multipliers, and an independent code."""
    for r_on in (56.0, 54.0):
        state = gliding(_HIGH.replace(r_on=r_on))
        found = lyapunov_exponent(state.parameters, start=state, t_end=60.0)
        wanted = float(state.eigenvalues[0].real)
        yield near(f"exponent of the glider ({r_on:g}, 560)", found.value, wanted, 5e-3)
    found = lyapunov_exponent(Parameters(r_on=24.0, zeta_1=540.0), t_end=150.0)
    wanted = math.log(0.506) / 12.9350
    yield near("exponent of the rotation (24, 540)", found.value, wanted, 3e-3)
    wild = lyapunov_exponent(Parameters(r_on=40.0, zeta_1=520.0), t_end=600.0)
    yield at_most("0 less the exponent of (40, 520), its error added", wild.error - wild.value, 0.0)
    if full:
        found = lyapunov_exponent(Parameters(r_on=44.0, zeta_1=560.0), t_end=2500.0, runs=4)
        yield near("exponent of the irregular spin (44, 560), four runs", found.value, 0.03, 0.02)
        yield at_most("0 less that exponent, its error added", found.error - found.value, 0.0)


def basins_side_by_side(full: bool) -> Iterator[Result]:
    """The kick between the round cell and the glider below the onset."""
    found = threshold_kick(Parameters(r_on=11.5, zeta_1=600.0), within=0.02)
    yield near("kick that makes (11.5, 600) glide for good", found.value, 0.0035, 0.0015)


def _ended(r_on: float, zeta_1: float) -> Any:
    return simulate(Parameters(r_on=r_on, zeta_1=zeta_1), 120.0, save_every=1.0)


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
