"""What a page can call: the solver's own kernels on arrays at given places of its memory.

A page lays out the arrays that `AdaptiveSolver` holds, and calls in its order: a start, `advance`
again and again, `move` to other nodes where that asks for it, `frame` to look. Everything that the
solver computes is computed by its own kernels; here pointers become arrays, no more.
"""

from __future__ import annotations

from typing import Any, Final, NamedTuple

import numba
import numpy as np
from numba.core import types

from cellcrawl.curve.crossing import crossing_edges
from cellcrawl.laws import SHIPPED, Law
from cellcrawl.laws.balanced_edge import TRIALS, at_bond_force, force_at_rest, trial_force
from cellcrawl.laws.law import PAPER
from cellcrawl.numerics.elementary import natural_logarithm
from cellcrawl.solvers.adaptive import drive
from cellcrawl.solvers.adaptive.differences import DIFFERENCES
from cellcrawl.solvers.adaptive.entries import FIELDS, SCALARS
from cellcrawl.solvers.adaptive.frame import CLEARLY, MEASURES, fill_frame, measure
from cellcrawl.solvers.adaptive.mesh import MESH_ROWS
from cellcrawl.solvers.adaptive.newton import MATRIX_ROWS
from cellcrawl.solvers.adaptive.place import Around
from cellcrawl.solvers.adaptive.projection import TRACE_ROWS, project
from cellcrawl.solvers.adaptive.rates import WORK_ROWS
from cellcrawl.solvers.adaptive.regrid import move_to_nodes, wanted_nodes
from cellcrawl.solvers.adaptive.resolution import NODE_COUNTS, allowance, fewest_nodes, missed_on
from cellcrawl.solvers.adaptive.staggered import HALO
from cellcrawl.solvers.adaptive.waves import resample, slopes
from cellcrawl.starts.small_waves import random_start
from cellcrawl.surroundings import Islands, LocalPulse, Pillars, Surroundings
from cellcrawl.surroundings.lookup import APPEARS
from cellcrawl.surroundings.motion import BENDS, MOTION, MOVES
from cellcrawl.surroundings.place import Around as AroundEdge

MOST_DISCS: Final = 200  # of islands, and of pillars
OUTPUT_ROWS: Final = 8
FEWEST, MOST = NODE_COUNTS[0], NODE_COUNTS[-1]
REACHED, BROKEN, UNRESOLVED_START, RAMPING, NO_REST = 0, 100, 101, 102, 103
MOVE: Final = 10_000  # and the number of nodes: what `advance` returns where it asks for others
_STEPS_PER_CALL: Final = 5000
_TABLE_ROWS, _CONTROLS, _COUNTERS = drive.TABLE_ROWS, drive.CONTROLS, drive.COUNTERS
_TIME, _RESTARTING = drive.TIME, drive.RESTARTING
_AT_BREAK, _CHECK_NODES, _PAUSED, _RETRY = (
    drive.AT_BREAK,
    drive.CHECK_NODES,
    drive.PAUSED,
    drive.RETRY,
)
_ORDER: Final = drive.ORDER
_carray: Any = getattr(numba, "carray")  # noqa: B009, which its types lack

GROUND: Final = Surroundings(
    [
        Islands([[0.0, 0.0, 1.0]] * MOST_DISCS),
        Pillars([[0.0, 0.0, 1.0]] * MOST_DISCS),
        LocalPulse(begin=-1e9),
    ]
)
"""What can be painted and done on the page; with no disc and no pulse it changes nothing."""
LAWS: Final[dict[str, Law]] = {name: kind() for name, kind in SHIPPED.items()}


class Entry(NamedTuple):
    """A function that the module exports: its name, what it does, and its Numba signature."""

    name: str
    function: Any
    signature: Any


