"""The adaptive solver: the user gives a tolerance, it chooses nodes and steps."""

from __future__ import annotations

import math
from typing import Any, ClassVar

import numpy as np

from cellcrawl.errors import InputError
from cellcrawl.parameters import EDGE_ROWS, Conditions
from cellcrawl.solvers.adaptive import chebyshev, resolution, stabilised
from cellcrawl.solvers.adaptive import drive as drive
from cellcrawl.solvers.adaptive import state as layout
from cellcrawl.solvers.adaptive.frame import Shape, frame, instant, shape_within_step
from cellcrawl.solvers.adaptive.rates import WORK_ROWS, rates, stiffness
from cellcrawl.solvers.adaptive.scheme import Scheme, fourth_order_scheme
from cellcrawl.solvers.adaptive.staggered import HALO
from cellcrawl.solvers.base import Breakdown, Frame, Instant, Solver
from cellcrawl.starts.base import CellState
from cellcrawl.validation import real_number, whole_number

_STEPS_PER_CALL = 5000  # between two looks at Ctrl-C
_START_NODES = 1024
_USUAL_RTOL = 1e-4
_TIGHT_RTOL = 1e-6  # below it a start is sampled more finely
_STIFF_TENSION = 0.5  # share of the tension in the fastest decay from which second order is better
_STIFF_TENSION_RTOL = 3e-6  # down to this tolerance
_SPATIAL_SHARE = 0.005  # of what the grid misses, in the error at t = 5


