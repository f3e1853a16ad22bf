"""What comes before and after each step, whatever family it is of: its length, and its verdict.

A family's own ``run`` puts its step between `next_step` and `after_step`, so a run compiles one
family only. Where steps fall depends on the state, the step count and the next break only, never on
the target: a run may be stopped and resumed anywhere to the same bits.
"""

from __future__ import annotations

from typing import Final, NamedTuple

import numpy as np

from cellcrawl._compile import woven_kernel
from cellcrawl.solvers.adaptive.rates import stiffness
from cellcrawl.solvers.adaptive.resolution import (
    COARSEN,
    COARSER_MISSES,
    allowance,
    formation,
    missed,
)
from cellcrawl.solvers.adaptive.scheme import Scheme
from cellcrawl.solvers.adaptive.staggered import HALO

# rows of `states`; the last step went from PREVIOUS to CURRENT, the next is tried from START to END
PREVIOUS, PREVIOUS_RATES, CURRENT, CURRENT_RATES, TRIAL, TRIAL_RATES = range(6)
START, START_RATES, END, END_RATES = CURRENT, CURRENT_RATES, TRIAL, TRIAL_RATES
BEFORE, NOW, FIRST_OF_FOUR = 6, 7, 8  # room for the stages; the last: rates of four stages
STATE_ROWS: Final = 12
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
# what `run` returns; GO_ON only between the steps
GO_ON, REACHED, PAUSED, AT_BREAK, RETRY, CHECK_NODES, NO_ROOT, STEP_TOO_SMALL, UNRESOLVED = range(9)

LONGEST_STEP: Final = 0.1  # an instability grows at rates up to 13; longer steps would hide it
SHORTEST_STEP: Final = 1e-9
_AIM = 0.4  # error asked of a step, in tolerances
_RADIUS_MARGIN = 1.05
_SHRINK_ON_FAILURE = 0.25
HOPELESS: Final = 10.0  # a full grid that misses this many times what is allowed ends the run
_LOOK_EVERY = 2  # steps between two looks at the resolution
_COARSEN_EVERY = 10
_LEAST_CONTRAST = 0.01  # waves smaller than this are no longer followed to their own size


class Rules(NamedTuple):
    """What a step's error is held against, and what its family makes of it.

    ``(error / tolerance)**power`` goes as the step to the power of ``order``; ``amplified`` is the
    part of the local errors in the error at t = 5; ``tension_weight`` that of the error of a
    tension that does not decay within the step. ``allowed`` is what the grid may miss (see
    `resolution`) while the nodes stay between ``fewest_nodes`` and ``most_nodes``.
    """

    tolerance: float
    order: int
    power: float
    amplified: float
    tension_weight: float
    allowed: float
    fewest_nodes: int
    most_nodes: int


@woven_kernel
def bounded_step(h: float, time: float, end: float, radius: float, limits: np.ndarray) -> float:
    """Return the step to try from ``time``: stable, not too long, and landing on ``end`` evenly."""
    h = min(h, LONGEST_STEP, limits[-1] / (_RADIUS_MARGIN * radius))
    left = end - time
    if h >= left * 0.999:
        return left
    if 2.0 * h > left:
        return 0.5 * left
    return h


@woven_kernel
def next_step(
    target: float,
    end: float,
    scheme: Scheme,
    control: np.ndarray,
    counters: np.ndarray,
) -> tuple[int, float, int]:
    """Return `GO_ON`, the length of the step to try and the row of its method; or why not to."""
    if control[TIME] >= target:
        return REACHED, 0.0, 0
    if counters[CHECK_DUE] == 1:
        return CHECK_NODES, 0.0, 0
    limits = scheme.limits
    h = bounded_step(control[STEP], control[TIME], end, control[RADIUS], limits)
    k = 0
    while k < limits.size - 1 and limits[k] < _RADIUS_MARGIN * h * control[RADIUS]:
        k += 1
    counters[RATES] += scheme.degrees[k]
    return GO_ON, h, k


@woven_kernel
def error_scales(h: float, rules: Rules, control: np.ndarray) -> tuple[float, float]:
    """Return the weight of the tension's error, less if it decays, and the size of the waves."""
    relief = rules.tension_weight / (1.0 + h * control[TENSION_DECAY])
    contrast = min(max(control[CONTRAST], _LEAST_CONTRAST), 1.0) * control[FORMATION]
    return relief, contrast


@woven_kernel
def after_step(
    h: float,
    solved: bool,
    size: float,
    end: float,
    rules: Rules,
    control: np.ndarray,
    counters: np.ndarray,
    states: np.ndarray,
    y: np.ndarray,
    edges: np.ndarray,
    work: np.ndarray,
) -> int:
    """Take the step from START to END or refuse it; return `GO_ON` or what the caller is to do.

    ``size`` is its error. ``edges`` has shape (times, 8, nodes), the parameters and G at the
    midpoints: one time when they hold still, else at 0, 1/3, 2/3 and 1 of the step, and then only
    one step is tried (`RETRY`).
    """
    on = RETRY if edges.shape[0] > 1 else GO_ON
    lands = h == end - control[TIME]
    order, power = rules.order, rules.power
    error = (size / rules.tolerance) ** power
    if not solved or not error <= 1.0:
        counters[REJECTED] += 1
        counters[FAILED_IN_A_ROW] += 1
        if h <= SHORTEST_STEP:
            return STEP_TOO_SMALL if solved else NO_ROOT
        shrink = _SHRINK_ON_FAILURE
        if solved and error < 1e10:
            shrink = max(0.1, (error / _AIM) ** (-1.0 / order))
        control[STEP] = max(h * shrink, SHORTEST_STEP)
        return on
    error = max(error, 1e-6)
    growth = (error / _AIM) ** (-0.7 / order) * (control[LAST_ERROR] / _AIM) ** (0.4 / order)
    most = 1.0 if counters[FAILED_IN_A_ROW] > 0 else 3.0
    control[STEP] = h * min(max(growth, 0.3), most)
    control[LAST_ERROR] = max(error, 1e-3)
    control[LOCAL_ERRORS] += error ** (1.0 / power) * rules.tolerance * rules.amplified
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
    if counters[STEPS] % _LOOK_EVERY == 0:
        misses, control[CONTRAST] = missed(states[CURRENT], y.size, work)
        span = y.size + 2 * HALO
        control[FORMATION] = formation(states[CURRENT, span : 2 * span], y.size)
        control[MOST_MISSED] = max(control[MOST_MISSED], misses)
        most = allowance(rules.allowed, control[CONTRAST])
        if misses > most and y.size < rules.most_nodes:
            counters[CHECK_DUE] = 1
        elif misses > HOPELESS * rules.allowed:
            return UNRESOLVED
        elif counters[STEPS] % _COARSEN_EVERY == 0 and y.size > rules.fewest_nodes:
            counters[CHECK_DUE] = 1 if COARSER_MISSES * misses < COARSEN * most else 0
    return AT_BREAK if lands else on