def layout() -> dict[str, Any]:
    """Return sizes and numbers that whoever calls the entries needs."""
    data, discs = _bare_ground()
    return {
        "rows": {name: list(law.rows) for name, law in LAWS.items()},
        "motion": MOTION,
        "halo": HALO,
        "fields": FIELDS,
        "scalars": SCALARS,
        "table_rows": _TABLE_ROWS,
        "controls": _CONTROLS,
        "counters": _COUNTERS,
        "mesh_rows": MESH_ROWS,
        "work_rows": WORK_ROWS,
        "matrix_rows": MATRIX_ROWS,
        "trace_rows": TRACE_ROWS,
        "differences": DIFFERENCES,
        "most_nodes": MOST,
        "clearly": CLEARLY,
        "time": _TIME,
        "previous_time": drive.PREVIOUS_TIME,
        "step": drive.STEP,
        "factored": drive.FACTORED,
        "steps": drive.STEPS,
        "restarting": _RESTARTING,
        "codes": {
            "at_break": _AT_BREAK,
            "no_root": drive.NO_ROOT,
            "step_too_small": drive.STEP_TOO_SMALL,
            "unresolved": drive.UNRESOLVED,
            "broken": BROKEN,
            "unresolved_start": UNRESOLVED_START,
            "ramping": RAMPING,
            "no_rest": NO_REST,
            "move": MOVE,
        },
        "ground": data,
        "discs": discs,
        "appears": APPEARS,
        "most_discs": MOST_DISCS,
    }


def _bare_ground() -> tuple[list[float], dict[str, int]]:
    """Return the numbers of a ground without discs, and where the counts of discs are."""
    data = GROUND.compiled(PAPER).data.tolist()
    counts, first = {}, 0
    for part in GROUND.parts:
        table = first + len(part.values)
        if part.table().size:
            counts[type(part).__name__.lower()] = table + 1
            data[table + 1] = 0.0
        first = table + part.table().size
    return data, counts


def start(
    modes: int,
    count: int,
    n_bar: float,
    allowed: float,
    amplitudes_at: Any,
    theta_at: Any,
    bound_at: Any,
    whole_at: Any,
) -> int:
    """Make the random start; return the nodes it asks for, length and area in ``whole``."""
    theta, bound = _carray(theta_at, (count,)), _carray(bound_at, (count,))
    whole = _carray(whole_at, (16,))
    length, area = random_start(_carray(amplitudes_at, (modes, 4)), n_bar, theta, bound)
    whole[0], whole[1] = length, area
    angle, density = np.empty(count), np.ones(count)
    for i in range(count):
        theta[i] -= 2.0 * np.pi * i / count
        angle[i] = theta[i]
    waves = slopes(angle, bound, density)
    may_miss = allowance(allowed, 0.0, False)
    if missed_on(waves, count) > 3.0 * may_miss:
        return UNRESOLVED_START
    nodes = fewest_nodes(waves, may_miss, FEWEST, MOST)
    return nodes if nodes <= MOST else UNRESOLVED_START


def settle(
    nodes: int, count: int, theta_at: Any, bound_at: Any, table_at: Any, work_at: Any
) -> int:
    """Put a start on its nodes; the state's scalars are there already."""
    span = nodes + 2 * HALO
    table = _carray(table_at, (_TABLE_ROWS, FIELDS * span + SCALARS))
    work = _carray(work_at, (WORK_ROWS, span))
    theta, bound = _carray(theta_at, (count,)), _carray(bound_at, (count,))
    state = table[0]
    inner, middle = slice(HALO, HALO + nodes), slice(span + HALO, span + HALO + nodes)
    resample(theta, theta, 0.0, state[inner], state[inner])
    resample(bound, bound, np.pi / nodes, state[middle], state[middle])
    for i in range(nodes):
        state[2 * span + HALO + i] = 1.0
    project(state, nodes, work)
    return REACHED


def crossing(count: int, x_at: Any, y_at: Any) -> int:
    """Return an edge of the outline that crosses another, -1 if there is none."""
    first, _ = crossing_edges(_carray(x_at, (count,)), _carray(y_at, (count,)))
    return first


def logarithm(x: float, whole_at: Any) -> int:
    """Put the logarithm that the package takes first in ``whole``."""
    _carray(whole_at, (16,))[0] = natural_logarithm(x)
    return REACHED


def next_time(control_at: Any, end: float, whole_at: Any) -> int:
    """Put the time at which the next step ends first in ``whole``."""
    control = _carray(control_at, (_CONTROLS,))
    now = control[_TIME]
    h = drive.bounded_step(control[drive.STEP], now, end)
    _carray(whole_at, (16,))[0] = end if h == end - now else now + h
    return REACHED


