"""The adaptive solver: the user gives a tolerance, it chooses nodes and steps."""

from __future__ import annotations

import functools
from collections.abc import Sequence
from typing import Any, ClassVar

import numpy as np

from cellcrawl.errors import InputError
from cellcrawl.laws.addresses import without_code
from cellcrawl.numerics.elementary import natural_logarithm
from cellcrawl.solvers.adaptive import ahead, drive, resolution
from cellcrawl.solvers.adaptive import state as layout
from cellcrawl.solvers.adaptive.differences import DIFFERENCES
from cellcrawl.solvers.adaptive.follow import follow
from cellcrawl.solvers.adaptive.frame import (
    MEASURES,
    Shape,
    frame,
    instant,
    measure,
    room_for_shape,
)
from cellcrawl.solvers.adaptive.linked import Linked, linked
from cellcrawl.solvers.adaptive.mesh import MESH_ROWS
from cellcrawl.solvers.adaptive.newton import MATRIX_ROWS
from cellcrawl.solvers.adaptive.place import Around, around
from cellcrawl.solvers.adaptive.projection import project
from cellcrawl.solvers.adaptive.rates import WORK_ROWS
from cellcrawl.solvers.adaptive.regrid import move_to_nodes, wanted_nodes
from cellcrawl.solvers.adaptive.staggered import HALO
from cellcrawl.solvers.adaptive.waves import slopes
from cellcrawl.solvers.base import Breakdown, Frame, Instant, Solver
from cellcrawl.solvers.conditions import Conditions
from cellcrawl.starts.base import CellState
from cellcrawl.surroundings import place
from cellcrawl.validation import real_number, whole_number

_STEPS_PER_CALL = 5000  # between two looks at Ctrl-C
_START_NODES = 1024
_USUAL_RTOL = 1e-4
_TIGHT_RTOL = 1e-5  # below it a start is sampled more finely
_PLACES = 1024  # at which parameters that vary along the edge are read


