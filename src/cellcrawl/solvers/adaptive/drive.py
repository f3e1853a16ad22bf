"""Many error-controlled steps in one compiled call.

Where steps fall depends on the state, the step count and the next break only, never on the target:
a run may be stopped and resumed anywhere to the same bits.
"""

from __future__ import annotations

from typing import Final

import numpy as np

from cellcrawl._compile import kernel, woven_kernel
from cellcrawl.solvers.adaptive.differences import (
    DIFFERENCES,
    ERRORS,
    HIGHEST_ORDER,
    LEADING,
    ROOM,
    move_on,
    predict,
    rescale,
)
from cellcrawl.solvers.adaptive.newton import factor, solve
from cellcrawl.solvers.adaptive.rates import rates, renew_rates
from cellcrawl.solvers.adaptive.resolution import (
    COARSEN,
    COARSER_MISSES,
    allowance,
    formation,
    missed,
)
from cellcrawl.solvers.adaptive.staggered import HALO, fill_halo
from cellcrawl.solvers.adaptive.step_error import relative_size

TABLE_ROWS: Final = DIFFERENCES + ROOM
_ITERATE, _CORRECTION, _RESIDUAL, _HISTORY = range(DIFFERENCES, DIFFERENCES + 4)
# entries of `control`
(
    TIME,
    PREVIOUS_TIME,
    STEP,
    CONTRACTION,
    FACTORED,
    LOCAL_ERRORS,
    CONTRAST,
    MOST_MISSED,
    FORMATION,
) = range(9)
CONTROLS: Final = 12
# entries of `counters`
(
    STEPS,
    REJECTED,
    RATES,
    FAILED_IN_A_ROW,
    CHECK_DUE,
    RESTARTING,
    ORDER,
    EQUAL_STEPS,
    MATRIX_AGE,
    FACTORINGS,
) = range(10)
COUNTERS: Final = 12
# what `run` returns
REACHED, PAUSED, AT_BREAK, RETRY, CHECK_NODES, NO_ROOT, STEP_TOO_SMALL, UNRESOLVED = range(8)
# what `solve_step` returns
SOLVED, NOT_CONVERGED, ROOTLESS = range(3)

LONGEST_STEP: Final = 0.1  # an instability grows at rates up to 13; longer steps would hide it
SHORTEST_STEP: Final = 1e-10
_SAFETY = 0.85
_WORTH_A_CHANGE = 1.15  # of the step; a change costs a new matrix
_MOST_GROWTH = 8.0
_LEAST_SHRINK = 0.2
_SHRINK_ON_FAILURE = 0.4
_NEWTON_SHARE = 0.5  # of the tolerance, for what the Newton iteration leaves
_ITERATIONS = 4
_MATRIX_LASTS = 40  # steps
UNKNOWN_CONTRACTION: Final = 0.3
HOPELESS: Final = 10.0  # a full grid that misses this many times what is allowed ends the run
_LOOK_EVERY = 4  # steps between two looks at the resolution
_COARSEN_EVERY = 20
_LEAST_CONTRAST = 1e-7  # waves smaller than this are no longer followed to their own size
_AMPLIFIED = 0.05  # part of a local error found in the error at t = 5 (measured)


@woven_kernel
def bounded_step(h: float, time: float, end: float) -> float:
    """Return the step to try from ``time``: not too long, and landing on ``end`` evenly."""
    h = min(h, LONGEST_STEP)
    left = end - time
    if h >= left * 0.999:
        return left
    if 2.0 * h > left:
        return 0.5 * left
    return h


@kernel
def change_step(
    order: int, h: float, control: np.ndarray, counters: np.ndarray, table: np.ndarray
) -> None:
    """Go on with steps of ``h`` at ``order``."""
    if h != control[STEP]:
        rescale(order, h / control[STEP], table)
        control[STEP] = h
    counters[ORDER] = order
    counters[EQUAL_STEPS] = 0