def _at_rest(laws: Law) -> Any:
    """Return what finds the resting circle of least force on a bond, as `rest_state` does."""
    law, rows = laws.compiled, len(laws.rows) + 1

    def rest(profile_at: Any, whole_at: Any) -> int:
        edge, whole = _carray(profile_at, (rows, 1)), _carray(whole_at, (16,))
        before = np.nan
        for k in range(TRIALS):
            speed = at_bond_force(law, trial_force(k), 1.0, edge)[0]
            if np.isfinite(before) and np.isfinite(speed) and (before > 0.0) != (speed > 0.0):
                phi = force_at_rest(law, trial_force(k - 1), trial_force(k), 1.0, edge)
                _, _, whole[0], whole[1] = at_bond_force(law, phi, 1.0, edge)
                return REACHED
            before = speed
        return NO_REST

    return rest


def _on_the_way(laws: Law, surrounded: bool) -> tuple[Any, Any, Any]:
    """Return `advance`, `move` and `frame` for a cell that is alone, or has a ground."""
    law, rows = laws.compiled, len(laws.rows) + 1
    ground = GROUND.compiled(laws)
    entries = ground.data.size

    if surrounded:

        def still(local_at: Any, nodes: int) -> Any:
            """The motion, of which no ground here asks: beside the local parameters."""
            motion = _carray(local_at, (rows * nodes + MOTION,))[rows * nodes :]
            motion[BENDS] = motion[MOVES] = 0.0
            return motion

        still = numba.extending.register_jitable(still)

        def around(data_at: Any, local_at: Any, room_at: Any, nodes: int) -> Any:
            data = _carray(data_at, (entries,))
            local, before = _carray(local_at, (rows, nodes)), _carray(local_at, (rows, 0))
            motion = still(local_at, nodes)
            room = _carray(room_at, (TRACE_ROWS, nodes + 2 * HALO))
            return Around(ground, data, local, before, motion, room)

        def around_edge(data_at: Any, local_at: Any, count: int) -> Any:
            data = _carray(data_at, (entries,))
            local, before = _carray(local_at, (rows, count)), _carray(local_at, (rows, 0))
            return AroundEdge(ground, data, local, before, still(local_at, count))

    else:

        def around(data_at: Any, local_at: Any, room_at: Any, nodes: int) -> Any:
            return None

        def around_edge(data_at: Any, local_at: Any, count: int) -> Any:
            return None

    around = numba.extending.register_jitable(around)
    around_edge = numba.extending.register_jitable(around_edge)

    def advance(
        nodes: int,
        target: float,
        end: float,
        ramping: int,
        tolerance: float,
        allowed: float,
        control_at: Any,
        counters_at: Any,
        table_at: Any,
        y_at: Any,
        profile_at: Any,
        edge_at: Any,
        mesh_at: Any,
        matrix_at: Any,
        work_at: Any,
        data_at: Any,
        local_at: Any,
        room_at: Any,
    ) -> int:
        span = nodes + 2 * HALO
        control, counters = _carray(control_at, (_CONTROLS,)), _carray(counters_at, (_COUNTERS,))
        table = _carray(table_at, (_TABLE_ROWS, FIELDS * span + SCALARS))
        y, profile = _carray(y_at, (nodes,)), _carray(profile_at, (rows, 1))
        edge, mesh = _carray(edge_at, (rows, nodes)), _carray(mesh_at, (MESH_ROWS, span))
        matrix, work = _carray(matrix_at, (MATRIX_ROWS, nodes)), _carray(work_at, (WORK_ROWS, span))
        place = around(data_at, local_at, room_at, nodes)
        while control[_TIME] < target or counters[_RESTARTING] != 0:
            if counters[_RESTARTING] != 0:
                began = drive.restart(
                    law, place, tolerance, control, counters, table, y, profile, edge, mesh, work
                )
                if not began:
                    return BROKEN
                if control[_TIME] >= target:
                    return REACHED
            code = drive.run(
                law,
                place,
                target,
                end,
                tolerance,
                _STEPS_PER_CALL,
                allowed,
                FEWEST,
                MOST,
                control,
                counters,
                table,
                y,
                profile,
                edge,
                ramping != 0,
                mesh,
                matrix,
                work,
            )
            if code == _AT_BREAK:
                counters[_RESTARTING] = 1
                return code
            if code == _CHECK_NODES:
                wanted = wanted_nodes(allowed, FEWEST, MOST, control, counters, table, nodes)
                if wanted != nodes:
                    return MOVE + wanted
            elif code == _RETRY and ramping != 0:
                return RAMPING
            elif code not in (REACHED, _PAUSED, _RETRY):
                return code
        return REACHED

    def move(
        old: int,
        nodes: int,
        control_at: Any,
        counters_at: Any,
        old_table_at: Any,
        old_y_at: Any,
        table_at: Any,
        y_at: Any,
        profile_at: Any,
        edge_at: Any,
        mesh_at: Any,
        matrix_at: Any,
        work_at: Any,
        data_at: Any,
        local_at: Any,
        room_at: Any,
    ) -> int:
        span = nodes + 2 * HALO
        move_to_nodes(
            law,
            around(data_at, local_at, room_at, nodes),
            _carray(control_at, (_CONTROLS,)),
            _carray(counters_at, (_COUNTERS,)),
            _carray(old_table_at, (_TABLE_ROWS, FIELDS * (old + 2 * HALO) + SCALARS)),
            _carray(old_y_at, (old,)),
            _carray(table_at, (_TABLE_ROWS, FIELDS * span + SCALARS)),
            _carray(y_at, (nodes,)),
            _carray(profile_at, (rows, 1)),
            _carray(edge_at, (rows, nodes)),
            _carray(mesh_at, (MESH_ROWS, span)),
            _carray(matrix_at, (MATRIX_ROWS, nodes)),
            _carray(work_at, (WORK_ROWS, span)),
        )
        return REACHED

    def frame(
        nodes: int,
        count: int,
        time: float,
        steps: float,
        counters_at: Any,
        table_at: Any,
        y_at: Any,
        profile_at: Any,
        state_at: Any,
        trace_at: Any,
        edge_at: Any,
        out_at: Any,
        whole_at: Any,
        data_at: Any,
        local_at: Any,
    ) -> int:
        span = nodes + 2 * HALO
        order = _carray(counters_at, (_COUNTERS,))[_ORDER]
        table = _carray(table_at, (_TABLE_ROWS, FIELDS * span + SCALARS))
        state = _carray(state_at, (FIELDS * span + SCALARS,))
        trace = _carray(trace_at, (TRACE_ROWS, span))
        whole = _carray(whole_at, (16,))
        measure(steps, order, table, state, trace, whole[:MEASURES], whole[MEASURES:])
        fill_frame(
            law,
            around_edge(data_at, local_at, count),
            time,
            state,
            trace,
            _carray(y_at, (nodes,)),
            _carray(profile_at, (rows, 1)),
            _carray(edge_at, (rows + 1, count)),
            _carray(out_at, (OUTPUT_ROWS, count)),
        )
        return REACHED

    return advance, move, frame


