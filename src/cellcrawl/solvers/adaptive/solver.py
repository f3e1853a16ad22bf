"""The adaptive solver: the user gives a tolerance, it chooses nodes and steps."""

from __future__ import annotations

import math
from typing import Any, ClassVar

import numpy as np

from cellcrawl.errors import InputError
from cellcrawl.solvers.adaptive import drive, resolution
from cellcrawl.solvers.adaptive import state as layout
from cellcrawl.solvers.adaptive.differences import DIFFERENCES
from cellcrawl.solvers.adaptive.frame import Shape, frame, instant, shape_between
from cellcrawl.solvers.adaptive.mesh import MESH_ROWS, edge_on_mesh, hold, lay_out
from cellcrawl.solvers.adaptive.newton import MATRIX_ROWS
from cellcrawl.solvers.adaptive.place import Around, around
from cellcrawl.solvers.adaptive.projection import project
from cellcrawl.solvers.adaptive.rates import WORK_ROWS, rates, renew_rates
from cellcrawl.solvers.adaptive.staggered import HALO
from cellcrawl.solvers.adaptive.step_error import relative_size
from cellcrawl.solvers.base import Breakdown, Frame, Instant, Solver
from cellcrawl.solvers.conditions import Conditions
from cellcrawl.starts.base import CellState
from cellcrawl.surroundings import place
from cellcrawl.validation import real_number, whole_number

_STEPS_PER_CALL = 5000  # between two looks at Ctrl-C
_START_NODES = 1024
_USUAL_RTOL = 1e-4
_TIGHT_RTOL = 1e-5  # below it a start is sampled more finely
_FIRST_STEP = 0.2  # times the root of the tolerance, relative to the rate of change
_SHORT = 1e-3  # a step at which the density of the nodes relaxes at its full rate
_PLACES = 1024  # at which parameters that vary along the edge are read


