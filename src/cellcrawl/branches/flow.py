"""The flow of shapes: a cell without place, direction and choice of first node, carried in time.

A shape is one array ``z``: the tangent angle less its winding at even nodes, of mean zero; the
bound fraction at the midpoints between them, its first wave highest at node 0; and the tension in
units of `TENSION_UNIT`. What is conserved is projected alike before and after: the edge closes and
its area is that of the tension.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Final, NamedTuple

import numpy as np

from cellcrawl.branches.setting import Setting
from cellcrawl.branches.stepping import (
    STAGE_ROWS,
    advance,
    advance_stabilised,
    centred_rates,
    chebyshev,
)
from cellcrawl.branches.system import NotFound
from cellcrawl.curve import Curve
from cellcrawl.numerics import fourier
from cellcrawl.solvers.adaptive import state as layout
from cellcrawl.solvers.adaptive.entries import AREA, LENGTH, ORIGIN_X, TENSION
from cellcrawl.solvers.adaptive.mesh import CHANGE, FINE, FINE_NODE, MESH_ROWS
from cellcrawl.solvers.adaptive.projection import TRACE_ROWS, project
from cellcrawl.solvers.adaptive.rates import WORK_ROWS, renew_rates
from cellcrawl.solvers.adaptive.staggered import HALO
from cellcrawl.starts.base import CellState

TENSION_UNIT: Final = 1000.0
_STABLE = 2.6  # h times the fastest decay that a classical step takes
_SAFE = 1.25  # of the fastest decay measured
_LONGEST = 0.01  # a step, for accuracy
_DIFFERENCE = 1e-6


class Moved(NamedTuple):
    """Where a shape came to, and how the cell turned and its first node went on meanwhile."""

    shape: np.ndarray
    turn: float
    relabelled: float


@dataclass(frozen=True, eq=False)
class Flow:
    """The flow of shapes under a setting, on some even nodes (a multiple of 8)."""

    setting: Setting
    nodes: int

    @cached_property
    def _room(self) -> dict[str, Any]:
        nodes, span = self.nodes, self.nodes + 2 * HALO
        laws = self.setting.laws
        values = [self.setting._values[name] for name in laws.rows]
        column = np.array([*values, self.setting.tension_rate])
        mesh = np.zeros((MESH_ROWS, span))
        mesh[FINE] = mesh[FINE_NODE] = 1.0
        mesh[CHANGE] = 0.0
        return {
            "laws": laws.compiled,
            "edge": np.repeat(column[:, None], nodes, axis=1),
            "mesh": mesh,
            "work": np.zeros((WORK_ROWS, span)),
            "stages": np.zeros((STAGE_ROWS, layout.size(nodes))),
            "trace": np.zeros((TRACE_ROWS, span)),
        }

    def state_of(self, shape: np.ndarray) -> np.ndarray:
        """Return a solver's state of a shape.

        Raises
        ------
        NotFound
            For a shape that has no closed edge.
        """
        nodes = self.nodes
        state = np.zeros(layout.size(nodes))
        layout.angle(state)[:] = shape[:nodes]
        layout.bound(state)[:] = shape[nodes : 2 * nodes]
        layout.density(state)[:] = 1.0
        scalars = layout.scalars(state)
        sigma = shape[-1] * TENSION_UNIT
        setting = self.setting
        area = setting.rest_area + (sigma - setting.rest.tension) / setting.tension_rate
        scalars[LENGTH], scalars[TENSION], scalars[AREA] = 2.0 * math.pi, sigma, area
        self._project(state, 2)
        return state

    def _project(self, state: np.ndarray, times: int) -> None:
        for _ in range(times):
            gap, _ = project(state, self.nodes, self._room["trace"])
            if not math.isfinite(gap):
                raise NotFound("the shape has no area that its tension could belong to")

    def shape_of(self, state: np.ndarray) -> Moved:
        """Return the shape of a state in its own frame."""
        nodes = self.nodes
        w, n = layout.angle(state), layout.bound(state)
        first = np.fft.rfft(n)[1]
        back = math.pi / nodes  # the midpoints are half a spacing ahead
        ahead = -float(np.angle(first)) + back
        w = fourier.resample(w, nodes, ahead) + ahead
        n = fourier.resample(n, nodes, ahead)
        turn = float(w.mean())
        sigma = layout.scalars(state)[TENSION] / TENSION_UNIT
        return Moved(np.concatenate([w - turn, n, [sigma]]), turn, ahead)

    def from_cell(self, cell: CellState) -> np.ndarray:
        """Return the shape of a cell."""
        state = layout.from_cell(cell, self.nodes)
        return self.canonical(self.shape_of(state).shape)

    def canonical(self, shape: np.ndarray) -> np.ndarray:
        """Return a shape closed, with its own area, in its own frame."""
        return self.shape_of(self.state_of(shape)).shape

    def resampled(self, shape: np.ndarray, nodes: int) -> np.ndarray:
        """Return a shape, or a change of one, on another number of nodes."""
        old = self.nodes
        w = fourier.resample(shape[:old], nodes)
        n = fourier.resample(shape[old : 2 * old], nodes, math.pi / nodes - math.pi / old)
        return np.concatenate([w, n, shape[-1:]])

    def mirrored(self, shape: np.ndarray) -> np.ndarray:
        """Return the mirror image of a shape, or of a change of one."""
        nodes = self.nodes
        w, n = shape[:nodes], shape[nodes : 2 * nodes]
        return np.concatenate([-np.roll(w[::-1], 1), n[::-1], shape[-1:]])

    def norm(self, change: np.ndarray) -> float:
        """Return the size of a change: mean over the edge, tension in its unit."""
        square = float(change[:-1] @ change[:-1]) / self.nodes
        return math.sqrt(square + float(change[-1]) ** 2)

    def rates(self, state: np.ndarray) -> np.ndarray:
        """Return the rates of a state.

        Raises
        ------
        NotFound
            Where the forces have no balance.
        """
        room, out = self._room, np.zeros_like(state)
        y = np.full(self.nodes, 3.0)
        renew_rates(room["laws"], y, room["edge"], room["work"])
        if not centred_rates(
            room["laws"], state.copy(), out, y, room["edge"], room["mesh"], room["work"]
        ):
            raise NotFound("the forces have no balance")
        return out

    def stiffness(self, shape: np.ndarray) -> float:
        """Return a bound of the fastest decay around a shape, by power iteration."""
        state = self.state_of(shape)
        here, size = self.rates(state), 0.0
        change = np.zeros_like(state)
        saw = np.where(np.arange(self.nodes) % 2 == 0, 1.0, -1.0)
        layout.bound(change)[:] = saw + 0.3
        layout.scalars(change)[TENSION] = 1.0
        layout.scalars(change)[LENGTH] = 1e-3
        for _ in range(24):
            change *= _DIFFERENCE / np.abs(change).max()
            after = self.rates(state + change) - here
            layout.scalars(after)[ORIGIN_X:] = 0.0
            before, size = size, float(np.linalg.norm(after) / np.linalg.norm(change))
            change = after
            if abs(size - before) < 0.02 * size:
                break
        return _SAFE * size

    def steps_for(self, shapes: list[np.ndarray], time: float) -> int:
        """Return how many classical steps a time takes on a path by some shapes."""
        fastest = max(self.stiffness(shape) for shape in shapes)
        return max(1, math.ceil(time * max(fastest / _STABLE, 1.0 / _LONGEST)))

    def state_after(self, state: np.ndarray, time: float, steps: int) -> np.ndarray:
        """Return a state carried on by equal steps.

        Raises
        ------
        NotFound
            Where the model ends, or the steps are too long.
        """
        room, made = self._room, state.copy()
        y = np.full(self.nodes, 3.0)
        renew_rates(room["laws"], y, room["edge"], room["work"])
        with np.errstate(all="ignore"):
            good = advance(
                room["laws"], steps, time / steps, made, y, room["edge"], room["mesh"],
                room["work"], room["stages"],
            )  # fmt: skip
        if not (good and np.all(np.isfinite(made))):
            raise NotFound("the forces lost their balance, or the time steps were too long")
        return made

    def after(self, shape: np.ndarray, time: float, steps: int) -> Moved:
        """Return a shape carried on by equal classical steps, in its own frame."""
        state = self.state_after(self.state_of(shape), time, steps)
        self._project(state, 1)
        return self.shape_of(state)

    def after_stabilised(self, shape: np.ndarray, time: float, h: float, fastest: float) -> Moved:
        """Return a shape carried on by stabilised steps of at most ``h``, of order 2."""
        steps = max(1, math.ceil(time / h))
        h = time / steps
        stages = max(2, math.ceil(math.sqrt(1.0 + fastest * h / 0.65)))
        room, made = self._room, self.state_of(shape)
        y = np.full(self.nodes, 3.0)
        renew_rates(room["laws"], y, room["edge"], room["work"])
        with np.errstate(all="ignore"):
            good = advance_stabilised(
                room["laws"], steps, h, chebyshev(stages), made, y, room["edge"], room["mesh"],
                room["work"], room["stages"],
            )  # fmt: skip
        if not (good and np.all(np.isfinite(made))):
            raise NotFound("the forces lost their balance, or the time steps were too long")
        self._project(made, 1)
        return self.shape_of(made)

    def pace(self, shape: np.ndarray) -> np.ndarray:
        """Return the rate of change of a shape in its own frame."""
        state = self.state_of(shape)
        out = self.rates(state)
        h = 1e-5
        ahead, behind = self.shape_of(state + h * out).shape, self.shape_of(state - h * out).shape
        return np.asarray((ahead - behind) / (2.0 * h))

    def cell(self, state: np.ndarray, nodes: int) -> CellState:
        """Return a state as a cell at some even nodes."""
        old = self.nodes
        w = fourier.resample(layout.angle(state), nodes)
        n = fourier.resample(layout.bound(state), nodes, -math.pi / old)
        scalars = layout.scalars(state)
        theta = w + layout.winding(nodes)
        curve = Curve(theta, float(scalars[LENGTH]), scalars[ORIGIN_X : ORIGIN_X + 2].copy())
        return CellState(curve.closed(), np.clip(n, 0.0, 1.0), float(scalars[TENSION]))

    def tail(self, shape: np.ndarray) -> float:
        """Return the share of the shortest waves in a shape."""
        worst = 0.0
        for part in (shape[: self.nodes], shape[self.nodes : 2 * self.nodes]):
            waves = np.abs(np.fft.rfft(part))
            worst = max(worst, float(waves[-max(4, waves.size // 12) :].max() / waves[1:].max()))
        return worst
