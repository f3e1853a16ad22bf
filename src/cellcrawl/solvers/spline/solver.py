"""The independent check scheme: markers that move along the normal, on a periodic cubic spline."""

from __future__ import annotations

import math
from typing import Any, ClassVar

import numpy as np

from cellcrawl.errors import InputError
from cellcrawl.solvers.base import Breakdown, Frame, Solver
from cellcrawl.solvers.conditions import Conditions
from cellcrawl.solvers.fixed_steps import slack, steps_towards
from cellcrawl.solvers.spline import balance, drive, frames, outline
from cellcrawl.solvers.spline.outline import LOG_R, N, X, Y
from cellcrawl.solvers.spline.runge_kutta import STAGES
from cellcrawl.starts.base import CellState
from cellcrawl.surroundings.place import around
from cellcrawl.validation import real_number, whole_number

_USUAL_NODES = 512
_USUAL_STEP = 2e-3
_KEPT = 1e-4  # the area is kept to rounding at the steps; between two it is interpolated
_STEPS_PER_CALL = 1000  # between two looks at Ctrl-C


class SplineSolver(Solver):
    """Markers on a periodic cubic spline: fourth order in space, third in time.

    Shares no geometry with the solvers that follow the tangent angle, and has no tangential
    velocity to get wrong: a marker is a material point, so that its bound fraction needs no
    transport term. It is there to check the others.
    """

    name: ClassVar[str] = "spline"
    OPTIONS: ClassVar[dict[str, str]] = {
        "nodes": f"markers on the edge, 32 to 10000 (default {_USUAL_NODES})",
        "dt": f"time step, up to 0.1 (default {_USUAL_STEP:g}); split where stability needs it",
    }

    def __init__(
        self,
        start: CellState | None,
        conditions: Conditions,
        time: float = 0.0,
        *,
        nodes: int = _USUAL_NODES,
        dt: float = _USUAL_STEP,
    ) -> None:
        self._conditions = conditions
        self._laws = conditions.laws.compiled
        self._around = around(conditions.around(), len(conditions.laws.rows), nodes)
        self._world = frames.World(conditions.laws, self._around)
        self._nodes = self.checked_nodes(nodes)
        self._dt = real_number("dt", dt, 1e-7, 0.1)
        self._anchor = time  # steps are counted from here: the start, or the last break
        self._steps_from_anchor = 0
        self.time = time
        self._slopes = np.empty((STAGES, 4, nodes))
        self._work = np.empty((drive.WORK_ROWS, nodes))
        self._fields = np.zeros((4, nodes))
        self._scalars = np.zeros(drive.SCALARS)
        self._counters = np.zeros(5, np.int64)
        self._before_fields = np.zeros((4, nodes))  # at the beginning of the last step
        self._before_scalars = np.zeros(drive.SCALARS)
        self._before_time = math.nan
        if start is not None:
            self._begin(start)

    @classmethod
    def checked_nodes(cls, nodes: Any) -> int:
        return _USUAL_NODES if nodes is None else whole_number("nodes", nodes, 32, 10_000)

    @classmethod
    def start_nodes(cls, nodes: int, **options: Any) -> int:
        return nodes

    def advance(self, target: float) -> Breakdown | None:
        while self.time < target - slack(target, self._dt):
            now = self.time
            end = self._conditions.next_break(now)
            if self._step_time(self._steps_from_anchor + 1) >= end - slack(end, self._dt):
                breakdown = self._take(1, end - now, end)
                if breakdown is None:
                    breakdown = self._land(end)
            elif self._conditions.varies(now, end):
                breakdown = self._take(1, self._dt, self._step_time(self._steps_from_anchor + 1))
            else:
                steps = steps_towards(
                    min(target, end), end, self._anchor, self._steps_from_anchor, self._dt
                )
                steps = min(steps, _STEPS_PER_CALL)
                until = self._step_time(self._steps_from_anchor + steps)
                breakdown = self._take(steps, self._dt, until)
            if breakdown is not None:
                return breakdown
        return None

    def frame(self, time: float) -> Frame:
        return frames.frame(self._world, self._at(time), self._conditions.edge(time, self._nodes))

    def points(self, time: float) -> np.ndarray:
        even = frames.on_even_nodes(self._at(time).fields)
        return np.column_stack([even[X], even[Y]])

    def checkpoint(self) -> dict[str, np.ndarray]:
        saved = {
            "clock": np.array([self.time, self._anchor, self._before_time]),
            "counters": np.append(self._counters, self._steps_from_anchor),
            "fields": self._fields.copy(),
            "scalars": self._scalars.copy(),
            "before_fields": self._before_fields.copy(),
            "before_scalars": self._before_scalars.copy(),
        }
        if self._around is not None:
            saved["motion"] = self._around.motion.copy()
        return saved

    def restore(self, checkpoint: dict[str, np.ndarray]) -> None:
        self.time, self._anchor, self._before_time = (float(t) for t in checkpoint["clock"])
        *counters, self._steps_from_anchor = (int(count) for count in checkpoint["counters"])
        self._counters = np.array(counters, np.int64)
        self._fields = np.array(checkpoint["fields"], dtype=float)
        self._scalars = np.array(checkpoint["scalars"], dtype=float)
        self._before_fields = np.array(checkpoint["before_fields"], dtype=float)
        self._before_scalars = np.array(checkpoint["before_scalars"], dtype=float)
        if self._around is not None and "motion" in checkpoint:
            self._around.motion[:] = checkpoint["motion"]
        if self._scalars.size == drive.AREA:  # saved by 0.1.0, whose tension went with any area
            area = outline.area(self._fields, frames.measured(self._fields))
            self._scalars = np.append(self._scalars, area)
            self._before_scalars = np.append(self._before_scalars, area)

    @property
    def invariant_tolerance(self) -> float:
        return _KEPT

    def options(self) -> dict[str, Any]:
        return {"nodes": self._nodes, "dt": self._dt}

    def diagnostics(self) -> dict[str, float]:
        counters = self._counters
        return {
            "steps": int(counters[drive.STEPS]),
            "rejected_steps": int(counters[drive.RETRIES]),
            "right_hand_sides": STAGES * int(counters[drive.PARTS]),
            "largest_closure_error": 0.0,  # a periodic spline is closed
            "remeshings": int(counters[drive.REMESHINGS]),
            "most_parts_of_a_step": int(counters[drive.MOST_PARTS]),
        }

    def _begin(self, start: CellState) -> None:
        fields = self._fields
        fields[X], fields[Y] = start.curve.points.T
        fields[N] = start.bound_fraction
        fields[LOG_R] = math.log(self._conditions.at(self.time).r_p)
        shape = frames.measured(fields)
        self._scalars[:] = (start.tension, start.curve.theta[0], outline.area(fields, shape))
        edge = self._conditions.edge(self.time, self._nodes)
        turn, marker = outline.sharpest_turn(shape)
        if turn > drive.LARGEST_TURN:
            raise InputError(
                f"{self._nodes} nodes are too few for this start: its edge turns by {turn:.2g} "
                f"radians from node to node at node {marker}; give more nodes"
            )
        code, marker, _ = self._world.balance(self.time, fields, start.tension, shape, edge)
        if code != balance.BALANCED:
            raise InputError(
                f"the start has no off-rate r >= 1 that balances the forces at node {marker} "
                f"(curvature {shape[outline.KAPPA, marker]:.4g}, tension {start.tension:.4g}): "
                "use a smoother or less tense start"
            )

    def _take(self, steps: int, dt: float, end: float) -> Breakdown | None:
        """Take ``steps`` steps of ``dt``, the last of which ends at ``end``."""
        now, conditions = self.time, self._conditions
        varies = conditions.varies(now, end)
        first = conditions.edge(now, self._nodes)
        last = conditions.edge(end, self._nodes, before=True) if varies else first
        rates = np.full(2, conditions.tension_rate(now))
        if varies:
            rates[1] = conditions.tension_rate(end, before=True)
        code, marker, taken = drive.advance(
            self._laws,
            self._around,
            now,
            steps,
            dt,
            varies,
            np.stack([first, last]),
            rates,
            self._fields,
            self._scalars,
            self._counters,
            self._before_fields,
            self._before_scalars,
            self._slopes,
            self._work,
        )
        self._steps_from_anchor += taken
        if code == drive.STEPPED:
            self._before_time = self._step_time(self._steps_from_anchor - 1)
            self.time = end
            return None
        self.time = self._step_time(self._steps_from_anchor)
        self._before_time = math.nan
        return self._breakdown(code, marker, dt)

    def _land(self, end: float) -> Breakdown | None:
        """Count steps from a break of the schedule, with the off-rate of what holds from then."""
        self._anchor, self._steps_from_anchor, self.time = end, 0, end
        fields = self._fields
        shape = frames.measured(fields)
        kept = fields[LOG_R].copy()
        edge = self._conditions.edge(end, self._nodes)
        tension = float(self._scalars[drive.TENSION])
        code, marker, _ = self._world.balance(end, fields, tension, shape, edge)
        if code == balance.BALANCED:
            return None
        fields[LOG_R] = kept
        return self._breakdown(code, marker, 0.0)

    def _at(self, time: float) -> frames.State:
        """Return the state at a time in the last step."""
        tension, angle, _ = map(float, self._scalars)
        last = frames.State(self.time, self._fields, tension, angle)
        if abs(time - self.time) <= slack(time, self._dt):
            return last._replace(time=time)
        if not self._before_time <= time <= self.time:
            raise ValueError(f"t = {time} is not within the last step, which ends at {self.time}")
        tension, angle, _ = map(float, self._before_scalars)
        first = frames.State(self._before_time, self._before_fields, tension, angle)
        conditions, nodes = self._conditions, self._nodes
        first_rates = frames.rates_of_change(
            self._world,
            first,
            conditions.edge(first.time, nodes),
            conditions.tension_rate(first.time),
        )
        last_rates = frames.rates_of_change(
            self._world,
            last,
            conditions.edge(last.time, nodes, before=True),
            conditions.tension_rate(last.time, before=True),
        )
        return frames.inside_step(time, first, first_rates, last, last_rates)

    def _breakdown(self, code: int, marker: int, dt: float) -> Breakdown:
        time = self.time + dt
        place = f"at t = {time:.6g}, s/L = {self._place(marker):.4f}"
        if code == balance.NO_ROOT:
            return Breakdown(
                "out_of_range",
                time,
                f"no off-rate r >= 1 balances the forces {place}: the edge is too concave for its "
                "tension, which the model does not cover",
            )
        if code == drive.UNRESOLVED:
            return Breakdown(
                "unresolved",
                time,
                f"the edge turns by more than {drive.LARGEST_TURN:g} radians from marker to marker "
                f"{place}: more than {self._nodes} nodes are needed",
            )
        if code == balance.NEGATIVE:
            return Breakdown(
                "unresolved",
                time,
                f"the bound fraction is negative {place}: a smaller dt than {self._dt:g} or more "
                f"than {self._nodes} nodes are needed",
            )
        if code == drive.TOO_STIFF:
            return Breakdown(
                "step_too_small",
                time,
                f"the curvature is smoothed so fast at t = {time:.6g} that a step of {self._dt:g} "
                f"would take more than {drive.LARGEST_PARTS} parts: use fewer nodes than "
                f"{self._nodes}",
            )
        if code == balance.UNSETTLED:
            return Breakdown(
                "step_too_small",
                time,
                f"no tension goes with the off-rates {place}: a smaller dt may go further",
            )
        return Breakdown("not_finite", time, f"the state is no longer finite {place}")

    def _place(self, marker: int) -> float:
        """Arclength of a marker from the first, over the length."""
        segment = frames.measured(self._fields)[outline.SEGMENT]
        return float(segment[:marker].sum() / segment.sum())

    def _step_time(self, count: int) -> float:
        return self._anchor + count * self._dt