class AdaptiveSolver(Solver):
    """Tenth order in space on a staggered grid, error-controlled stabilised steps in time.

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
        self._nodes = self.checked_nodes(nodes)
        self._rtol = real_number("rtol", rtol, 1e-10, 1e-2)
        counts = resolution.NODE_COUNTS
        self._max_nodes = whole_number("max_nodes", max_nodes, counts[0], counts[-1])
        self._min_nodes = whole_number("min_nodes", min_nodes, counts[0], self._max_nodes)
        self._control = np.zeros(drive.CONTROLS)
        self._counters = np.zeros(drive.COUNTERS, np.int64)
        self._tally = np.zeros(4)  # fewest nodes, most nodes, regrids, largest closure error
        self._control[drive.TIME] = self._control[drive.PREVIOUS_TIME] = time
        self._edges: tuple[float, np.ndarray] | None = None
        self._measured: tuple[float, Shape] | None = None
        self._counters[drive.RESTARTING] = 1
        self._counters[drive.ORDER] = stabilised.ORDER
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
            if self._counters[drive.RESTARTING] and not self._restart(end):
                return self._no_root(now)
            code = drive.run(
                target,
                end,
                self._local_tolerance(),
                int(self._counters[drive.ORDER]),
                _STEPS_PER_CALL,
                _grid_tolerance(self._rtol),
                (self._min_nodes, self._max_nodes),
                self._control,
                self._counters,
                self._states,
                self._log_rate,
                self._rows(now, end),
                *self._scheme(),
                self._mixed,
                self._work,
            )
            if code == drive.AT_BREAK:
                self._counters[drive.RESTARTING] = 1
            elif code == drive.CHECK_NODES:
                breakdown = self._fit_grid()
                if breakdown is not None:
                    return breakdown
            elif code in (drive.NO_ROOT, drive.STEP_TOO_SMALL, drive.UNRESOLVED):
                return self._stuck(code)
        return None

    def instant(self, time: float) -> Instant:
        return instant(time, self._shape(time))

    def frame(self, time: float) -> Frame:
        edge = self._conditions.edge(time, self._nodes)
        return frame(time, self._shape(time), self._log_rate, edge)

    def _shape(self, time: float) -> Shape:
        """Return the edge at ``time``, measured once."""
        if self._measured is not None and self._measured[0] == time:
            return self._measured[1]
        first, last = self._control[drive.PREVIOUS_TIME], self.time
        if not first <= time <= last:
            raise ValueError(f"t = {time} is not within the last step, from {first} to {last}")
        part = (time - first) / (last - first) if time < last else 1.0
        shape = shape_within_step(part, last - first, self._states[drive.PREVIOUS : drive.TRIAL])
        self._tally[3] = max(self._tally[3], shape.closure_error)
        self._measured = (time, shape)
        return shape

    def checkpoint(self) -> dict[str, np.ndarray]:
        return {
            "control": self._control.copy(),
            "counters": self._counters.copy(),
            "tally": self._tally.copy(),
            "states": self._states[: drive.TRIAL].copy(),
            "log_rate": self._log_rate.copy(),
        }

    def restore(self, checkpoint: dict[str, np.ndarray]) -> None:
        self._control = np.array(checkpoint["control"], dtype=float)
        self._counters = np.array(checkpoint["counters"], dtype=np.int64)
        self._tally = np.array(checkpoint["tally"], dtype=float)
        self._hold(np.array(checkpoint["states"], dtype=float))
        self._log_rate = np.array(checkpoint["log_rate"], dtype=float)
        current = self._states[drive.CURRENT]
        stiffness(current, self._log_rate, self._midpoints(self.time), self._work)

    def options(self) -> dict[str, Any]:
        return {
            "nodes": self._nodes,
            "rtol": self._rtol,
            "max_nodes": self._max_nodes,
            "min_nodes": self._min_nodes,
        }

    def diagnostics(self) -> dict[str, float]:
        fewest, most, regrids, closure = (float(value) for value in self._tally)
        return {
            "steps": int(self._counters[drive.STEPS]),
            "rejected_steps": int(self._counters[drive.REJECTED]),
            "right_hand_sides": int(self._counters[drive.RATES]),
            "fewest_nodes": int(fewest),
            "most_nodes": int(most),
            "regrids": int(regrids),
            "largest_closure_error": closure,
            "error_estimate": float(
                self._control[drive.LOCAL_ERRORS]
                + _SPATIAL_SHARE * self._control[drive.MOST_MISSED]
            ),
        }

    def _begin(self, start: CellState) -> None:
        curve = start.curve
        waves = resolution.spectrum(curve.theta - layout.winding(curve.nodes), start.bound_fraction)
        allowed = resolution.LEAST_ALLOWANCE * _grid_tolerance(self._rtol)
        if resolution.missed_on(waves, curve.nodes) > 3.0 * allowed:
            raise InputError(
                f"the start is not resolved on {curve.nodes} nodes at rtol = {self._rtol:g}: "
                "use a smoother start or a larger rtol"
            )
        nodes = resolution.fewest_nodes(waves, allowed, self._min_nodes, self._max_nodes)
        if nodes > self._max_nodes:
            raise InputError(
                f"the start needs more than max_nodes = {self._max_nodes} at rtol = "
                f"{self._rtol:g}: raise max_nodes or rtol, or use a smoother start"
            )
        self._hold(np.tile(layout.from_cell(start, nodes), (drive.TRIAL, 1)))
        self._log_rate = np.full(nodes, math.log(self._conditions.at(self.time).r_p))
        if not self._restart(self._conditions.next_break(self.time)):
            raise InputError(
                "the start has no off-rate r >= 1 that balances the forces everywhere: "
                "use a smoother or less tense start"
            )

    def _hold(self, states: np.ndarray) -> None:
        """Take up states PREVIOUS to CURRENT_RATES and make room for the work on them."""
        self._measured = None
        nodes = layout.nodes_of(states)
        self._states = np.zeros((stabilised.STATE_ROWS, layout.size(nodes)))
        self._states[: drive.TRIAL] = states
        self._work = np.zeros((WORK_ROWS, nodes + 2 * HALO))
        self._mixed = np.zeros((len(EDGE_ROWS) + 1, nodes))
        self._edges = None
        self._tally[0] = min(self._tally[0] or nodes, nodes)
        self._tally[1] = max(self._tally[1], nodes)

    def _restart(self, end: float) -> bool:
        """Take the rates under the parameters that hold now, and begin with a short step."""
        if not self._take_rates():
            return False
        control = self._control
        control[drive.STEP] = 1.0 / control[drive.RADIUS]
        control[drive.LAST_ERROR] = 1.0
        _, control[drive.CONTRAST] = resolution.missed(
            self._states[drive.CURRENT], layout.nodes_of(self._states), self._work
        )
        control[drive.FORMATION] = resolution.formation(
            layout.bound_with_halo(self._states[drive.CURRENT]), layout.nodes_of(self._states)
        )
        self._counters[drive.RESTARTING] = 0
        return True

    def _take_rates(self) -> bool:
        edge = self._midpoints(self.time)
        current, trial = self._states[drive.CURRENT], self._states[drive.TRIAL]
        self._counters[drive.RATES] += 1
        stiffness(current, self._log_rate, edge, self._work)
        if not rates(current, trial, self._log_rate, edge, self._work):
            return False
        self._states[drive.CURRENT_RATES] = trial
        self._control[drive.RADIUS], self._control[drive.TENSION_DECAY] = stiffness(
            current, self._log_rate, edge, self._work
        )
        self._choose_order()
        return True

    def _rows(self, now: float, end: float) -> np.ndarray:
        """Parameters at the midpoints: once where they hold still, else over the next step."""
        if not self._conditions.varies(now, end):
            if self._edges is None or self._edges[0] != end:
                self._edges = (end, self._midpoints(now)[None])
            return self._edges[1]
        control = self._control
        h = drive.bounded_step(
            control[drive.STEP], now, end, control[drive.RADIUS], self._scheme().limits
        )
        times = [now, now + h / 3.0, now + 2.0 * h / 3.0, now + h]
        if h == end - now:
            times[-1] = math.nextafter(end, -math.inf)  # a jump at the end has not happened yet
        return np.stack([self._midpoints(time) for time in times])

    def _midpoints(self, time: float) -> np.ndarray:
        """Local parameters at the midpoints and G, shape (8, nodes)."""
        nodes = layout.nodes_of(self._states)
        local = self._conditions.edge(time, 2 * nodes)[:, 1::2]
        return np.vstack([local, np.full(nodes, self._conditions.tension_rate(time))])

    def _scheme(self) -> Scheme:
        if self._counters[drive.ORDER] == chebyshev.ORDER:
            return chebyshev.chebyshev_scheme()
        return fourth_order_scheme()

    def _choose_order(self) -> None:
        """Second order where the tension is the stiffest and the tolerance loose, else fourth."""
        tension, radius = self._control[drive.TENSION_DECAY], self._control[drive.RADIUS]
        stiff = tension > _STIFF_TENSION * radius and self._rtol >= _STIFF_TENSION_RTOL
        self._counters[drive.ORDER] = chebyshev.ORDER if stiff else stabilised.ORDER

    def _local_tolerance(self) -> float:
        """Local error that leaves a global error of about ``rtol`` at t = 5 (measured)."""
        if self._counters[drive.ORDER] == chebyshev.ORDER:
            return float((10.0 * self._rtol) ** 1.5)
        return float(10.0 * self._rtol * (self._rtol / 1e-4) ** 0.15)

    def _fit_grid(self) -> Breakdown | None:
        """Go on with as many nodes as the spectrum asks for."""
        state = self._states[drive.CURRENT]
        nodes = layout.nodes_of(state)
        allowed = resolution.allowance(_grid_tolerance(self._rtol), self._control[drive.CONTRAST])
        waves = resolution.spectrum(layout.angle(state), layout.bound(state))
        self._counters[drive.CHECK_DUE] = 0
        wanted = resolution.wanted_nodes(waves, nodes, allowed, self._min_nodes, self._max_nodes)
        wanted = min(wanted, self._max_nodes)
        if wanted != nodes:
            self._hold(layout.regridded(self._states[: drive.TRIAL], wanted))
            self._log_rate = layout.resampled_midpoints(self._log_rate, wanted)
            self._tally[2] += 1
            if not self._take_rates():
                return self._no_root(self.time)
        return None

    def _no_root(self, time: float) -> Breakdown:
        return Breakdown(
            "out_of_range",
            time,
            f"no off-rate r >= 1 balances the forces after t = {time:.6g}: the edge is too concave "
            "for its tension, which the model does not cover",
        )

    def _stuck(self, code: int) -> Breakdown:
        if code == drive.NO_ROOT:
            return self._no_root(self.time)
        if code == drive.UNRESOLVED:
            return Breakdown(
                "unresolved",
                self.time,
                f"the edge at t = {self.time:.6g} needs more than max_nodes = {self._max_nodes} "
                f"at rtol = {self._rtol:g}: raise max_nodes or rtol",
            )
        return Breakdown(
            "step_too_small",
            self.time,
            f"the step has shrunk to {drive.SHORTEST_STEP:g} at t = {self.time:.6g} and misses "
            f"rtol = {self._rtol:g}: raise rtol",
        )


def _grid_tolerance(rtol: float) -> float:
    """Part of slopes of size 1 that a grid may miss for an error of ``rtol`` (measured)."""
    return float(0.32 * (28.6 * rtol) ** 0.625)
