"""The paper's scheme: explicit Euler for shape and tension, Crank-Nicolson for the linkers."""

from __future__ import annotations

import math
from typing import Any, ClassVar

import numpy as np

from cellcrawl.errors import InputError
from cellcrawl.laws.force_balance import SOLVED
from cellcrawl.linear import fastest_decay
from cellcrawl.solvers.base import (
    Breakdown,
    Frame,
    Solver,
    pointwise,
)
from cellcrawl.solvers.conditions import Conditions
from cellcrawl.solvers.fixed_steps import slack, steps_towards
from cellcrawl.solvers.paper import step as paper_step
from cellcrawl.solvers.paper import tangent_angle
from cellcrawl.starts.base import CellState
from cellcrawl.surroundings.place import Around, around, balance_in_place, surround_edge
from cellcrawl.validation import real_number, whole_number

_KEPT = 1e-4  # both are kept to rounding at the steps; between two they are interpolated
_STABLE = 2.0  # explicit Euler decays while step * rate < 2


_Points = tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray, np.ndarray]


class PaperSolver(Solver):
    """The scheme of Chen, Saintillan & Rangamani (2023), with the transport term ``T n_s``.

    First order in time, second in space. ``elasticity="consistent"`` adds a tension mode that
    decays so fast that the published step of 1e-3 is unstable; such a step is refused with one that
    works.
    """

    name: ClassVar[str] = "paper"
    OPTIONS: ClassVar[dict[str, str]] = {
        "nodes": "nodes on the edge, 16 to 100000 (default 2000)",
        "dt": "time step (default 1e-3, or less where the tension needs it)",
    }

    def __init__(
        self,
        start: CellState | None,
        conditions: Conditions,
        time: float = 0.0,
        *,
        nodes: int = 2000,
        dt: float | None = None,
    ) -> None:
        self._conditions = conditions
        self._laws = conditions.laws.compiled
        self._surroundings = conditions.around()
        self._around = around(self._surroundings, len(conditions.laws.rows), nodes)
        self._nodes = nodes
        self._dt = _checked_step(dt, nodes, conditions)
        self._anchor = time  # steps are counted from here: the start, or the last break
        self._steps_from_anchor = 0
        self._steps = 0
        self.time = time
        self._work = np.empty((paper_step.WORK_ROWS, nodes))
        self._fields = np.zeros((3, nodes))  # theta, n, log r
        self._scalars = np.zeros(6)
        self._previous: tuple[float, np.ndarray, np.ndarray] | None = None
        if start is not None:
            self._begin(start)

    @classmethod
    def checked_nodes(cls, nodes: Any) -> int:
        return 2000 if nodes is None else whole_number("nodes", nodes, 16, 100_000)

    @classmethod
    def start_nodes(cls, nodes: int, **options: Any) -> int:
        return nodes

    def advance(self, target: float) -> Breakdown | None:
        while self.time < target - slack(target, self._dt):
            now = self.time
            end = self._conditions.next_break(now)
            if self._step_time(self._steps_from_anchor + 1) >= end - slack(end, self._dt):
                breakdown = self._take(1, end - now)
                landed: float | None = end
            else:
                steps = steps_towards(
                    min(target, end), end, self._anchor, self._steps_from_anchor, self._dt
                )
                if self._conditions.varies(now, end):
                    steps = 1
                breakdown = self._take(steps, self._dt)
                landed = None
            if breakdown is not None:
                return breakdown
            if landed is not None:
                self._anchor, self._steps_from_anchor, self.time = landed, 0, landed
        return None

    def frame(self, time: float) -> Frame:
        fields, scalars = self._fields, self._scalars
        edge = self._conditions.edge(time, self._nodes)
        if abs(time - self.time) > slack(time, self._dt):
            fields, scalars, edge = self._between(time, edge)
        elif (room := self._room()) is not None:
            surround_edge(room, time, *self._edge_of(fields, scalars), edge)
            edge = room.local
        theta, n, y = fields.copy()
        length = float(scalars[paper_step.LENGTH])
        kappa, cosine, sine = np.empty_like(theta), np.cos(theta), np.sin(theta)
        x, z = np.empty_like(theta), np.empty_like(theta)
        tangent_angle.curvature(theta, length, kappa)
        gap = tangent_angle.points(length, cosine, sine, kappa, x, z)
        area = float(scalars[paper_step.AREA])
        center = tangent_angle.centroid(length, area, cosine, sine, x, z)
        origin_x = float(scalars[paper_step.ORIGIN_X])
        origin_y = float(scalars[paper_step.ORIGIN_Y])
        laws, tension = self._conditions.laws, float(scalars[paper_step.TENSION])
        off_rate, velocity, friction = pointwise(laws, y, n, tension, kappa, edge)
        return Frame(
            time=time,
            x=x + origin_x,
            y=z + origin_y,
            theta=theta,
            curvature=kappa,
            bound_fraction=n,
            off_rate=off_rate,
            normal_velocity=velocity,
            friction=friction,
            tension=tension,
            length=length,
            area=area,
            centroid_x=center[0] + origin_x,
            centroid_y=center[1] + origin_y,
            closure_gap=gap,
        )

    def checkpoint(self) -> dict[str, np.ndarray]:
        saved = {
            "clock": np.array([self.time, self._anchor]),
            "counters": np.array([self._steps_from_anchor, self._steps]),
            "fields": self._fields.copy(),
            "scalars": self._scalars.copy(),
        }
        if self._previous is not None:
            time, fields, scalars = self._previous
            saved["previous_fields"] = fields
            saved["previous_scalars"] = np.append(scalars, time)
        if self._around is not None:
            saved["motion"] = self._around.motion.copy()
        return saved

    def restore(self, checkpoint: dict[str, np.ndarray]) -> None:
        self.time, self._anchor = (float(value) for value in checkpoint["clock"])
        self._steps_from_anchor, self._steps = (int(value) for value in checkpoint["counters"])
        self._fields = np.array(checkpoint["fields"], dtype=float)
        self._scalars = np.array(checkpoint["scalars"], dtype=float)
        if self._around is not None and "motion" in checkpoint:
            self._around.motion[:] = checkpoint["motion"]
        self._previous = None
        if "previous_fields" in checkpoint:
            scalars = np.array(checkpoint["previous_scalars"], dtype=float)
            fields = np.array(checkpoint["previous_fields"], dtype=float)
            self._previous = (float(scalars[-1]), fields, scalars[:-1])

    @property
    def invariant_tolerance(self) -> float:
        return _KEPT

    def options(self) -> dict[str, Any]:
        return {"nodes": self._nodes, "dt": self._dt}

    def diagnostics(self) -> dict[str, float]:
        return {
            "steps": self._steps,
            "rejected_steps": 0,
            "right_hand_sides": self._steps,
            "largest_closure_error": float(self._scalars[paper_step.CLOSURE]),
        }

    def _begin(self, start: CellState) -> None:
        curve = start.curve.closed()
        theta, n, y = self._fields
        theta[:] = curve.theta
        n[:] = start.bound_fraction
        edge = self._conditions.edge(self.time, self._nodes)
        kappa, x, z = np.empty((3, self._nodes))
        tangent_angle.curvature(theta, curve.length, kappa)
        cosine, sine = np.cos(theta), np.sin(theta)
        gap = tangent_angle.points(curve.length, cosine, sine, kappa, x, z)
        area = tangent_angle.enclosed_area(curve.length, cosine, sine, x, z)
        self._scalars[:] = (curve.length, start.tension, *curve.origin, area, gap)
        y[:] = math.log(self._conditions.at(self.time).r_p)
        failed = self._balance(self.time, self._fields, self._scalars, edge, self._around)
        if failed != SOLVED:
            raise InputError(
                f"the start has no off-rate r >= 1 that balances the forces at node {failed} "
                f"(curvature {kappa[failed]:.4g}, tension {start.tension:.4g}): "
                "use a smoother or less tense start"
            )

    def _take(self, steps: int, dt: float) -> Breakdown | None:
        """Take ``steps`` steps of ``dt``, keeping the state before the last."""
        edge = self._conditions.edge(self.time, self._nodes)
        rate = self._conditions.tension_rate(self.time)
        if self._around is not None:
            points = self._edge_of(self._fields, self._scalars)
            surround_edge(self._around, self.time, *points, edge)
        for part in (steps - 1, 1):
            if part == 0:
                continue
            if part == 1:
                self._previous = (self.time, self._fields.copy(), self._scalars.copy())
            code, node, taken = self._kernel(part, dt, rate, edge)
            self._steps += taken
            self._steps_from_anchor += taken
            self.time = self._step_time(self._steps_from_anchor)
            if code != paper_step.STEPPED:
                self._previous = None
                return self._breakdown(code, node, dt, edge)
        return None

    def _kernel(self, steps: int, dt: float, rate: float, edge: np.ndarray) -> tuple[int, int, int]:
        """Take steps in place; return a code, the node it is about and the steps taken."""
        theta, n, y = self._fields
        code, node, taken = paper_step.advance(
            self._laws,
            self._around,
            self.time,
            steps,
            dt,
            rate,
            edge,
            theta,
            n,
            y,
            self._scalars,
            self._work,
        )
        return code, node, taken

    def _breakdown(self, code: int, node: int, dt: float, edge: np.ndarray) -> Breakdown:
        time = self.time + dt
        place = f"at t = {time:.6g}, s/L = {node / self._nodes:.4f}"
        stability = dt * _fastest_rate(self._scalars, self._fields, edge)
        advice = ""
        if stability > _STABLE:
            advice = (
                f"; the step {dt:g} is too long for this state, dt = {1.5 * dt / stability:.1g} "
                "or below may go further"
            )
        if code == paper_step.NO_ROOT:
            return Breakdown(
                "out_of_range",
                time,
                f"no off-rate r >= 1 balances the forces {place}: the edge is too concave for its "
                f"tension, which the model does not cover{advice}",
            )
        return Breakdown("not_finite", time, f"the state is no longer finite {place}{advice}")

    def _step_time(self, count: int) -> float:
        return self._anchor + count * self._dt

    def _between(self, time: float, edge: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """State inside the last step, linear in time, with the off-rate of that state.

        Returns also the parameters at the nodes.
        """
        if self._previous is None or not self._previous[0] <= time <= self.time:
            raise ValueError(f"t = {time} is not within the last step, which ends at {self.time}")
        start, fields, scalars = self._previous
        part = (time - start) / (self.time - start)
        fields = fields + part * (self._fields - fields)
        scalars = scalars + part * (self._scalars - scalars)
        fields[1] = self._linkers_between(part, self._previous[1][1])
        room = self._room()
        self._balance(time, fields, scalars, edge, room)
        return fields, scalars, edge if room is None else room.local

    def _linkers_between(self, part: float, before: np.ndarray) -> np.ndarray:
        """Bound fraction in the last step, from that ``before`` it."""
        between: np.ndarray = before + part * (self._fields[1] - before)
        return between

    def _room(self) -> Around | None:
        """Return surroundings to work with, that leave those of the next step as they are."""
        if self._around is None:
            return None
        motion = self._around.motion.copy()
        return around(self._surroundings, len(self._conditions.laws.rows), self._nodes, motion)

    def _balance(
        self,
        time: float,
        fields: np.ndarray,
        scalars: np.ndarray,
        edge: np.ndarray,
        room: Around | None,
    ) -> int:
        """Solve the bonds in place, and fill the parameters at the nodes."""
        _, n, y = fields
        tension = float(scalars[paper_step.TENSION])
        points = self._edge_of(fields, scalars)
        return int(balance_in_place(self._laws, room, time, *points, tension, n, y, edge))

    def _edge_of(self, fields: np.ndarray, scalars: np.ndarray) -> _Points:
        """Return x, y, tangent and curvature."""
        theta, length = fields[0], float(scalars[paper_step.LENGTH])
        kappa, x, z = np.empty((3, theta.size))
        tangent_angle.curvature(theta, length, kappa)
        cosine, sine = np.cos(theta), np.sin(theta)
        tangent_angle.points(length, cosine, sine, kappa, x, z)
        x += scalars[paper_step.ORIGIN_X]
        z += scalars[paper_step.ORIGIN_Y]
        return x, z, cosine, sine, kappa


def _checked_step(dt: Any, nodes: int, conditions: Conditions) -> float:
    """Return the step, or refuse one the linear theory of the resting circle says is unstable."""
    tension, shape = (
        max(rate(p) for p in conditions.extremes())
        for rate in (fastest_decay, lambda p: _shape_rate(p, nodes))
    )
    longest = _STABLE / max(tension, shape, 1e-12)
    safe = _one_digit_below(0.6 * longest)
    if dt is None:
        return min(1e-3, safe)
    step = real_number("dt", dt, 0.0, 1.0, open_low=True)
    if step > longest:
        why = (
            f"the tension decays at a rate of {tension:.0f}"
            if tension >= shape
            else f"the shape on {nodes} nodes decays at a rate of up to {shape:.0f}"
        )
        raise InputError(
            f"dt = {step:g} is unstable: {why}, and an explicit step must stay below "
            f"2 / rate = {longest:.2g}; dt = {safe:g} works"
        )
    return step


def _shape_rate(parameters: Any, nodes: int) -> float:
    """Decay rate of the finest shape the scheme's wide differences see, on the resting circle."""
    p = parameters
    log_r = math.log(p.r_p)
    resistance = (1.0 + log_r) / (1.0 + log_r + p.zeta_1 * p.n_bar / p.r_p)
    finest = nodes / (2.0 * math.pi)
    return float(p.epsilon * p.h * abs(p.sigma_bar) * finest**2 * resistance)


def _fastest_rate(scalars: np.ndarray, fields: np.ndarray, edge: np.ndarray) -> float:
    """Decay rate of the finest shape in the present state."""
    _, n, y = fields
    r = np.exp(y)
    resistance = (1.0 + y) * r / ((1.0 + y) * r + edge[1] * n)
    finest = n.size / scalars[paper_step.LENGTH]
    tension = abs(scalars[paper_step.TENSION])
    return float(np.max(edge[3] * edge[4] * resistance) * tension * finest**2)


def _one_digit_below(value: float) -> float:
    power = math.floor(math.log10(value))
    return float(f"{math.floor(value / 10.0**power)}e{power}")
