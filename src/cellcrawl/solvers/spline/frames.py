"""The cell of the spline scheme at one instant: inside a step, and on equally spaced nodes."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from cellcrawl.laws.law import Law
from cellcrawl.solvers.base import Frame, pointwise
from cellcrawl.solvers.spline import balance, outline
from cellcrawl.solvers.spline.linkers import DIFFUSIVITY, LINKER_ROWS, second_derivative_after
from cellcrawl.solvers.spline.outline import LOG_R, N
from cellcrawl.solvers.spline.remeshing import SPREAD_ROWS, spread_evenly
from cellcrawl.surroundings.place import Around, around


class World(NamedTuple):
    """Laws and surroundings."""

    laws: Law
    around: Around | None

    def apart(self) -> World:
        """Return the same, that leave the surroundings of the next step as they are."""
        own = self.around
        if own is None:
            return self
        rows, nodes = own.local.shape
        fresh = around(own.compiled, rows, nodes, own.motion.copy())
        return self._replace(around=fresh)

    def balance(
        self, time: float, fields: np.ndarray, tension: float, shape: np.ndarray, edge: np.ndarray
    ) -> tuple[int, int, np.ndarray]:
        """Solve the bonds in place; a code, a marker, and the parameters at the markers."""
        code, marker = balance.solve_balance_in_place(
            self.laws.compiled, self.around, time, fields, tension, shape, edge
        )
        return code, marker, edge if self.around is None else self.around.local


class State(NamedTuple):
    """The scheme's unknowns at one instant."""

    time: float
    fields: np.ndarray
    """x, y, n and log r at the markers, shape (4, markers)."""
    tension: float
    angle: float
    """Angle of the tangent at the first marker, continuous in time."""


def measured(fields: np.ndarray) -> np.ndarray:
    """Return the `outline.measure` of the markers, shape (SHAPE_ROWS, markers)."""
    shape = np.empty((outline.SHAPE_ROWS, fields.shape[1]))
    outline.measure(fields, shape)
    return shape


def on_even_nodes(fields: np.ndarray) -> np.ndarray:
    """Return the fields at as many nodes equally spaced in arclength, the first in place."""
    even = np.empty_like(fields)
    spread_evenly(fields, measured(fields), even, np.empty((SPREAD_ROWS, fields.shape[1])))
    return even


def rates_of_change(
    world: World, state: State, edge: np.ndarray, tension_rate: float
) -> tuple[np.ndarray, float]:
    """Return the rates of x, y and n at the markers, shape (3, markers), and of the tension."""
    fields, shape = state.fields.copy(), measured(state.fields)
    laws = world.laws.compiled
    _, _, edge = world.apart().balance(state.time, fields, state.tension, shape, edge)
    rates, curved = np.empty((3, fields.shape[1])), np.empty(fields.shape[1])
    area_rate = balance.rates(laws, fields, state.tension, shape, edge, rates)
    spare = np.empty((LINKER_ROWS, fields.shape[1]))
    second_derivative_after(fields, edge, 0.0, shape, curved, spare)
    rates[N] += edge[DIFFUSIVITY] * curved
    return rates, tension_rate * area_rate


def inside_step(
    time: float,
    first: State,
    first_rates: tuple[np.ndarray, float],
    last: State,
    last_rates: tuple[np.ndarray, float],
) -> State:
    """Return the state between both ends of a step, cubic in time from values and rates."""
    dt = last.time - first.time
    part = (time - first.time) / dt
    rest = 1.0 - part
    weights = (rest * rest * (1.0 + 2.0 * part), part * part * (1.0 + 2.0 * rest))
    slopes = (dt * part * rest * rest, -dt * part * part * rest)
    fields = rest * first.fields + part * last.fields
    fields[:LOG_R] = (
        weights[0] * first.fields[:LOG_R]
        + weights[1] * last.fields[:LOG_R]
        + slopes[0] * first_rates[0]
        + slopes[1] * last_rates[0]
    )
    tension = (
        weights[0] * first.tension
        + weights[1] * last.tension
        + slopes[0] * first_rates[1]
        + slopes[1] * last_rates[1]
    )
    return State(time, fields, tension, rest * first.angle + part * last.angle)


def frame(world: World, state: State, edge: np.ndarray) -> Frame:
    """Return the cell on equally spaced nodes, in balance with the parameters ``edge``.

    Length, area and centroid are those of the scheme's own markers.
    """
    markers, shape = state.fields, measured(state.fields)
    even = on_even_nodes(markers)
    even_shape = measured(even)
    balanced = even.copy()
    code, _, edge = world.apart().balance(state.time, balanced, state.tension, even_shape, edge)
    if code == balance.BALANCED:  # or a jump of the parameters left none: keep that of before
        even = balanced
    theta = np.unwrap(np.arctan2(even_shape[outline.YU], even_shape[outline.XU]))
    theta += 2.0 * math.pi * round((state.angle - theta[0]) / (2.0 * math.pi))
    kappa = even_shape[outline.KAPPA]
    off_rate, velocity, friction = pointwise(
        world.laws, even[LOG_R], even[N], state.tension, kappa, edge
    )
    center = outline.centroid(markers, shape)
    return Frame(
        time=state.time,
        x=even[outline.X],
        y=even[outline.Y],
        theta=theta,
        curvature=kappa,
        bound_fraction=even[N],
        off_rate=off_rate,
        normal_velocity=velocity,
        friction=friction,
        tension=state.tension,
        length=float(shape[outline.SPEED].sum()),
        area=float(outline.area(markers, shape)),
        centroid_x=float(center[0]),
        centroid_y=float(center[1]),
    )
