"""Orbits by shooting: shapes that come back to themselves, or to their mirror image.

Newton's method on the map over a period. Its derivative is needed roughly, and only on the few
changes that do not die out within a period: an Arnoldi basis of them from quick, coarse flights;
all others are gone when the cell is back, so that for them the map is its own solution. What is
solved, the return itself, is flown with care and on as many nodes as the shape asks for.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Final, NamedTuple

import numpy as np

from cellcrawl.branches.flow import Flow, Moved
from cellcrawl.branches.setting import Setting
from cellcrawl.branches.system import NotFound

COARSE: Final = 256
NODES: Final = (256, 384, 512, 768, 1024)
_BASIS = 24
_NEGLIGIBLE = 3e-3  # multiplier of changes that are left out of the basis
_QUICK = 0.02  # time step of the coarse flights, of order 2
_SMALL = 1e-6  # change by which derivatives are measured
SETTLED: Final = 1e-8
_MOST_STEPS = 16
_TAIL = 3e-6  # share of the shortest waves that nodes may leave
_LONGEST = 0.3
_PASSES = 2


@dataclass(frozen=True, eq=False)
class Return:
    """The map from a shape to itself a period later, mirrored or not.

    Attributes
    ----------
    flow : Flow
    reflected : bool
        Whether the cell comes back as its mirror image.
    """

    flow: Flow
    reflected: bool

    def _told(self, moved: Moved) -> Moved:
        if not self.reflected:
            return moved
        return moved._replace(shape=self.flow.mirrored(moved.shape))

    def careful(self, shape: np.ndarray, period: float, steps: int) -> Moved:
        """Return where a shape comes to, by classical steps."""
        return self._told(self.flow.after(shape, period, steps))

    def quick(self, shape: np.ndarray, period: float, fastest: float) -> np.ndarray:
        """Return nearly where a shape comes to."""
        moved = self.flow.after_stabilised(shape, period, _QUICK, fastest)
        return self._told(moved).shape


class Basis(NamedTuple):
    """Changes of a shape that last, and what the return makes of them, on the coarse nodes.

    Vectors are scaled: their squares add up to the mean over the edge.
    """

    vectors: np.ndarray
    """Orthonormal columns, across the pace, shape (entries, count)."""
    matrix: np.ndarray
    """The return on them."""
    along: np.ndarray
    """What it adds along the pace."""


def scaled(change: np.ndarray) -> np.ndarray:
    """Return a change of shape as a vector whose square is that of `Flow.norm`."""
    made = change / math.sqrt((change.size - 1) // 2)
    made[-1] = change[-1]
    return np.asarray(made)


def unscaled(vector: np.ndarray) -> np.ndarray:
    """Return the change of shape of a scaled vector."""
    made = vector * math.sqrt((vector.size - 1) // 2)
    made[-1] = vector[-1]
    return np.asarray(made)


def arnoldi(
    apply: Callable[[np.ndarray], np.ndarray], pace: np.ndarray, first: np.ndarray, most: int
) -> Basis:
    """Return a basis of what lasts under a linear map, across its neutral vector ``pace``."""
    vectors = np.zeros((pace.size, most + 1))
    matrix, along = np.zeros((most + 1, most)), np.zeros(most)
    start = first - (pace @ first) * pace
    vectors[:, 0] = start / np.linalg.norm(start)
    count = most
    for k in range(most):
        image = apply(vectors[:, k])
        along[k] = pace @ image
        image = image - along[k] * pace
        for _ in range(2):
            part = vectors[:, : k + 1].T @ image
            matrix[: k + 1, k] += part
            image = image - vectors[:, : k + 1] @ part
        matrix[k + 1, k] = np.linalg.norm(image)
        if matrix[k + 1, k] < _NEGLIGIBLE:
            count = k + 1
            break
        vectors[:, k + 1] = image / matrix[k + 1, k]
    return Basis(vectors[:, :count], matrix[:count, :count], along[:count])


class Found(NamedTuple):
    """A closed orbit as a point of it."""

    shape: np.ndarray
    period: float
    parameter: float
    nodes: int
    steps: int
    residual: float
    turn: float
    relabelled: float
    basis: Basis


class Border(NamedTuple):
    """A parameter set free: it and the point stay across a tangent, in a weighted norm."""

    name: str
    shape: np.ndarray
    """Tangent's change of shape, on the coarse nodes, scaled."""
    period: float
    value: float
    weight: float
    """Of the parameter's square."""

    def across(self, change: np.ndarray, longer: float, shift: float) -> float:
        """Return how far a change of shape, period and parameter goes along the tangent."""
        part = float(self.shape @ change) + self.period * longer
        return part + self.weight * self.value * shift