@woven_kernel
def solve_step(
    tolerance: float,
    contrast: float,
    control: np.ndarray,
    counters: np.ndarray,
    table: np.ndarray,
    y: np.ndarray,
    edge: np.ndarray,
    matrix: np.ndarray,
    work: np.ndarray,
) -> int:
    """Solve the implicit formula for the state a step ahead by simplified Newton iterations."""
    order = counters[ORDER]
    c = control[STEP] / LEADING[order]
    now, correction = table[_ITERATE], table[_CORRECTION]
    residual, history = table[_RESIDUAL], table[_HISTORY]
    predict(order, table, now, history)
    for k in range(now.size):
        correction[k] = 0.0
    renew_rates(y, work)
    stale = counters[MATRIX_AGE] >= _MATRIX_LASTS
    last = 0.0
    for iteration in range(_ITERATIONS):
        counters[RATES] += 1
        if not rates(now, residual, y, edge, work):
            return ROOTLESS
        if iteration == 0 and (stale or control[FACTORED] != c):
            factor(c, now, y, edge, work, matrix)
            control[FACTORED] = c
            counters[MATRIX_AGE] = 0
            counters[FACTORINGS] += 1
        for k in range(now.size):
            residual[k] = c * residual[k] - history[k] - correction[k]
        solve(c, now, matrix, residual)
        for k in range(now.size):
            correction[k] += residual[k]
            now[k] += residual[k]
        left = relative_size(residual, now, y.size, contrast)
        if iteration > 0:
            if not left < 2.0 * last:
                return NOT_CONVERGED
            control[CONTRACTION] = max(0.3 * control[CONTRACTION], left / last)
        if not left < np.inf:
            return NOT_CONVERGED
        settled = left * min(control[CONTRACTION], 1.0) <= _NEWTON_SHARE * tolerance
        if settled and not (stale and iteration == 0 and left > 0.0):
            return SOLVED
        last = left
    return NOT_CONVERGED


def bend_history(
    control: np.ndarray,
    counters: np.ndarray,
    table: np.ndarray,
    y: np.ndarray,
    edge: np.ndarray,
    matrix: np.ndarray,
    work: np.ndarray,
) -> None:
    """Make the past lead to the present with the rates of a new grid.

    The grids' rates differ by what they miss. Without this the past has a kink there, which costs
    many short steps; stiff parts of the difference are damped as a step would.
    """
    order, h = counters[ORDER], control[STEP]
    state, residual = table[0], table[_RESIDUAL]
    renew_rates(y, work)
    if not rates(state, residual, y, edge, work):
        return
    residual *= h
    for j in range(1, order + 1):
        residual -= table[j] / j
    c = h / LEADING[order]
    factor(c, state, y, edge, work, matrix)
    solve(c, state, matrix, residual)
    table[1] += residual


@woven_kernel
def choose_step(
    error: float,
    tolerance: float,
    contrast: float,
    nodes: int,
    control: np.ndarray,
    counters: np.ndarray,
    table: np.ndarray,
) -> None:
    """Take the order and step that go furthest, once enough equal steps tell."""
    order = counters[ORDER]
    if counters[EQUAL_STEPS] <= order:
        return
    best = order
    growth = max(error, 1e-10) ** (-1.0 / (order + 1))
    if order > 1:
        lower = ERRORS[order - 1] * relative_size(table[order], table[0], nodes, contrast)
        longer = max(lower / tolerance, 1e-10) ** (-1.0 / order)
        if longer > growth:
            best, growth = order - 1, longer
    if order < HIGHEST_ORDER:
        higher = ERRORS[order + 1] * relative_size(table[order + 2], table[0], nodes, contrast)
        longer = max(higher / tolerance, 1e-10) ** (-1.0 / (order + 2))
        if longer > growth:
            best, growth = order + 1, longer
    growth = min(_SAFETY * growth, _MOST_GROWTH)
    h = min(control[STEP] * growth, LONGEST_STEP)
    if best != order or h > _WORTH_A_CHANGE * control[STEP] or h < control[STEP] / _WORTH_A_CHANGE:
        change_step(best, h, control, counters, table)


