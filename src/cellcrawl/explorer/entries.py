from typing import Any, NamedTuple
import math
import numpy as np
from numba import carray, njit
from numba.core import types
from cellcrawl._compile import kernel
from cellcrawl.laws.law import PAPER
from cellcrawl.solvers.adaptive import drive, resolution
from cellcrawl.solvers.adaptive.drive import *
from cellcrawl.solvers.adaptive.drive import run, FACTORED, CONTRACTION, UNKNOWN_CONTRACTION, TABLE_ROWS, CONTROLS, COUNTERS
from cellcrawl.solvers.adaptive.differences import DIFFERENCES
from cellcrawl.solvers.adaptive.mesh import MESH_ROWS, lay_out
from cellcrawl.solvers.adaptive.newton import MATRIX_ROWS
from cellcrawl.solvers.adaptive.rates import WORK_ROWS, rates, renew_rates
from cellcrawl.solvers.adaptive.staggered import HALO
from cellcrawl.solvers.adaptive.step_error import relative_size
from cellcrawl.solvers.adaptive.frame import _edge_shape, _sample, _balance
from cellcrawl.solvers.adaptive.projection import TRACE_ROWS
from cellcrawl.solvers.adaptive.entries import TENSION

from cellcrawl.explorer.starting import random_start
from cellcrawl.curve.crossing import crossing_edges
class Entry(NamedTuple):
    name: str
    function: Any
    signature: Any

LAW = PAPER.compiled
ROWS = len(PAPER.rows) + 1
F, I = types.CPointer(types.float64), types.CPointer(types.int64)

@kernel
def restart(laws, around, tolerance, control, counters, table, y, edge, mesh, work):
    nodes = y.size
    span = nodes + 2 * HALO
    s = table[0]
    lay_out(s[:span], s[span:2*span], s[2*span:3*span], 1e-3, 1, mesh, nodes)
    renew_rates(laws, y, edge, work)
    for j in range(1, table.shape[0]):
        for k in range(table.shape[1]):
            table[j, k] = 0.0
    counters[RATES] += 1
    if not rates(laws, around, control[TIME], s, table[1], y, edge, mesh, work):
        return False
    _, control[CONTRAST] = resolution.missed(s, nodes, work)
    control[FORMATION] = resolution.formation(s[span:2*span], nodes)
    pace = relative_size(table[1], s, nodes, 1.0)
    control[STEP] = 0.2 * math.sqrt(tolerance) / (1.0 + pace)
    for k in range(table.shape[1]):
        table[1, k] *= control[STEP]
    control[CONTRACTION] = UNKNOWN_CONTRACTION
    control[FACTORED] = 0.0
    counters[ORDER] = 1
    counters[EQUAL_STEPS] = 0
    counters[RESTARTING] = 0
    return True

def advance(nodes, target, rtol, control_, counters_, table_, y_, edge_, mesh_, work_, matrix_):
    span = nodes + 2 * HALO
    control = carray(control_, (CONTROLS,))
    counters = carray(counters_, (COUNTERS,))
    table = carray(table_, (TABLE_ROWS, 3 * span + 8))
    y = carray(y_, (nodes,))
    edge = carray(edge_, (ROWS, nodes))
    mesh = carray(mesh_, (MESH_ROWS, span))
    work = carray(work_, (WORK_ROWS, span))
    matrix = carray(matrix_, (MATRIX_ROWS, nodes))
    tol = 0.002 * rtol
    while control[TIME] < target:
        if counters[RESTARTING]:
            if not restart(LAW, None, tol, control, counters, table, y, edge, mesh, work):
                return 100
        code = run(LAW, None, target, np.inf, tol, 5000, max(3.0 * rtol, 1e-9), (nodes, nodes),
            control, counters, table, y, edge[:, :1].copy(), edge, False, mesh, matrix, work)
        if code == PAUSED:
            return 101
        if code != REACHED:
            return code
    return 0

def frame(nodes, count, steps, control_, counters_, table_, y_, edge_, state_, trace_, guess_, out_, whole_):
    span = nodes + 2 * HALO
    control = carray(control_, (CONTROLS,))
    counters = carray(counters_, (COUNTERS,))
    table = carray(table_, (TABLE_ROWS, 3 * span + 8))
    y = carray(y_, (nodes,))
    edge = carray(edge_, (ROWS, count))
    state = carray(state_, (3 * span + 8,))
    trace = carray(trace_, (TRACE_ROWS + 1, span))
    guess = carray(guess_, (count,))
    out = carray(out_, (8, count))
    whole = carray(whole_, (16,))
    area, x, yy, gap, excess, clear = _edge_shape(steps, counters[ORDER], table, state, trace)
    for k in range(8):
        whole[k] = state[3 * span + k]
    whole[8] = area
    whole[9] = x + whole[3]
    whole[10] = yy + whole[4]
    whole[11] = gap
    whole[12] = excess
    whole[13] = clear
    _sample(state, trace, y, guess, out)
    _balance(LAW, whole[1], edge, guess, out)
    return 0

def start(modes, count, n_bar, amplitudes_, theta_, bound_, whole_):
    amplitudes = carray(amplitudes_, (modes, 4))
    theta = carray(theta_, (count,))
    bound = carray(bound_, (count,))
    whole = carray(whole_, (16,))
    length, area = random_start(amplitudes, n_bar, theta, bound)
    whole[0] = length
    whole[1] = area
    return 0

def crossing(count, x_, y_):
    i, j = crossing_edges(carray(x_, (count,)), carray(y_, (count,)))
    return i

def entries():
    i32, f = types.int32, types.float64
    return [
        Entry("start", start, i32(i32, i32, f, F, F, F, F)),
        Entry("crossing", crossing, i32(i32, F, F)),
        Entry("advance", advance, i32(i32, f, f, F, I, F, F, F, F, F, F)),
        Entry("frame", frame, i32(i32, i32, f, F, I, F, F, F, F, F, F, F, F)),
    ]