def entries() -> list[Entry]:
    """Return all entry points of the module.

    A cell under the paper's law and without a ground, as most are, is spared the ground's work.
    """
    i32, f64 = types.int32, types.float64
    pointer: Any = types.CPointer
    floats, ints = pointer(f64), pointer(types.int64)

    def takes(*given: Any) -> Any:
        return i32(*given)

    found = [
        Entry("start", start, takes(i32, i32, f64, f64, *[floats] * 4)),
        Entry("settle", settle, takes(i32, i32, *[floats] * 4)),
        Entry("crossing", crossing, takes(i32, floats, floats)),
        Entry("logarithm", logarithm, takes(f64, floats)),
        Entry("next_time", next_time, takes(floats, f64, floats)),
    ]
    for kind, law in LAWS.items():
        named = kind.replace("-", "_")
        if law != PAPER:
            found.append(Entry(f"rest_{named}", _at_rest(law), takes(floats, floats)))
        for surrounded in (False, True) if law == PAPER else (True,):
            advance, move, frame = _on_the_way(law, surrounded)
            name = f"{named}_on_ground" if surrounded else named
            found += [
                Entry(
                    f"advance_{name}",
                    advance,
                    takes(i32, f64, f64, i32, f64, f64, floats, ints, *[floats] * 10),
                ),
                Entry(f"move_{name}", move, takes(i32, i32, floats, ints, *[floats] * 12)),
                Entry(f"frame_{name}", frame, takes(i32, i32, f64, f64, ints, *[floats] * 10)),
            ]
    return found