@kernel
def run(
    target: float,
    end: float,
    tolerance: float,
    most_steps: int,
    allowed: float,
    nodes_range: tuple[int, int],
    control: np.ndarray,
    counters: np.ndarray,
    table: np.ndarray,
    y: np.ndarray,
    edge: np.ndarray,
    ramping: bool,
    matrix: np.ndarray,
    work: np.ndarray,
) -> int:
    """Step until ``target`` is reached or something is for the caller to do.

    ``allowed`` is what the grid may miss (see `resolution`) while the nodes stay in their range.
    ``edge`` holds the parameters and G at the midpoints, shape (8, nodes), at the end of the next
    step; while they are ``ramping``, only one step is tried (`RETRY`).
    """
    tried = 0
    nodes = y.size
    while control[TIME] < target:
        if tried == most_steps:
            return PAUSED
        if counters[CHECK_DUE] == 1:
            return CHECK_NODES
        tried += 1
        h = bounded_step(control[STEP], control[TIME], end)
        lands = h == end - control[TIME]
        if h != control[STEP]:
            change_step(counters[ORDER], h, control, counters, table)
        order = counters[ORDER]
        contrast = min(max(control[CONTRAST], _LEAST_CONTRAST), 1.0) * control[FORMATION]
        ended = solve_step(tolerance, contrast, control, counters, table, y, edge, matrix, work)
        correction = table[_CORRECTION]
        error = np.inf
        if ended == SOLVED:
            size = relative_size(correction, table[_ITERATE], nodes, contrast)
            error = ERRORS[order] * size / tolerance
        if not error <= 1.0:
            counters[REJECTED] += 1
            counters[FAILED_IN_A_ROW] += 1
            if h <= SHORTEST_STEP:
                return NO_ROOT if ended == ROOTLESS else STEP_TOO_SMALL
            shrink = _SHRINK_ON_FAILURE
            if error < 1e10:
                shrink = error ** (-1.0 / (order + 1))
                if order > 1:
                    lower = table[_RESIDUAL]
                    for k in range(lower.size):
                        lower[k] = table[order, k] + correction[k]
                    size = relative_size(lower, table[_ITERATE], nodes, contrast)
                    longer = (ERRORS[order - 1] * size / tolerance) ** (-1.0 / order)
                    if longer > shrink:
                        order, shrink = order - 1, longer
                shrink = max(_LEAST_SHRINK, _SAFETY * min(shrink, 1.0))
            else:
                control[CONTRACTION] = UNKNOWN_CONTRACTION
            if counters[FAILED_IN_A_ROW] > 3:
                order = 1
            change_step(order, max(h * shrink, SHORTEST_STEP), control, counters, table)
            if ramping:
                return RETRY
            continue
        move_on(order, table, correction)
        control[LOCAL_ERRORS] += error * tolerance * _AMPLIFIED
        control[PREVIOUS_TIME] = control[TIME]
        control[TIME] = end if lands else control[TIME] + h
        counters[STEPS] += 1
        counters[FAILED_IN_A_ROW] = 0
        counters[EQUAL_STEPS] += 1
        counters[MATRIX_AGE] += 1
        choose_step(error, tolerance, contrast, nodes, control, counters, table)
        if counters[STEPS] % _LOOK_EVERY == 0:
            span = nodes + 2 * HALO
            fill_halo(table[0, :span], nodes)
            fill_halo(table[0, span : 2 * span], nodes)
            misses, control[CONTRAST] = missed(table[0], nodes, work)
            control[FORMATION] = formation(table[0, span : 2 * span], nodes)
            control[MOST_MISSED] = max(control[MOST_MISSED], misses)
            most = allowance(allowed, control[CONTRAST])
            if misses > most and nodes < nodes_range[1]:
                counters[CHECK_DUE] = 1
            elif misses > HOPELESS * allowed:
                return UNRESOLVED
            elif counters[STEPS] % _COARSEN_EVERY == 0 and nodes > nodes_range[0]:
                counters[CHECK_DUE] = 1 if COARSER_MISSES * misses < COARSEN * most else 0
        if lands:
            return AT_BREAK
        if ramping:
            return RETRY
    return REACHED
