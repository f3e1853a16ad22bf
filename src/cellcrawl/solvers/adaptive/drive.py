"""Many error-controlled steps in one compiled call.

Where steps fall depends on the state, the step count and the next break only, never on the target:
a run may be stopped and resumed anywhere to the same bits.
"""

from __future__ import annotations

import math
from typing import Any, Final

import numpy as np

from cellcrawl.numerics.elementary import power
from cellcrawl.numerics.kernels import expanded_kernel, inlined_kernel, kernel
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
from cellcrawl.solvers.adaptive.mesh import (
    aim,
    edge_on_mesh,
    fill_uniform,
    hold,
    lay_out,
    normalise,
    read_profile,
    relax,
)
from cellcrawl.solvers.adaptive.newton import factor, solve
from cellcrawl.solvers.adaptive.projection import project
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
_ITERATE, _CORRECTION, RESIDUAL, _HISTORY = range(DIFFERENCES, DIFFERENCES + 4)
# entries of `control`
(
    TIME,
    PREVIOUS_TIME,
    STEP,
    CONTRACTION,
    FACTORED,
    CONTRAST,
    MISSED,
    LAST_LOOK,
    PEAK,
    FORMATION,
) = range(10)
CONTROLS: Final = 16
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
# what is due for the nodes: stay, one more or fewer, as few as the spectrum allows
KEEP, FINER, COARSER, FEWEST = range(4)
# what `solve_step` returns
SOLVED, NOT_CONVERGED, ROOTLESS = range(3)

_FIRST_STEP = 0.2  # times the root of the tolerance, relative to the rate of change
_SHORT = 1e-3  # a step at which the density of the nodes relaxes at its full rate
LONGEST_STEP: Final = 0.1  # an instability grows at rates up to 13; longer steps would hide it
SHORTEST_STEP: Final = 1e-10
_SAFETY = 0.85
_WORTH_A_CHANGE = 1.15  # of the step; a change costs a new matrix
_MOST_GROWTH = 8.0
_LEAST_SHRINK = 0.2
_SHRINK_ON_FAILURE = 0.4
_NEWTON_SHARE = 0.5
_ITERATIONS = 4
_MATRIX_LASTS = 40  # steps
UNKNOWN_CONTRACTION: Final = 0.1
HOPELESS: Final = 10.0  # a full grid that misses this many times what is allowed ends the run
_LOOK_EVERY = 4  # steps between two looks at the resolution
_COARSEN_EVERY = 20
_REMEMBERED = 3.0  # time over which what a grid misses is averaged
_PEAK_SHARE = 0.1  # of what a grid misses for a moment
_FORGET = 0.99  # of the most missed lately, at each look: a change of nodes costs 100 steps
_LEAST_CONTRAST = 1e-7  # waves smaller than this are no longer followed to their own size


@inlined_kernel
def restart(
    laws: Any,
    around: Any,
    tolerance: float,
    control: np.ndarray,
    counters: np.ndarray,
    table: np.ndarray,
    y: np.ndarray,
    profile: np.ndarray,
    edge: np.ndarray,
    mesh: np.ndarray,
    work: np.ndarray,
) -> bool:
    """Take the rates under the parameters that hold now, and begin with a short step.

    False where they have no root. Runs in Python, as what is called seldom does: in a kernel it
    would be compiled with all that it calls once more.
    """
    nodes = y.size
    span = nodes + 2 * HALO
    state, rate = table[0], table[1]
    w, n, g = state[:span], state[span : 2 * span], state[2 * span : 3 * span]
    read_profile(profile, g, edge, mesh, work)
    lay_out(w, n, g, _SHORT, 1, mesh, nodes)
    renew_rates(laws, y, edge, work)
    for row in range(1, table.shape[0]):
        cleared = table[row]
        cleared[:] = 0.0
    counters[RATES] += 1
    if not rates(laws, around, control[TIME], state, rate, y, edge, mesh, work):
        return False
    _, control[CONTRAST] = missed(state, nodes, work)
    control[FORMATION] = formation(n, nodes)
    pace = relative_size(rate, state, nodes, 1.0)
    control[STEP] = _FIRST_STEP * math.sqrt(tolerance) / (1.0 + pace)
    _scale(rate, control[STEP])
    control[CONTRACTION] = UNKNOWN_CONTRACTION
    control[FACTORED] = 0.0
    counters[ORDER] = 1
    counters[EQUAL_STEPS] = counters[RESTARTING] = 0
    return True


