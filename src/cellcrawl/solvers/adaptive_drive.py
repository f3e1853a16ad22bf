"""Many error-controlled steps in one compiled call.

Where steps fall depends on the state, the step count and the next break only, never on the target:
a run may be stopped and resumed anywhere to the same bits.
"""

from __future__ import annotations

from typing import Final

import numpy as np

from cellcrawl._compile import kernel
from cellcrawl.solvers import rkc
from cellcrawl.solvers.adaptive_rates import spectral_radius

# rows of `states`; the last step went from PREVIOUS to CURRENT
PREVIOUS, PREVIOUS_RATES, CURRENT, CURRENT_RATES, TRIAL, TRIAL_RATES = range(6)
STATE_ROWS: Final = 10
# entries of `control`
TIME, PREVIOUS_TIME, STEP, LAST_ERROR, RADIUS, LOCAL_ERRORS, SMALLEST_FAILED = range(7)
CONTROLS: Final = 8
# entries of `counters`
STEPS, REJECTED, RATES, FAILED_IN_A_ROW, CHECKED, WANTED = range(6)
COUNTERS: Final = 8
# what `run` returns
REACHED, PAUSED, AT_BREAK, RETRY, CHECK_NODES, NO_ROOT, STEP_TOO_SMALL = range(7)

LONGEST_STEP: Final = 0.1  # an instability grows at rates up to 13; longer steps would hide it
SHORTEST_STEP: Final = 1e-9
_SAFETY = 0.8
_RADIUS_MARGIN = 1.05
_SHRINK_ON_FAILURE = 0.25


@kernel
def bounded_step(h: float, time: float, end: float, radius: float, limits: np.ndarray) -> float:
    """Return the step to try from ``time``: stable, not too long, and landing on ``end`` evenly."""
    h = min(h, LONGEST_STEP, limits[-1] / (_RADIUS_MARGIN * radius))
    left = end - time
    if h >= left * 0.999:
        return left
    if 2.0 * h > left:
        return 0.5 * left
    return h


@kernel
def run(
    target: float,
    end: float,
    tolerance: float,
    most_steps: int,
    check_every: int,
    control: np.ndarray,
    counters: np.ndarray,
    states: np.ndarray,
    y: np.ndarray,
    edges: np.ndarray,
    tension_rates: np.ndarray,
    limits: np.ndarray,
    degrees: np.ndarray,
    first: np.ndarray,
    rows: np.ndarray,
    work: np.ndarray,
) -> int:
    """Step until ``target`` is reached or something is for the caller to do.

    ``edges`` has shape (times, 7, nodes) and ``tension_rates`` (times,): one time when the
    parameters hold still, else their values at 0, 1/3, 2/3 and 1 of the next step, and then only
    one step is tried (`RETRY`).
    """
    ramping = tension_rates.size > 1
    tried = 0
    while control[TIME] < target:
        if tried == most_steps:
            return PAUSED
        if counters[STEPS] >= counters[CHECKED] + check_every:
            return CHECK_NODES
        tried += 1
        h = bounded_step(control[STEP], control[TIME], end, control[RADIUS], limits)
        lands = h == end - control[TIME]
        k = 0
        while k < limits.size - 1 and limits[k] < _RADIUS_MARGIN * h * control[RADIUS]:
            k += 1
        degree = degrees[k]
        counters[RATES] += degree
        solved, error = rkc.step(h, degree, rows[first[k] :], states, y, edges, tension_rates, work)
        error /= tolerance
        if not solved or not error <= 1.0:
            counters[REJECTED] += 1
            counters[FAILED_IN_A_ROW] += 1
            if h <= SHORTEST_STEP:
                return STEP_TOO_SMALL if solved else NO_ROOT
            shrink = _SHRINK_ON_FAILURE
            if solved and error < 1e10:
                shrink = max(0.1, _SAFETY * error ** (-1.0 / rkc.ERROR_ORDER))
            control[STEP] = max(h * shrink, SHORTEST_STEP)
            if ramping:
                return RETRY
            continue
        error = max(error, 1e-6)
        growth = _SAFETY * (
            error ** (-0.7 / rkc.ERROR_ORDER) * control[LAST_ERROR] ** (0.4 / rkc.ERROR_ORDER)
        )
        most = 1.0 if counters[FAILED_IN_A_ROW] > 0 else 3.0
        control[STEP] = h * min(max(growth, 0.3), most)
        control[LAST_ERROR] = max(error, 1e-3)
        control[LOCAL_ERRORS] += error * tolerance
        control[PREVIOUS_TIME] = control[TIME]
        control[TIME] = end if lands else control[TIME] + h
        counters[STEPS] += 1
        counters[FAILED_IN_A_ROW] = 0
        states[PREVIOUS:CURRENT] = states[CURRENT:TRIAL]
        states[CURRENT:TRIAL] = states[TRIAL : TRIAL + 2]
        control[RADIUS] = spectral_radius(states[CURRENT], y, edges[-1], tension_rates[-1])
        if lands:
            return AT_BREAK
        if ramping:
            return RETRY
    return REACHED
