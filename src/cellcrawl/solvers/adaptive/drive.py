"""Many error-controlled steps in one compiled call.

Where steps fall depends on the state, the step count and the next break only, never on the target:
a run may be stopped and resumed anywhere to the same bits.
"""

from __future__ import annotations

from typing import Final

import numpy as np

from cellcrawl._compile import kernel
from cellcrawl.solvers.adaptive import chebyshev, stabilised
from cellcrawl.solvers.adaptive.rates import stiffness
from cellcrawl.solvers.adaptive.resolution import (
    COARSEN,
    COARSER_MISSES,
    allowance,
    formation,
    missed,
)
from cellcrawl.solvers.adaptive.staggered import HALO

# rows of `states`; the last step went from PREVIOUS to CURRENT
PREVIOUS, PREVIOUS_RATES, CURRENT, CURRENT_RATES, TRIAL, TRIAL_RATES = range(6)
# entries of `control`
(
    TIME,
    PREVIOUS_TIME,
    STEP,
    LAST_ERROR,
    RADIUS,
    TENSION_DECAY,
    LOCAL_ERRORS,
    CONTRAST,
    MOST_MISSED,
    FORMATION,
) = range(10)
CONTROLS: Final = 12
# entries of `counters`
STEPS, REJECTED, RATES, FAILED_IN_A_ROW, CHECK_DUE, RESTARTING, ORDER = range(7)
COUNTERS: Final = 8
# what `run` returns
REACHED, PAUSED, AT_BREAK, RETRY, CHECK_NODES, NO_ROOT, STEP_TOO_SMALL, UNRESOLVED = range(8)

LONGEST_STEP: Final = 0.1  # an instability grows at rates up to 13; longer steps would hide it
SHORTEST_STEP: Final = 1e-9
_AIM = 0.4  # error asked of a step, in tolerances
_RADIUS_MARGIN = 1.05
_SHRINK_ON_FAILURE = 0.25
HOPELESS: Final = 10.0  # a full grid that misses this many times what is allowed ends the run
_LOOK_EVERY = 2  # steps between two looks at the resolution
_COARSEN_EVERY = 10
_LEAST_CONTRAST = 0.01  # waves smaller than this are no longer followed to their own size


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
    order: int,
    most_steps: int,
    allowed: float,
    nodes_range: tuple[int, int],
    control: np.ndarray,
    counters: np.ndarray,
    states: np.ndarray,
    y: np.ndarray,
    edges: np.ndarray,
    limits: np.ndarray,
    degrees: np.ndarray,
    first: np.ndarray,
    recurrence: np.ndarray,
    finish: np.ndarray,
    mixed: np.ndarray,
    work: np.ndarray,
) -> int:
    """Step until ``target`` is reached or something is for the caller to do.

    ``allowed`` is what the grid may miss (see `resolution`) while the nodes stay in their range.
    ``edges`` has shape (times, 8, nodes), the parameters and G at the midpoints: one time when they
    hold still, else at 0, 1/3, 2/3 and 1 of the next step, and then only one step is tried
    (`RETRY`).
    """
    ramping = edges.shape[0] > 1
    # a second-order step's estimate is of third order: take the power that goes as its square
    power = 2.0 / 3.0 if order == chebyshev.ORDER else 1.0
    amplified = 0.05 if order == chebyshev.ORDER else 0.002  # into the error at t = 5
    weight = 1.0 if order == chebyshev.ORDER else 6.0
    tried = 0
    while control[TIME] < target:
        if tried == most_steps:
            return PAUSED
        if counters[CHECK_DUE] == 1:
            return CHECK_NODES
        tried += 1
        h = bounded_step(control[STEP], control[TIME], end, control[RADIUS], limits)
        lands = h == end - control[TIME]
        k = 0
        while k < limits.size - 1 and limits[k] < _RADIUS_MARGIN * h * control[RADIUS]:
            k += 1
        degree = degrees[k]
        counters[RATES] += degree
        relief = weight / (1.0 + h * control[TENSION_DECAY])
        contrast = min(max(control[CONTRAST], _LEAST_CONTRAST), 1.0) * control[FORMATION]
        if order == chebyshev.ORDER:
            solved, error = chebyshev.step(
                h, degree, recurrence[first[k] :], relief, contrast, states, y, edges, mixed, work
            )
        else:
            solved, error = stabilised.step(
                h,
                degree,
                recurrence[first[k] :],
                finish[k],
                relief,
                contrast,
                states,
                y,
                edges,
                mixed,
                work,
            )
        error = (error / tolerance) ** power
        if not solved or not error <= 1.0:
            counters[REJECTED] += 1
            counters[FAILED_IN_A_ROW] += 1
            if h <= SHORTEST_STEP:
                return STEP_TOO_SMALL if solved else NO_ROOT
            shrink = _SHRINK_ON_FAILURE
            if solved and error < 1e10:
                shrink = max(0.1, (error / _AIM) ** (-1.0 / order))
            control[STEP] = max(h * shrink, SHORTEST_STEP)
            if ramping:
                return RETRY
            continue
        error = max(error, 1e-6)
        growth = (error / _AIM) ** (-0.7 / order) * (control[LAST_ERROR] / _AIM) ** (0.4 / order)
        most = 1.0 if counters[FAILED_IN_A_ROW] > 0 else 3.0
        control[STEP] = h * min(max(growth, 0.3), most)
        control[LAST_ERROR] = max(error, 1e-3)
        control[LOCAL_ERRORS] += error ** (1.0 / power) * tolerance * amplified
        control[PREVIOUS_TIME] = control[TIME]
        control[TIME] = end if lands else control[TIME] + h
        counters[STEPS] += 1
        counters[FAILED_IN_A_ROW] = 0
        for i in range(states.shape[1]):
            states[PREVIOUS, i] = states[CURRENT, i]
            states[PREVIOUS_RATES, i] = states[CURRENT_RATES, i]
            states[CURRENT, i] = states[TRIAL, i]
            states[CURRENT_RATES, i] = states[TRIAL_RATES, i]
        control[RADIUS], control[TENSION_DECAY] = stiffness(states[CURRENT], y, edges[-1], work)
        if counters[STEPS] % _LOOK_EVERY != 0:
            if lands:
                return AT_BREAK
            if ramping:
                return RETRY
            continue
        misses, control[CONTRAST] = missed(states[CURRENT], y.size, work)
        span = y.size + 2 * HALO
        control[FORMATION] = formation(states[CURRENT, span : 2 * span], y.size)
        control[MOST_MISSED] = max(control[MOST_MISSED], misses)
        most = allowance(allowed, control[CONTRAST])
        if misses > most and y.size < nodes_range[1]:
            counters[CHECK_DUE] = 1
        elif misses > HOPELESS * allowed:
            return UNRESOLVED
        elif counters[STEPS] % _COARSEN_EVERY == 0 and y.size > nodes_range[0]:
            counters[CHECK_DUE] = 1 if COARSER_MISSES * misses < COARSEN * most else 0
        if lands:
            return AT_BREAK
        if ramping:
            return RETRY
    return REACHED