class AdaptiveSolver(Solver):
    """Tenth order in space on a staggered grid, backward differentiation of order 1 to 5 in time.

    ``rtol`` is the error asked of length, tension and area (relative) and of position (over the
    radius) after a few units of time. The node count follows the state's spectrum.
    """

    name: ClassVar[str] = "adaptive"
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
        self._placed = place.around(
            self._compiled_surroundings, len(conditions.laws.rows), self._nodes
        )
        self._around: Around | None = None
        self._rtol = real_number("rtol", rtol, 1e-10, 1e-2)
        counts = resolution.NODE_COUNTS
        self._max_nodes = whole_number("max_nodes", max_nodes, counts[0], counts[-1])
        self._min_nodes = whole_number("min_nodes", min_nodes, counts[0], self._max_nodes)
        self._control = np.zeros(drive.CONTROLS)
        self._counters = np.zeros(drive.COUNTERS, np.int64)
        self._tally = np.zeros(5)  # fewest nodes, most nodes, regrids, largest errors mended
        self._control[drive.TIME] = self._control[drive.PREVIOUS_TIME] = time
        self._measured: tuple[float, Shape] | None = None
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
        self._measured = None
        while self.time < target:
            now = self.time
            end = self._conditions.next_break(now)
            if self._counters[drive.RESTARTING] and not self._restart():
                return self._no_root(now)
            code = drive.run(
                self._laws,
                self._around,
                target,
                end,
                _local_tolerance(self._rtol),
                _STEPS_PER_CALL,
                _grid_tolerance(self._rtol),
                (self._min_nodes, self._max_nodes),
                self._control,
                self._counters,
                self._table,
                self._log_rate,
                *self._edge(now, end),
                self._mesh,
                self._matrix,
                self._work,
            )
            if code == drive.AT_BREAK:
                self._counters[drive.RESTARTING] = 1
            elif code == drive.CHECK_NODES:
                self._fit_grid()
            elif code in (drive.NO_ROOT, drive.STEP_TOO_SMALL, drive.UNRESOLVED):
                return self._stuck(code)
        return None

    def instant(self, time: float) -> Instant:
        return instant(time, self._shape(time))

    def frame(self, time: float) -> Frame:
        edge = self._conditions.edge(time, self._nodes)
        if self._placed is not None and self._around is not None:
            self._placed.motion[:] = self._around.motion
        return frame(self._laws, self._placed, time, self._shape(time), self._log_rate, edge)

    def _shape(self, time: float) -> Shape:
        """Return the edge at ``time``, measured once."""
        if self._measured is not None and self._measured[0] == time:
            return self._measured[1]
        first, last = self._control[drive.PREVIOUS_TIME], self.time
        if not first <= time <= last:
            raise ValueError(f"t = {time} is not within the last step, from {first} to {last}")
        steps = (time - last) / self._control[drive.STEP]
        shape = shape_between(steps, int(self._counters[drive.ORDER]), self._table)
        self._tally[3] = max(self._tally[3], shape.closure_error)
        self._tally[4] = max(self._tally[4], shape.area_error)
        self._measured = (time, shape)
        return shape

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
        waves = resolution.spectrum(curve.theta - layout.winding(curve.nodes), start.bound_fraction)
        allowed = resolution.allowance(_grid_tolerance(self._rtol), 0.0, formed=False)
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
        self._log_rate = np.full(nodes, math.log(self._conditions.at(self.time).r_p))
        if not self._restart():
            raise InputError(
                "the start has no off-rate r >= 1 that balances the forces everywhere: "
                "use a smoother or less tense start"
            )

    def _hold(self, differences: np.ndarray) -> None:
        """Take up the differences of the state and make room for the work on them."""
        self._measured = None
        nodes = layout.nodes_of(differences)
        self._table = np.zeros((drive.TABLE_ROWS, layout.size(nodes)))
        self._table[:DIFFERENCES] = differences
        self._work = np.zeros((WORK_ROWS, nodes + 2 * HALO))
        self._mesh = np.zeros((MESH_ROWS, nodes + 2 * HALO))
        self._matrix = np.zeros((MATRIX_ROWS, nodes))
        rows = len(self._conditions.laws.rows) + 1
        self._around = around(self._compiled_surroundings, rows, nodes, self._around)
        self._control[drive.FACTORED] = 0.0
        self._edges: tuple[float, np.ndarray, np.ndarray] | None = None
        self._tally[0] = min(self._tally[0] or nodes, nodes)
        self._tally[1] = max(self._tally[1], nodes)

    def _restart(self) -> bool:
        """Take the rates under the parameters that hold now, and begin with a short step."""
        table, control, counters = self._table, self._control, self._counters
        nodes = layout.nodes_of(table)
        edge = self._midpoints(self.time)
        lay_out(*layout.fields(table[0]), _SHORT, 1, self._mesh, nodes)
        renew_rates(self._laws, self._log_rate, edge, self._work)
        table[1:] = 0.0
        counters[drive.RATES] += 1
        if not rates(
            self._laws,
            self._around,
            self.time,
            table[0],
            table[1],
            self._log_rate,
            edge,
            self._mesh,
            self._work,
        ):
            return False
        _, control[drive.CONTRAST] = resolution.missed(table[0], nodes, self._work)
        control[drive.FORMATION] = resolution.formation(layout.fields(table[0])[1], nodes)
        pace = relative_size(table[1], table[0], nodes, 1.0)
        control[drive.STEP] = _FIRST_STEP * math.sqrt(_local_tolerance(self._rtol)) / (1.0 + pace)
        table[1] *= control[drive.STEP]
        control[drive.CONTRACTION] = drive.UNKNOWN_CONTRACTION
        control[drive.FACTORED] = 0.0
        counters[drive.ORDER] = 1
        counters[drive.EQUAL_STEPS] = counters[drive.RESTARTING] = 0
        return True

    def _edge(self, now: float, end: float) -> tuple[np.ndarray, np.ndarray, bool]:
        """Parameters at the end of the next step, and whether they are moving.

        As a profile over equal arclengths and at the midpoints; the former has one place where
        they are the same all along the edge, and the latter is then complete.
        """
        if not self._conditions.varies(now, end):
            if self._edges is None or self._edges[0] != end:
                self._edges = (end, *self._parameters(now))
            return *self._edges[1:], False
        h = drive.bounded_step(self._control[drive.STEP], now, end)
        if h == end - now:
            return *self._parameters(end, before=True), True
        return *self._parameters(now + h), True

    def _parameters(self, time: float, *, before: bool = False) -> tuple[np.ndarray, np.ndarray]:
        """Local parameters and G as `_edge` returns them, (rows, places) and (rows, nodes)."""
        places = 1 if self._conditions.uniform else _PLACES
        local = self._conditions.edge(time, places, before=before)
        rate = self._conditions.tension_rate(time, before=before)
        profile = np.vstack([local, np.full(places, rate)])
        return profile, np.repeat(profile[:, :1], layout.nodes_of(self._table), axis=1)

    def _midpoints(self, time: float) -> np.ndarray:
        """Local parameters at the midpoints as they are now and G, shape (rows, nodes)."""
        profile, edge = self._parameters(time)
        if profile.shape[1] > 1:
            _, _, density = layout.fields(self._table[0])
            hold(density, self._mesh, edge.shape[1])
            edge_on_mesh(profile, density, edge, self._work)
        return edge

    def _fit_grid(self) -> None:
        """Go on with as many nodes as the spectrum asks for."""
        nodes = layout.nodes_of(self._table)
        due = int(self._counters[drive.CHECK_DUE])
        self._counters[drive.CHECK_DUE] = drive.KEEP
        if due == drive.FINER:
            wanted = resolution.finer(nodes, self._max_nodes)
        elif due == drive.COARSER:
            wanted = resolution.coarser(nodes, self._min_nodes)
        else:
            wanted = self._fewest_nodes(nodes)
        if wanted != nodes:
            self._hold(layout.regridded(self._table[:DIFFERENCES], wanted))
            self._log_rate = layout.resampled_midpoints(self._log_rate, wanted)
            self._tally[2] += 1
            self._control[drive.MISSED] *= (nodes / wanted) ** 10
            self._control[drive.PEAK] *= (nodes / wanted) ** 5
            edge = self._midpoints(self.time)
            self._counters[drive.RATES] += 1
            drive.bend_history(
                self._laws,
                self._around,
                self._control,
                self._counters,
                self._table,
                self._log_rate,
                edge,
                self._mesh,
                self._matrix,
                self._work,
            )

    def _fewest_nodes(self, nodes: int) -> int:
        """Return as many nodes as the spectrum of the state asks for, ``nodes`` at most."""
        state, control = self._table[0], self._control
        allowed = resolution.allowance(
            _grid_tolerance(self._rtol), control[drive.CONTRAST], formed=False
        )
        waves = resolution.spectrum(layout.angle(state), layout.bound(state), layout.density(state))
        return resolution.fewest_nodes(
            waves, resolution.COARSEN * allowed, self._min_nodes, nodes - 1
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