def _linear(
    setting: Setting, reflected: bool, shape: np.ndarray, period: float
) -> Callable[[np.ndarray], np.ndarray]:
    """Return the derivative of the return, on the coarse nodes, scaled, from quick flights."""
    flow = Flow(setting, COARSE)
    back = Return(flow, reflected)
    fastest = flow.stiffness(shape)
    home = back.quick(shape, period, fastest)

    def apply(vector: np.ndarray) -> np.ndarray:
        size = float(np.linalg.norm(vector))
        if size == 0.0:
            return vector
        there = back.quick(shape + _SMALL / size * unscaled(vector), period, fastest)
        return scaled((there - home) * (size / _SMALL))

    return apply


def lasting(setting: Setting, reflected: bool, shape: np.ndarray, period: float) -> Basis:
    """Return the changes that last over a period, from quick flights on the coarse nodes."""
    apply = _linear(setting, reflected, shape, period)
    waves = np.arange(1, COARSE + 1)
    rough = np.cos(1.7 * waves**1.5)
    first = apply(scaled(np.concatenate([0.3 * rough, 0.1 * rough[::-1], [0.1]])))
    return arnoldi(apply, _unit_pace(Flow(setting, COARSE), shape), first, _BASIS)


def close(
    setting: Setting,
    reflected: bool,
    shape: np.ndarray,
    period: float,
    *,
    nodes: int | None = None,
    basis: Basis | None = None,
    border: Border | None = None,
) -> Found:
    """Return the closed orbit near a shape on the coarse nodes.

    Raises
    ------
    NotFound
        If Newton's method does not come to one.
    """
    flow = Flow(setting, COARSE)
    start_shape, start_period = shape, period
    parameter = 0.0 if border is None else setting.value(border.name)
    start_parameter = parameter
    count = COARSE if nodes is None else nodes
    fine, given = Flow(setting, count), shape if count == COARSE else flow.resampled(shape, count)
    fresh = basis is None
    if basis is None:
        basis = lasting(setting, reflected, shape, period)
    steps = fine.steps_for([given], period)
    by: tuple[np.ndarray, float] | None = None
    size, worse = math.inf, 0
    for _ in range(_MOST_STEPS):
        back = Return(fine, reflected)
        moved = back.careful(given, period, steps)
        miss = moved.shape - given
        before, size = size, fine.norm(miss)
        if size < SETTLED and (
            border is None
            or _on_border(
                border, shape, start_shape, period - start_period, parameter - start_parameter
            )
        ):
            wanted = _enough_nodes(fine, given, period, steps)
            if nodes is None and wanted > count:
                count = wanted
                coarse_shape = fine.resampled(given, COARSE) if fine.nodes != COARSE else given
                fine = Flow(setting, count)
                given = flow.resampled(coarse_shape, count)
                steps = fine.steps_for([given], period)
                size = math.inf
                continue
            return Found(
                given, period, parameter, count, steps, size, moved.turn, moved.relabelled, basis
            )
        if not math.isfinite(size) or size > 2.0:
            break
        if size > 0.5 * before:
            worse += 1
            if worse > 3 or (size > 3.0 * before and fresh):
                break
            basis, fresh = lasting(setting, reflected, shape, period), True
            by = None
        coarse_miss = miss if count == COARSE else fine.resampled(miss, COARSE)
        apply = _linear(setting, reflected, shape, period)
        change, longer = _answer(flow, shape, basis, apply, scaled(coarse_miss))
        shift = 0.0
        if border is not None:
            if by is None:
                by = answer(setting, border.name, reflected, shape, period, basis)
            off = _off_border(
                border, shape, start_shape, period - start_period, parameter - start_parameter
            )
            off += border.across(change, longer, 0.0)
            shift = -off / border.across(by[0], by[1], 1.0)
            change, longer = change + shift * by[0], longer + shift * by[1]
        shorter = min(1.0, _LONGEST / max(float(np.linalg.norm(change)), 1e-300))
        step = shorter * unscaled(change)
        fine_step = step if count == COARSE else flow.resampled(step, count)
        rest = miss if count == COARSE else miss - flow.resampled(coarse_miss, count)
        given = fine.canonical(given + fine_step + (rest if count != COARSE else 0.0))
        shape = given if count == COARSE else fine.resampled(given, COARSE)
        period += shorter * longer
        if border is not None:
            parameter += shorter * shift
            setting = setting.replace(border.name, parameter)
            flow, fine = Flow(setting, COARSE), Flow(setting, count)
        if not period > 0.0:
            break
    raise NotFound(f"Newton's method did not close the orbit (it misses by {size:.2g})")