@kernel
def _scale(a: np.ndarray, factor: float) -> None:
    """Multiply all entries."""
    for k in range(a.size):
        a[k] *= factor


@inlined_kernel
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


@expanded_kernel
def solve_step(
    laws: Any,
    around: Any,
    tolerance: float,
    contrast: float,
    control: np.ndarray,
    counters: np.ndarray,
    table: np.ndarray,
    y: np.ndarray,
    profile: np.ndarray,
    edge: np.ndarray,
    mesh: np.ndarray,
    matrix: np.ndarray,
    work: np.ndarray,
) -> int:
    """Solve the implicit formula for the state a step ahead by simplified Newton iterations."""
    order = counters[ORDER]
    c = control[STEP] / LEADING[order]
    time = control[TIME] + control[STEP]
    now, correction = table[_ITERATE], table[_CORRECTION]
    residual, history = table[RESIDUAL], table[_HISTORY]
    predict(order, table, now, history)
    for k in range(now.size):
        correction[k] = 0.0
    span = y.size + 2 * HALO
    g = slice(2 * span, 3 * span)
    fill_halo(now[:span], y.size)
    fill_halo(now[span : 2 * span], y.size)
    hold(now[g], mesh, y.size)
    aim(now[:span], now[span : 2 * span], now[g], mesh, y.size)
    if not relax(c, control[STEP], order, now[g], history[g], correction[g], mesh, y.size):
        return NOT_CONVERGED
    hold(now[g], mesh, y.size)
    if profile.shape[1] > 1:
        edge_on_mesh(profile, now[g], edge, work)
    renew_rates(laws, y, edge, work)
    stale = counters[MATRIX_AGE] >= _MATRIX_LASTS
    last = 0.0
    for iteration in range(_ITERATIONS):
        counters[RATES] += 1
        if not rates(laws, around, time, now, residual, y, edge, mesh, work):
            return ROOTLESS
        if iteration == 0 and (stale or control[FACTORED] != c):
            factor(laws, around, time, c, now, y, edge, mesh, work, matrix)
            control[FACTORED] = c
            counters[MATRIX_AGE] = 0
            counters[FACTORINGS] += 1
            control[CONTRACTION] = max(control[CONTRACTION], UNKNOWN_CONTRACTION)
        for k in range(now.size):
            residual[k] = c * residual[k] - history[k] - correction[k]
        solve(c, now, mesh, matrix, residual)
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


@expanded_kernel
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
    growth = power(max(error, 1e-10), -1.0 / (order + 1))
    if order > 1:
        lower = ERRORS[order - 1] * relative_size(table[order], table[0], nodes, contrast)
        longer = power(max(lower / tolerance, 1e-10), -1.0 / order)
        if longer > growth:
            best, growth = order - 1, longer
    if order < HIGHEST_ORDER:
        higher = ERRORS[order + 1] * relative_size(table[order + 2], table[0], nodes, contrast)
        longer = power(max(higher / tolerance, 1e-10), -1.0 / (order + 2))
        if longer > growth:
            best, growth = order + 1, longer
    growth = min(_SAFETY * growth, _MOST_GROWTH)
    h = min(control[STEP] * growth, LONGEST_STEP)
    if best != order or h > _WORTH_A_CHANGE * control[STEP] or h < control[STEP] / _WORTH_A_CHANGE:
        change_step(best, h, control, counters, table)