class AdaptiveSolver(Solver):
    """Tenth order in space on a staggered grid, backward differentiation of order 1 to 5 in time.

    ``rtol`` is the error asked of length, tension and area (relative) and of position (over the
    radius) after a few units of time. The node count follows the state's spectrum.
    """

    name: ClassVar[str] = "adaptive"
    TIMES_AT_ONCE: ClassVar[int] = 50
    OPTIONS: ClassVar[dict[str, str]] = {
        "nodes": "nodes in the output, 16 to 100000 (default 256)",
        "rtol": "relative tolerance, 1e-10 to 1e-2 (default 1e-4)",
        "max_nodes": "most nodes the solver may use itself, 64 to 4096 (default 4096)",
        "min_nodes": "fewest nodes the solver may use itself, 64 to 4096 (default 64)",
    }

    def __init__(
        self,
        start: CellState | None,
        conditions: Conditions,
        time: float = 0.0,
        *,
        nodes: int = 256,
        rtol: float = _USUAL_RTOL,
        max_nodes: int = 4096,
        min_nodes: int = 64,
    ) -> None:
        self._conditions = conditions
        self._laws = conditions.laws.compiled
        self._compiled_surroundings = conditions.around()
        self._nodes = self.checked_nodes(nodes)
        rows = len(conditions.laws.rows) + 1
        self._placed = place.around(self._compiled_surroundings, rows, self._nodes)
        self._around: Around | None = None
        self._constant: np.ndarray | None = None  # parameters of a run in which none changes
        self._rtol = real_number("rtol", rtol, 1e-10, 1e-2)
        self._tolerance, self._allowed = _local_tolerance(self._rtol), _grid_tolerance(self._rtol)
        counts = resolution.NODE_COUNTS
        self._max_nodes = whole_number("max_nodes", max_nodes, counts[0], counts[-1])
        self._min_nodes = whole_number("min_nodes", min_nodes, counts[0], self._max_nodes)
        self._control = np.zeros(drive.CONTROLS)
        self._counters = np.zeros(drive.COUNTERS, np.int64)
        self._tally = np.zeros(5)  # fewest nodes, most nodes, regrids, largest errors mended
        self._control[drive.TIME] = self._control[drive.PREVIOUS_TIME] = time
        self._measured: Shape | None = None
        self._counters[drive.RESTARTING] = 1
        if start is not None:
            self._begin(start)

    @property
    def time(self) -> float:  # type: ignore[override]
        """Time of the current state: the end of the last step."""
        return float(self._control[drive.TIME])

    @classmethod
    def checked_nodes(cls, nodes: Any) -> int:
        """Return the number of output nodes, 256 for None."""
        return 256 if nodes is None else whole_number("nodes", nodes, 16, 100_000)

    @classmethod
    def start_nodes(cls, nodes: int, **options: Any) -> int:
        """Return the nodes to sample a start on; the solver then takes as many as it needs."""
        rtol = real_number("rtol", options.get("rtol", _USUAL_RTOL), 1e-10, 1e-2)
        return _START_NODES if rtol >= _TIGHT_RTOL else 4 * _START_NODES

    def advance(self, target: float) -> Breakdown | None:
        return self._follow(np.array([target]), np.empty((1, MEASURES)))[1]

    def instants(self, times: Sequence[float]) -> tuple[list[Instant], Breakdown | None]:
        measures = np.empty((len(times), MEASURES))
        seen, ended = self._follow(np.array(times), measures)
        return [instant(times[i], measures[i]) for i in range(seen)], ended

    def _follow(self, times: np.ndarray, measures: np.ndarray) -> tuple[int, Breakdown | None]:
        """Go on to each of ``times`` and measure the cell there, as far as its edge is simple."""
        self._measured = None
        control, counters = self._control, self._counters
        seen = 0
        while True:
            now = self.time
            end = self._conditions.next_break(now)
            if counters[drive.RESTARTING] and now < times[seen] and not self._restart():
                return seen, self._no_root(now)
            profile, ramping = self._next_parameters(now, end)
            done, code = follow(
                self._linked,
                without_code(self._around),
                times[seen:],
                end,
                self._tolerance,
                _STEPS_PER_CALL,
                self._allowed,
                self._min_nodes,
                self._max_nodes,
                control,
                counters,
                self._table,
                self._log_rate,
                profile,
                self._edge,
                ramping,
                self._mesh,
                self._matrix,
                self._work,
                self._state,
                self._trace,
                measures[seen:],
                self._tally[3:],
            )
            seen += done
            if code == drive.REACHED:
                time = float(times[seen - 1])
                if time >= control[drive.PREVIOUS_TIME]:
                    self._measured = Shape(time, self._state, self._trace, measures[seen - 1])
                return seen, None
            if code == drive.AT_BREAK:
                counters[drive.RESTARTING] = 1
            elif code == drive.CHECK_NODES:
                self._fit_grid()
            elif code in (drive.NO_ROOT, drive.STEP_TOO_SMALL, drive.UNRESOLVED):
                return seen, self._stuck(code)

    def instant(self, time: float) -> Instant:
        return instant(time, self._shape(time).measures)

    def frame(self, time: float) -> Frame:
        profile = self._parameters(time, self._nodes)
        shape = self._shape(time)
        if self._placed is not None and self._around is not None:
            self._placed.motion[:] = self._around.motion
        placed = without_code(self._placed)
        return frame(self._linked, placed, shape, self._log_rate, profile, self._nodes)

    def _shape(self, time: float) -> Shape:
        """Return the edge at ``time``, measured once."""
        if self._measured is not None and self._measured.time == time:
            return self._measured
        first, last = self._control[drive.PREVIOUS_TIME], self._control[drive.TIME]
        if not first <= time <= last:
            raise ValueError(f"t = {time} is not within the last step, from {first} to {last}")
        steps = (time - last) / self._control[drive.STEP]
        measures = np.empty(MEASURES)
        order, errors = self._counters[drive.ORDER], self._tally[3:]
        measure(steps, order, self._table, self._state, self._trace, measures, errors)
        self._measured = Shape(time, self._state, self._trace, measures)
        return self._measured

    def checkpoint(self) -> dict[str, np.ndarray]:
        saved = {
            "control": self._control.copy(),
            "counters": self._counters.copy(),
            "tally": self._tally.copy(),
            "differences": self._table[:DIFFERENCES].copy(),
            "log_rate": self._log_rate.copy(),
            "matrix": self._matrix.copy(),
        }
        if self._around is not None:
            saved["motion"] = self._around.motion.copy()
        return saved

    def restore(self, checkpoint: dict[str, np.ndarray]) -> None:
        self._hold(np.array(checkpoint["differences"], dtype=float))
        if self._around is not None and "motion" in checkpoint:
            self._around.motion[:] = checkpoint["motion"]
        self._control = np.array(checkpoint["control"], dtype=float)
        self._counters = np.array(checkpoint["counters"], dtype=np.int64)
        self._tally = np.array(checkpoint["tally"], dtype=float)
        self._log_rate = np.array(checkpoint["log_rate"], dtype=float)
        self._matrix = np.array(checkpoint["matrix"], dtype=float)

    @property
    def invariant_tolerance(self) -> float:
        """What is mended of closure and area in a few steps is far below the tolerance."""
        return self._rtol

    def options(self) -> dict[str, Any]:
        return {
            "nodes": self._nodes,
            "rtol": self._rtol,
            "max_nodes": self._max_nodes,
            "min_nodes": self._min_nodes,
        }

    def diagnostics(self) -> dict[str, float]:
        fewest, most, regrids, closure, area = (float(value) for value in self._tally)
        return {
            "steps": int(self._counters[drive.STEPS]),
            "rejected_steps": int(self._counters[drive.REJECTED]),
            "right_hand_sides": int(self._counters[drive.RATES]),
            "factorisations": int(self._counters[drive.FACTORINGS]),
            "fewest_nodes": int(fewest),
            "most_nodes": int(most),
            "regrids": int(regrids),
            "largest_closure_error": closure,
            "largest_area_error": area,
        }

    def _begin(self, start: CellState) -> None:
        curve = start.curve
        density = np.ones(curve.nodes)
        wobble = curve.theta - layout.winding(curve.nodes)
        waves = slopes(wobble, start.bound_fraction.copy(), density)
        allowed = resolution.allowance(self._allowed, 0.0, False)
        if resolution.missed_on(waves, curve.nodes) > 3.0 * allowed:
            raise InputError(
                f"the start is not resolved on {curve.nodes} nodes at rtol = {self._rtol:g}: "
                "use a smoother start or a larger rtol"
            )
        nodes = resolution.fewest_nodes(waves, allowed, self._min_nodes, self._max_nodes)
        if nodes > self._max_nodes:
            raise InputError(
                f"the start needs more than max_nodes = {self._max_nodes} at rtol = "
                f"{self._rtol:g}: {self._for_more_nodes()}, or use a smoother start"
            )
        differences = np.zeros((DIFFERENCES, layout.size(nodes)))
        differences[0] = layout.from_cell(start, nodes)
        self._hold(differences)
        project(self._table[0], nodes, self._work)
        self._log_rate = np.full(nodes, natural_logarithm(self._conditions.at(self.time).r_p))
        if not self._restart():
            raise InputError(
                "the start has no off-rate r >= 1 that balances the forces everywhere: "
                "use a smoother or less tense start"
            )

    def _hold(self, differences: np.ndarray) -> None:
        """Take up the differences of the state and make room for the work on them."""
        self._make_room(layout.nodes_of(differences))
        self._table[:DIFFERENCES] = differences

    def _make_room(self, nodes: int) -> None:
        """Make the arrays that work on so many nodes needs."""
        self._measured = None
        self._table = np.zeros((drive.TABLE_ROWS, layout.size(nodes)))
        self._log_rate = np.zeros(nodes)
        self._state, self._trace = room_for_shape(layout.size(nodes))
        self._work = np.zeros((WORK_ROWS, nodes + 2 * HALO))
        self._mesh = np.zeros((MESH_ROWS, nodes + 2 * HALO))
        self._matrix = np.zeros((MATRIX_ROWS, nodes))
        rows = len(self._conditions.laws.rows) + 1
        self._edge = np.zeros((rows, nodes))
        self._around = around(self._compiled_surroundings, rows, nodes, self._around)
        self._control[drive.FACTORED] = 0.0
        self._tally[0] = min(self._tally[0] or nodes, nodes)
        self._tally[1] = max(self._tally[1], nodes)

    @functools.cached_property
    def _linked(self) -> Linked:
        found = linked(self._laws, self._around, self._placed)
        if self._around is None:
            ahead.wait()  # the kernels that take these are called next
        return found

    def _restart(self) -> bool:
        """Begin anew under the parameters that hold now; False if they allow no root."""
        return drive.restart(
            self._laws,
            self._around,
            self._tolerance,
            self._control,
            self._counters,
            self._table,
            self._log_rate,
            self._parameters(self.time),
            self._edge,
            self._mesh,
            self._work,
        )

    def _next_parameters(self, now: float, end: float) -> tuple[np.ndarray, bool]:
        """Parameters at the end of the next step, and whether they are moving."""
        if self._constant is not None or not self._conditions.varies(now, end):
            return self._parameters(now), False
        h = drive.bounded_step(self._control[drive.STEP], now, end)
        if h == end - now:
            return self._parameters(end, before=True), True
        return self._parameters(now + h), True

    def _parameters(
        self, time: float, places: int = _PLACES, *, before: bool = False
    ) -> np.ndarray:
        """Local parameters and G at equal arclengths, shape (rows, places).

        At one place where they are the same all along the edge.
        """
        if self._constant is not None:
            return self._constant
        if self._conditions.uniform:
            places = 1
        local = self._conditions.edge(time, places, before=before)
        rate = self._conditions.tension_rate(time, before=before)
        profile = np.vstack([local, np.full(places, rate)])
        if places == 1 and not self._conditions.schedule.breaks:
            self._constant = profile
        return profile

    def _fit_grid(self) -> None:
        """Go on with as many nodes as the spectrum asks for."""
        control, counters = self._control, self._counters
        table, log_rate = self._table, self._log_rate
        wanted = wanted_nodes(
            self._allowed, self._min_nodes, self._max_nodes, control, counters, table, log_rate.size
        )
        if wanted == log_rate.size:
            return
        self._make_room(wanted)
        self._tally[2] += 1
        move_to_nodes(
            self._laws,
            self._around,
            control,
            counters,
            table,
            log_rate,
            self._table,
            self._log_rate,
            self._parameters(self.time),
            self._edge,
            self._mesh,
            self._matrix,
            self._work,
        )

    def _no_root(self, time: float) -> Breakdown:
        return Breakdown(
            "out_of_range",
            time,
            f"no off-rate r >= 1 balances the forces after t = {time:.6g}: the edge is too concave "
            "for its tension, which the model does not cover",
        )

    def _for_more_nodes(self) -> str:
        """Return what would do where the nodes are too few: 4096 cannot be raised."""
        return "raise " + (
            "rtol" if self._max_nodes == resolution.NODE_COUNTS[-1] else "max_nodes or rtol"
        )

    def _stuck(self, code: int) -> Breakdown:
        if code == drive.NO_ROOT:
            return self._no_root(self.time)
        if code == drive.UNRESOLVED:
            return Breakdown(
                "unresolved",
                self.time,
                f"the edge at t = {self.time:.6g} needs more than max_nodes = {self._max_nodes} "
                f"at rtol = {self._rtol:g}: {self._for_more_nodes()}",
            )
        return Breakdown(
            "step_too_small",
            self.time,
            f"the step has shrunk to {drive.SHORTEST_STEP:g} at t = {self.time:.6g} and misses "
            f"rtol = {self._rtol:g}: raise rtol",
        )


def _grid_tolerance(rtol: float) -> float:
    """Part of slopes of size 1 that the nodes may miss on average for an error of ``rtol``."""
    return float(max(3.0 * rtol * min(1.0, (1e-4 / rtol) ** 0.3), 1e-9))


def _local_tolerance(rtol: float) -> float:
    """Local error that leaves an error of a few ``rtol`` at t = 100 (measured)."""
    return 0.002 * rtol
