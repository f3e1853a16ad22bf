"""Curves of special points in the plane of two parameters: folds, Hopf points, pitchforks.

The steady states over two parameters are a surface. Near a state it is a graph over its tangent
plane, at folds too; on that plane the real part of the critical growth rate is a function of two
numbers, and the curve is where it vanishes. One method serves for all kinds of points.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Container, Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Final, NamedTuple

import numpy as np

from cellcrawl.arguments import checked
from cellcrawl.branches.continuation import weight_of
from cellcrawl.branches.points import CIRCLE, FOLD, HOPF, SpecialPoint
from cellcrawl.branches.resolution import better_mesh, resampled
from cellcrawl.branches.setting import OutOfRange, Setting, bounds_of
from cellcrawl.branches.state import AT_REST, SteadyState
from cellcrawl.branches.system import NotFound
from cellcrawl.errors import InputError
from cellcrawl.threads import on_one_thread
from cellcrawl.validation import real_number, whole_number

if TYPE_CHECKING:
    import pandas as pd

_FIRST, _LARGEST, _SMALLEST = 0.02, 0.1, 1e-5
_DIFFERENCE = 1e-4
_SETTLED = 1e-9
_MOST_STEPS = 12
_ALIKE = 0.8
_SLOW = 0.02  # angular frequency at which a pair of growth rates is nearly a double zero
CURVE_ENDS: Final = {
    "border": "the curve left the box of parameters asked for",
    "closed": "the curve came back to where it began",
    "double zero": "the frequency went to zero: the pair becomes two real growth rates",
    "circle": "the curve met the resting circle",
    "no convergence": "no next point was found even for the smallest step",
    "points": "the curve has as many points as asked for",
}
"""How a curve can end."""


class _At(NamedTuple):
    """A state on the surface with its critical growth rate."""

    state: SteadyState
    jacobian: np.ndarray
    value: complex
    vector: np.ndarray

    @property
    def test(self) -> float:
        return self.value.real


@dataclass(eq=False)
class PointCurve:
    """A curve of special points over two parameters.

    Attributes
    ----------
    kind, symmetry : str
        Those of the point it began at.
    names : (str, str)
        The two parameters.
    points : list of SpecialPoint
        In order along the curve.
    statuses, messages : (str, str)
        How it ended on either side, of `CURVE_ENDS`.
    """

    kind: str
    symmetry: str
    names: tuple[str, str]
    points: list[SpecialPoint] = field(default_factory=list)
    statuses: tuple[str, str] = ("", "")
    messages: tuple[str, str] = ("", "")

    @property
    def values(self) -> np.ndarray:
        """Values of the two parameters, shape (points, 2)."""
        settings = [point.state.setting for point in self.points]
        return np.array([[setting.value(name) for name in self.names] for setting in settings])

    def table(self) -> pd.DataFrame:
        """Return a row for each point."""
        import pandas as pd

        rows = []
        for point, values in zip(self.points, self.values, strict=True):
            state = point.state
            row = dict(zip(self.names, values, strict=True))
            row |= {"frequency": point.frequency, "speed": state.speed, "tension": state.tension}
            rows.append({**row, "turning_rate": state.turning_rate, "nodes": state.mesh.nodes})
        return pd.DataFrame(rows)

    def __len__(self) -> int:
        return len(self.points)

    def __repr__(self) -> str:
        ends = " and ".join(self.statuses)
        return (
            f"PointCurve({self.kind} over {' and '.join(self.names)}, {len(self)} points, {ends})"
        )


@checked
@on_one_thread
def curve_of(
    point: SpecialPoint,
    second: str,
    *,
    within: Mapping[str, Any] | None = None,
    most_points: int = 200,
    largest_step: float = _LARGEST,
) -> PointCurve:
    """Follow a special point as a second parameter changes too, to both sides.

    Parameters
    ----------
    point : SpecialPoint
        A fold, Hopf point or pitchfork of a branch.
    second : str
        Another parameter than that of the branch, of the model or of the law.
    within : mapping, optional
        ``{name: (low, high)}`` for either parameter: the box in which to follow it. The
        parameters' own ranges unless given.
    most_points : int
        On either side.
    largest_step : float
        1e-3 to 0.5: of mean changes of angle and bound fraction, and of the relative change of the
        parameters.

    Returns
    -------
    PointCurve
        With how it ended on both sides; what was computed is kept, however it ends.
    """
    setting = point.state.setting
    names = (point.name, second)
    bounds_of(setting.laws, second)
    if second == point.name:
        raise InputError(f"the branch was followed in {second} already: give another parameter")
    if point.kind == CIRCLE or point.vector is None:
        raise InputError(
            "where gliding leaves the circle is known in closed form: see cellcrawl.branches.onsets"
            " and cellcrawl.linear.marginal_curves"
        )
    box = _box(setting, names, within)
    most = whole_number("most_points", most_points, 2, 10_000)
    largest = real_number("largest_step", largest_step, 1e-3, 0.5)
    tracer = _Tracer(point, names, box, within or {}, largest)
    curve = PointCurve(point.kind, point.symmetry, names)
    sides, statuses = [], []
    for sign in (-1.0, 1.0):
        found, status = tracer.trace(sign, most)
        sides.append(found)
        statuses.append(status)
        if status == "closed":
            break
    curve.points = [*reversed(sides[0][1:]), *(sides[1] if len(sides) > 1 else sides[0][:1])]
    first, last = statuses[0], statuses[-1]
    curve.statuses = (first, last)
    curve.messages = (CURVE_ENDS[first], CURVE_ENDS[last])
    return curve


def _box(
    setting: Setting, names: tuple[str, str], within: Mapping[str, Any] | None
) -> list[tuple[float, float]]:
    given = dict(within or {})
    made = []
    for name in names:
        low, high = bounds_of(setting.laws, name)
        try:
            ends = tuple(given.pop(name, (low, high)))
            a, b = (real_number(f"within {name}", end, low, high) for end in ends)
        except (TypeError, ValueError) as error:
            if isinstance(error, InputError):
                raise
            raise InputError(f"within {name} must be two numbers, low and high") from None
        if not a < b:
            raise InputError(f"within {name}: {a:g} must be below {b:g}")
        made.append((a, b))
    if given:
        raise InputError(f"within has {next(iter(given))!r}: the parameters are {names}")
    return made


class _Tracer:
    """Follows the zero of a growth rate on the surface of states."""

    def __init__(
        self,
        point: SpecialPoint,
        names: tuple[str, str],
        box: list[tuple[float, float]],
        narrowed: Container[str],
        largest: float,
    ) -> None:
        self.point, self.names, self.box, self.largest = point, names, box, largest
        setting = point.state.setting
        self.weights = np.array(
            [
                weight_of(setting.value(name), high - low if name in narrowed else 0.0)
                for name, (low, high) in zip(names, box, strict=True)
            ]
        )

    def trace(self, sign: float, most: int) -> tuple[list[SpecialPoint], str]:
        """Return the points to one side, the first among them, and how the curve ended."""
        start = self.point
        assert start.vector is not None
        here = self._at_state(start.state, complex(0.0, start.frequency), start.vector)
        found, step = [start], _FIRST
        towards: np.ndarray | None = None
        while len(found) < most:
            try:
                here = self._refitted(here)
                plane = self._plane(here)
                slope = self._slope(here, plane)
            except (NotFound, np.linalg.LinAlgError):
                return found, "no convergence"
            size = float(np.hypot(*slope))
            if not size > 0.0:
                return found, "no convergence"
            up = slope / size
            ahead = np.array([-up[1], up[0]])
            whole = ahead @ plane
            if towards is None:
                leading = whole[-1] if abs(whole[-1]) > 1e-12 else whole[-2]
                ahead = ahead * math.copysign(1.0, sign * leading)
            elif self._product(whole, towards) < 0.0:
                ahead = -ahead
            after = None
            while step >= _SMALLEST:
                after = self._corrected(here, plane, ahead, up, size, step)
                if after is not None:
                    break
                step *= 0.4
            if after is None:
                return found, "border" if self._at_edge(here.state.setting) else "no convergence"
            if after.state.kind == AT_REST or after.state.speed < 0.2 * here.state.speed:
                return found, "circle"
            towards = ahead @ plane
            if after.state.system.size != here.state.system.size:
                towards = None
            here = after
            found.append(self._special(here))
            step = min(1.5 * step, self.largest)
            if self.point.kind == HOPF and abs(here.value.imag) < _SLOW:
                return found, "double zero"
            if self._outside(here.state.setting):
                return found, "border"
            if len(found) > 8 and self._near_start(here):
                return found, "closed"
        return found, "points"

    def _special(self, at: _At) -> SpecialPoint:
        setting = at.state.setting
        frequency = abs(at.value.imag) if self.point.kind == HOPF else 0.0
        return SpecialPoint(
            self.point.kind, self.point.symmetry, self.names[0], setting.value(self.names[0]),
            frequency, at.state, at.vector, math.nan,
        )  # fmt: skip

    def _outside(self, setting: Setting) -> bool:
        values = [setting.value(name) for name in self.names]
        return any(
            not low <= value <= high for value, (low, high) in zip(values, self.box, strict=True)
        )

    def _at_edge(self, setting: Setting) -> bool:
        values = [setting.value(name) for name in self.names]
        return any(value in edges for value, edges in zip(values, self.box, strict=True))

    def _near_start(self, at: _At) -> bool:
        first, here = self.point.state.setting, at.state.setting
        apart = [
            abs(here.value(name) - first.value(name)) * math.sqrt(weight)
            for name, weight in zip(self.names, self.weights, strict=True)
        ]
        return (
            max(apart) < 0.4 * self.largest and abs(at.state.speed - self.point.state.speed) < 1e-3
        )

    def _product(self, a: np.ndarray, b: np.ndarray) -> float:
        if a.size != b.size:
            return float(a[-2:] @ (self.weights * b[-2:]))
        return float(a[-2:] @ (self.weights * b[-2:]) + (a[:-2] @ b[:-2]) / a.size)

    def _at_state(self, state: SteadyState, value: complex, vector: np.ndarray | None) -> _At:
        system, y = state.system, state.unknowns
        reference = system.unpack(y)[0]
        _, now, whole = system.evaluate(state.setting, y, state.phi, reference)
        jacobian = system.jacobian(state.setting, y, now, whole, reference)
        found, changed = state.block(self.point.symmetry).near(value, vector)
        return _At(state, jacobian, found, changed)

    def _refitted(self, at: _At) -> _At:
        """Return the same on other nodes where the shape asks for them."""
        state = at.state
        mesh = better_mesh(state.system, state.unknowns)
        if mesh is None or self.point.kind == FOLD:
            return at
        system, y = resampled(state.system, state.unknowns, mesh)
        root = system.solve(state.setting, y, np.full(system.nodes, float(state.phi.mean())))
        return self._at_state(SteadyState.of(state.setting, system, root), at.value, None)

    def _by(self, state: SteadyState) -> np.ndarray:
        reference = state.system.unpack(state.unknowns)[0]
        return np.array(
            [
                state.system.by_parameter(state.setting, name, state.unknowns, state.phi, reference)
                for name in self.names
            ]
        ).T

    def _plane(self, at: _At) -> np.ndarray:
        """Return two orthonormal directions in the surface, shape (2, unknowns + 2)."""
        system = at.state.system
        size = system.size
        wide = np.hstack([at.jacobian, self._by(at.state)])
        weights = np.concatenate([system.weights(), self.weights])
        rotated, _ = np.linalg.qr(wide.T, mode="complete")
        plane = rotated.T[size:]
        made: list[np.ndarray] = []
        for vector in plane:
            for other in made:
                vector = vector - float(other @ (weights * vector)) * other
            made.append(vector / math.sqrt(float(vector @ (weights * vector))))
        return np.array(made)

    def _on_surface(self, at: _At, plane: np.ndarray, place: np.ndarray) -> _At:
        """Return the state over a place on the tangent plane of another."""
        state, system = at.state, at.state.system
        start = np.concatenate([state.unknowns, [state.setting.value(name) for name in self.names]])
        weights = np.concatenate([system.weights(), self.weights])
        rows = plane * weights
        wanted = start + place @ plane
        z, phi = wanted.copy(), state.phi
        reference = system.unpack(state.unknowns)[0]
        by = self._by(state)
        try:
            for _ in range(_MOST_STEPS):
                setting = self._set(state.setting, z[-2:])
                residual, now, whole = system.evaluate(setting, z[:-2], phi, reference)
                phi = now.at.phi
                jacobian = system.jacobian(setting, z[:-2], now, whole, reference)
                bordered = np.vstack([np.hstack([jacobian, by]), rows])
                change = np.linalg.solve(bordered, -np.concatenate([residual, rows @ (z - wanted)]))
                z = z + change
                size = math.sqrt(float(weights @ (change * change)))
                if not math.isfinite(size) or size > 1.0:
                    raise NotFound("the step is too long")
                if size < _SETTLED:
                    break
            else:
                raise NotFound("Newton's method did not settle")
            setting = self._set(state.setting, z[-2:])
        except OutOfRange:
            raise NotFound("the forces have no balance") from None
        except ValueError as error:
            raise NotFound(str(error)) from None
        found = SteadyState(setting, system, z[:-2], phi)
        return self._at_state(found, at.value, at.vector)

    def _set(self, setting: Setting, values: np.ndarray) -> Setting:
        for name, value in zip(self.names, values, strict=True):
            setting = setting.replace(name, float(value))
        return setting

    def _slope(self, at: _At, plane: np.ndarray) -> np.ndarray:
        """Return the derivative of the growth rate's real part on the plane, shape (2,)."""
        slopes = []
        for place in np.eye(2) * _DIFFERENCE:
            try:
                away = self._on_surface(at, plane, place).test - at.test
            except NotFound:  # a parameter at its end
                away = at.test - self._on_surface(at, plane, -place).test
            slopes.append(away / _DIFFERENCE)
        return np.array(slopes)

    def _corrected(
        self,
        at: _At,
        plane: np.ndarray,
        ahead: np.ndarray,
        up: np.ndarray,
        slope: float,
        step: float,
    ) -> _At | None:
        """Return the point of the curve about a step ahead, by secant steps across it."""

        def found(across: float) -> _At:
            return self._on_surface(at, plane, step * ahead + across * up)

        try:
            after = _secant(found, slope, step)
        except (NotFound, np.linalg.LinAlgError):
            return None
        return after if after is not None and _is_the_same(at, after) else None


def _is_the_same(before: _At, after: _At) -> bool:
    """Whether two growth rates at neighbouring states belong to one change of the cell."""
    size = np.linalg.norm(before.vector) * np.linalg.norm(after.vector)
    alike = abs(complex(np.vdot(before.vector, after.vector))) / size
    return bool(alike > _ALIKE)


def _secant(found: Callable[[float], _At], slope: float, step: float) -> _At | None:
    across = 0.0
    here = found(across)
    for _ in range(8):
        change = -here.test / slope
        if abs(across + change) > 0.7 * step:
            return None
        if abs(change) < 1e-9:
            return here
        after = found(across + change)
        if after.test != here.test:
            slope = (after.test - here.test) / change
        across, here = across + change, after
        if abs(here.test) < 1e-9:
            return here
    return None