@expanded_kernel
def run(
    laws: Any,
    around: Any,
    target: float,
    end: float,
    tolerance: float,
    most_steps: int,
    allowed: float,
    fewest_nodes: int,
    most_nodes: int,
    control: np.ndarray,
    counters: np.ndarray,
    table: np.ndarray,
    y: np.ndarray,
    profile: np.ndarray,
    edge: np.ndarray,
    ramping: bool,
    mesh: np.ndarray,
    matrix: np.ndarray,
    work: np.ndarray,
) -> int:
    """Step until ``target`` is reached or something is for the caller to do.

    ``allowed`` is what the grid may miss (see `resolution`) while the nodes stay in their range.
    ``profile`` holds the law's parameters and G at equal arclengths, shape (rows, places), at the
    end of the next step, with one place where they are the same all along the edge; while they are
    ``ramping``, only one step is tried (`RETRY`). ``edge`` is filled with them at the midpoints.
    """
    tried = 0
    nodes = y.size
    fill_uniform(profile, edge)
    while control[TIME] < target:
        if tried == most_steps:
            return PAUSED
        if counters[CHECK_DUE] != KEEP:
            return CHECK_NODES
        tried += 1
        h = bounded_step(control[STEP], control[TIME], end)
        lands = h == end - control[TIME]
        if h != control[STEP]:
            change_step(counters[ORDER], h, control, counters, table)
        order = counters[ORDER]
        contrast = min(max(control[CONTRAST], _LEAST_CONTRAST), 1.0)
        ended = solve_step(
            laws,
            around,
            tolerance,
            contrast,
            control,
            counters,
            table,
            y,
            profile,
            edge,
            mesh,
            matrix,
            work,
        )
        correction = table[_CORRECTION]
        error = np.inf
        if ended == SOLVED:
            size = relative_size(correction, table[_ITERATE], nodes, contrast)
            error = ERRORS[order] * size / tolerance
        if ended == NOT_CONVERGED and counters[MATRIX_AGE] > 0:
            control[FACTORED] = 0.0  # the step may be right and the matrix old
            continue
        if not error <= 1.0:
            counters[REJECTED] += 1
            counters[FAILED_IN_A_ROW] += 1
            if h <= SHORTEST_STEP:
                return NO_ROOT if ended == ROOTLESS else STEP_TOO_SMALL
            shrink = _SHRINK_ON_FAILURE
            if error < 1e10:
                shrink = power(error, -1.0 / (order + 1))
                if order > 1:
                    lower = table[RESIDUAL]
                    for k in range(lower.size):
                        lower[k] = table[order, k] + correction[k]
                    size = relative_size(lower, table[_ITERATE], nodes, contrast)
                    longer = power(ERRORS[order - 1] * size / tolerance, -1.0 / order)
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
        control[PREVIOUS_TIME] = control[TIME]
        control[TIME] = end if lands else control[TIME] + h
        counters[STEPS] += 1
        counters[FAILED_IN_A_ROW] = 0
        counters[EQUAL_STEPS] += 1
        counters[MATRIX_AGE] += 1
        choose_step(error, tolerance, contrast, nodes, control, counters, table)
        if counters[STEPS] % _LOOK_EVERY == 0:
            span = nodes + 2 * HALO
            normalise(table[0, 2 * span : 3 * span], nodes)
            project(table[0], nodes, work)
            fill_halo(table[0, span : 2 * span], nodes)
            misses, control[CONTRAST] = missed(table[0], nodes, work)
            control[FORMATION] = formation(table[0, span : 2 * span], nodes)
            formed = control[FORMATION] >= 1.0
            # later errors add up; while the cell forms each is magnified, and counts at once
            part = min((control[TIME] - control[LAST_LOOK]) / _REMEMBERED, 1.0) if formed else 1.0
            control[LAST_LOOK] = control[TIME]
            control[MISSED] += part * (misses - control[MISSED])
            misses = max(control[MISSED], _PEAK_SHARE * misses)
            control[PEAK] = max(control[PEAK] * _FORGET, misses) if formed else misses
            most = allowance(allowed, control[CONTRAST], formed)
            if misses > most and nodes < most_nodes:
                counters[CHECK_DUE] = FINER
            elif misses > HOPELESS * most:
                return UNRESOLVED
            elif counters[STEPS] % _COARSEN_EVERY == 0 and nodes > fewest_nodes:
                if not formed and COARSER_MISSES * misses < COARSEN * most:
                    counters[CHECK_DUE] = FEWEST
                elif COARSER_MISSES * control[PEAK] < COARSEN * most:
                    counters[CHECK_DUE] = COARSER
        if lands:
            return AT_BREAK
        if ramping:
            return RETRY
    return REACHED