def _answer(
    flow: Flow,
    shape: np.ndarray,
    basis: Basis,
    apply: Callable[[np.ndarray], np.ndarray],
    to: np.ndarray,
) -> tuple[np.ndarray, float]:
    """Solve ``(P' - 1) dz + f dT = -to`` across the pace ``f``.

    What is outside the basis is gone after a return, but has moved what is inside: it is flown.
    """
    v, count = basis.vectors, basis.along.size
    rate = scaled(flow.pace(shape))
    pace = rate / np.linalg.norm(rate)
    matrix = np.zeros((count + 1, count + 1))
    matrix[:count, :count] = basis.matrix - np.eye(count)
    matrix[count, :count] = basis.along
    matrix[:count, count], matrix[count, count] = v.T @ rate, pace @ rate

    def outside(vector: np.ndarray) -> np.ndarray:
        return np.asarray(vector - v @ (v.T @ vector) - (pace @ vector) * pace)

    lost = outside(to)
    for _ in range(_PASSES):
        moved = to + apply(lost)
        solution = np.linalg.solve(matrix, -np.append(v.T @ moved, pace @ moved))
        lost = outside(moved + solution[count] * rate)
    return v @ solution[:count] + lost, float(solution[count])


def answer(
    setting: Setting, name: str, reflected: bool, shape: np.ndarray, period: float, basis: Basis
) -> tuple[np.ndarray, float]:
    """Return how an orbit's shape (coarse nodes, scaled) and period answer to a parameter."""
    flow = Flow(setting, COARSE)
    slope = _slope(setting, name, reflected, shape, period)
    apply = _linear(setting, reflected, shape, period)
    return _answer(flow, shape, basis, apply, slope)


def _off_border(
    border: Border, shape: np.ndarray, start: np.ndarray, longer: float, shift: float
) -> float:
    return border.across(scaled(shape - start), longer, shift)


def _on_border(
    border: Border, shape: np.ndarray, start: np.ndarray, longer: float, shift: float
) -> bool:
    return abs(_off_border(border, shape, start, longer, shift)) < 1e-5


def _slope(
    setting: Setting, name: str, reflected: bool, shape: np.ndarray, period: float
) -> np.ndarray:
    """Return the derivative of the return by a parameter, on the coarse nodes, scaled."""
    value = setting.value(name)
    step = 1e-5 * max(abs(value), 1e-3)
    there = []
    for sign in (1.0, -1.0):
        flow = Flow(setting.replace(name, value + sign * step), COARSE)
        there.append(Return(flow, reflected).quick(shape, period, flow.stiffness(shape)))
    return scaled((there[0] - there[1]) / (2.0 * step))


def _unit_pace(flow: Flow, shape: np.ndarray) -> np.ndarray:
    pace = scaled(flow.pace(shape))
    size = float(np.linalg.norm(pace))
    if size < 1e-6:
        raise NotFound("the shape rests: it is a steady state and no orbit")
    return np.asarray(pace / size)


def _enough_nodes(flow: Flow, shape: np.ndarray, period: float, steps: int) -> int:
    """Return how many nodes an orbit asks for, from the shortest waves along it."""
    worst, here = flow.tail(shape), shape
    for _ in range(7):
        here = flow.after(here, period / 8.0, math.ceil(steps / 8)).shape
        worst = max(worst, flow.tail(here))
    if worst < _TAIL:
        return flow.nodes
    wider = [n for n in NODES if n > flow.nodes] or [flow.nodes]
    return wider[min(1 if worst > 20.0 * _TAIL else 0, len(wider) - 1)]


def multipliers(
    setting: Setting, reflected: bool, found: Found, wanted: int = 6
) -> tuple[np.ndarray, float, np.ndarray]:
    """Return the leading multipliers, that of the pace, and their vectors on the orbit's nodes.

    An Arnoldi basis from careful flights, which begins in the leading changes of the quick one.
    """
    flow, shape = Flow(setting, found.nodes), found.shape
    back = Return(flow, reflected)
    pace = _unit_pace(flow, shape)
    home = back.careful(shape, found.period, found.steps).shape

    def apply(vector: np.ndarray) -> np.ndarray:
        there = back.careful(shape + _SMALL * unscaled(vector), found.period, found.steps).shape
        return scaled((there - home) / _SMALL)

    values, vectors = np.linalg.eig(found.basis.matrix)
    leading = np.argsort(-np.abs(values))[:wanted]
    mixed = (found.basis.vectors @ vectors[:, leading]).real.sum(axis=1)
    if found.nodes != COARSE:
        mixed = scaled(Flow(setting, COARSE).resampled(unscaled(mixed), found.nodes))
    basis = arnoldi(apply, pace, mixed, wanted + 3)
    values, small = np.linalg.eig(basis.matrix)
    order = np.argsort(-np.abs(values), kind="stable")
    kept = order[: min(wanted, basis.along.size)]
    neutral = float(pace @ apply(pace))
    return values[kept], neutral, basis.vectors @ small[:, kept]
