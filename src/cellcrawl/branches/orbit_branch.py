"""Orbits followed in a parameter, with the points at which they lose or gain their hold."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from cellcrawl.arguments import checked
from cellcrawl.branches.flow import Flow
from cellcrawl.branches.orbit import Orbit, nodes_or_none
from cellcrawl.branches.setting import bounds_of
from cellcrawl.branches.shooting import COARSE, Border, answer, close, scaled, unscaled
from cellcrawl.branches.system import NotFound
from cellcrawl.errors import InputError
from cellcrawl.parameters import Parameters
from cellcrawl.threads import on_one_thread
from cellcrawl.validation import real_number, whole_number

if TYPE_CHECKING:
    import pandas as pd

FOLD, DOUBLING, TORUS = "fold", "period doubling", "torus"
PITCHFORK, BRANCHING = "pitchfork", "branch point"
ORBIT_MEANINGS: Final = {
    FOLD: "the branch turns round: no such orbit beyond",
    DOUBLING: "a multiplier passes -1: every second period is alike from here",
    TORUS: "a pair of multipliers leaves the circle: a second rhythm begins",
    PITCHFORK: "left and right cease to be alike: lopsided orbits branch off",
    BRANCHING: "a real multiplier passes 1: another branch of orbits crosses",
}
ORBIT_ENDS: Final = {
    "completed": "the parameter has come to the value asked for",
    "bound": "the parameter has come to the end of its range",
    "steady": "the orbit shrank to a steady state",
    "no convergence": "Newton's method closed no next orbit even for the smallest step",
    "orbits": "the branch has as many orbits as asked for",
    "interrupted": "stopped by the user; can go on",
    "running": "not ended: still going, or killed; can go on",
}
"""How a branch of orbits can end."""

_FIRST, _SMALLEST, _LARGEST = 0.01, 1e-4, 0.06
_TOO_FAR = 0.15  # change of the shape in one step
_TRIES = 6
_SETTLED = 1e-5  # of a multiplier's distance from the circle
_AT_REST = 2e-3
_REAL = 1e-6
_COLUMNS = 6


@dataclass(frozen=True, eq=False)
class OrbitPoint:
    """A point at which an orbit's fate changes.

    Attributes
    ----------
    kind : str
        One of `ORBIT_MEANINGS`: "fold", "period doubling", "torus", "pitchfork", "branch point".
    name, value : str, float
        The parameter that was followed and its value here.
    multiplier : complex
        The one on the unit circle.
    orbit : Orbit
    position : float
        Where on the branch: number of the orbit before, and how far to the next.
    """

    kind: str
    name: str
    value: float
    multiplier: complex
    orbit: Orbit
    position: float

    @property
    def parameters(self) -> Parameters:
        """Parameters of the cell."""
        return self.orbit.parameters

    def __repr__(self) -> str:
        return f"OrbitPoint({self.kind}, {self.name} = {self.value:.7g})"


class OrbitBranch:
    """Orbits followed in one parameter.

    Made by `Orbit.continue_in`; `open_orbits` reads one from a file.

    Attributes
    ----------
    name, to : str, float
        The parameter that was followed, and to where.
    orbits : list of Orbit
    special_points : list of OrbitPoint
    status, message : str
        How the branch ended, one of `ORBIT_ENDS`, and what that means.
    spectra : bool
        Whether multipliers were found.
    """

    def __init__(self, name: str, to: float, orbits: list[Orbit], *, spectra: bool) -> None:
        self.name, self.to, self.orbits, self.spectra = name, to, orbits, spectra
        self.special_points: list[OrbitPoint] = []
        self.status, self.message = "running", ""
        self.nodes: int | None = None  # fixed, or as many as each shape asks for

    @property
    def values(self) -> np.ndarray:
        """Values of the parameter, shape (orbits,)."""
        return np.array([one.setting.value(self.name) for one in self.orbits])

    def points(self, kind: str) -> list[OrbitPoint]:
        """Return the special points of a kind."""
        return [point for point in self.special_points if point.kind == kind]

    def end(self, status: str) -> None:
        """Say how the branch ended."""
        last = self.orbits[-1]
        self.status = status
        self.message = (
            f"{ORBIT_ENDS[status]}: {self.name} = {last.setting.value(self.name):.6g}, period "
            f"{last.period:.5g}"
        )

    def table(self) -> pd.DataFrame:
        """Return a row for each orbit, with multipliers where they were found."""
        import pandas as pd

        rows = []
        for one in self.orbits:
            low, high = one.tension_range
            row: dict[str, Any] = {
                self.name: one.setting.value(self.name), "kind": one.kind, "period": one.period,
                "turn": one.turn, "speed": one.speed, "speed_least": one.speed_range[0],
                "speed_largest": one.speed_range[1], "tension_least": low,
                "tension_largest": high, "circularity": one.circularity, "nodes": one.nodes,
            }  # fmt: skip
            if self.spectra:
                row["unstable_modes"], row["stable"] = one.unstable_modes, one.stable
                for k, value in enumerate(one.multipliers[:_COLUMNS]):
                    row[f"multiplier_{k}"], row[f"multiplier_{k}_imag"] = value.real, value.imag
            rows.append(row)
        return pd.DataFrame(rows)

    def __len__(self) -> int:
        return len(self.orbits)

    def __iter__(self) -> Iterator[Orbit]:
        return iter(self.orbits)

    def __getitem__(self, index: int) -> Orbit:
        return self.orbits[index]

    def __repr__(self) -> str:
        values = self.values
        points = ", ".join(f"{p.kind} at {p.value:.6g}" for p in self.special_points)
        return (
            f"OrbitBranch({self.name} from {values[0]:g} to {values[-1]:g}, {len(self)} orbits, "
            f"{self.status}{': ' + points if points else ''})"
        )


@dataclass
class OrbitWalker:
    """How a branch of orbits goes on: the change from one orbit to the next, and the step.

    ``tangent`` holds a change of shape (coarse nodes, scaled), of period, and of the parameter, of
    length 1 in the norm in which period and parameter count by their own size.
    """

    tangent: np.ndarray
    step: float


@checked
def continue_orbit(
    start: Orbit,
    name: str,
    to: float,
    *,
    output: str | Path | None = None,
    overwrite: bool = False,
    spectra: bool = True,
    most_orbits: int = 60,
    largest_step: float = _LARGEST,
    nodes: int | None = None,
) -> OrbitBranch:
    """Follow an orbit as a parameter changes, round folds, up to the value asked.

    Parameters
    ----------
    start : Orbit
        Where to begin.
    name : str
        A parameter of the model or of the law.
    to : float
        The value at which to stop; the branch sets out towards it.
    output : str or Path, optional
        A file for the branch, ``orbits.nc``, written after every orbit; `resume_orbits` goes on
        with one that was killed.
    overwrite : bool
        Replace what is there.
    spectra : bool
        Whether to find multipliers, and with them the special points.
    most_orbits : int
        Stop after so many, 2 to 10000.
    largest_step : float
        Largest step, 1e-3 to 0.5: of mean changes of angle and bound fraction, and of relative
        changes of period and parameter.
    nodes : int, optional
        Even nodes along the edge; as many as each shape asks for unless given.

    Raises
    ------
    InputError
        For a parameter that does not exist or a value out of its range.
    """
    low, high = bounds_of(start.setting.laws, name)
    to = real_number(f"to ({name})", to, low, high)
    count = whole_number("most_orbits", most_orbits, 2, 10_000)
    largest = real_number("largest_step", largest_step, 1e-3, 0.5)
    value = start.setting.value(name)
    if to == value:
        raise InputError(f"the orbit has {name} = {value:g} already: give another value to go to")
    start.setting.replace(name, to)  # refuses now what has no orbits
    branch = OrbitBranch(name, to, [start], spectra=spectra)
    branch.nodes = nodes_or_none(nodes)
    change, longer = on_one_thread(answer)(
        start.setting, name, start.reflected, coarse_shape(start), start.period, start.basis
    )
    tangent = np.concatenate([change, [longer, 1.0]])
    tangent *= math.copysign(1.0, to - value) / _length(tangent, _weights(start, name))
    walker = OrbitWalker(tangent, min(_FIRST, largest))
    return walk(branch, walker, count, largest, output, overwrite)


@on_one_thread
def walk(
    branch: OrbitBranch,
    walker: OrbitWalker,
    most: int,
    largest: float,
    output: str | Path | None = None,
    overwrite: bool = False,
) -> OrbitBranch:
    """Go on with a branch until it ends."""
    from cellcrawl.branches.orbit_storage import Keeper

    with Keeper(output, overwrite) as keeper:
        try:
            status = _walk(branch, walker, most, largest, keeper)
        except KeyboardInterrupt:
            status = "interrupted"
        branch.end(status)
        keeper.keep(branch, walker)
    return branch


def _walk(branch: OrbitBranch, walker: OrbitWalker, most: int, largest: float, keeper: Any) -> str:
    name = branch.name
    low, high = bounds_of(branch.orbits[0].setting.laws, name)
    while len(branch.orbits) < most:
        before = branch.orbits[-1]
        value, slope = before.setting.value(name), float(walker.tangent[-1])
        bound = low if slope < 0.0 else high
        for end, status in ((branch.to, "completed"), (bound, "bound")):
            reached = (end - value) * slope
            if reached >= 0.0 and abs(slope) * walker.step >= abs(end - value):
                last = _at_value(before, walker, name, end, branch.nodes)
                if last is not None:
                    _join(branch, walker, last)
                    return status
        after = _advance(before, walker, name, (low, high), branch.nodes)
        if after is None:
            return "no convergence"
        if after.shape.size and _swing(after) < _AT_REST:
            return "steady"
        _join(branch, walker, after)
        walker.step = min(walker.step, largest)
        keeper.keep(branch, walker)
    return "orbits"


def _swing(one: Orbit) -> float:
    flow = Flow(one.setting, one.nodes)
    return flow.norm(flow.pace(one.shape)) * one.period


def coarse_shape(one: Orbit) -> np.ndarray:
    """Return an orbit's first shape on the coarse nodes."""
    if one.nodes == COARSE:
        return one.shape
    return Flow(one.setting, one.nodes).resampled(one.shape, COARSE)


def _apart(before: Orbit, after: Orbit, name: str) -> np.ndarray:
    """Return the change between two orbits of a branch, the first moved to the same instant."""
    shape = scaled(coarse_shape(after) - coarse_shape(before))
    shift = after.setting.value(name) - before.setting.value(name)
    return np.concatenate([shape, [after.period - before.period, shift]])


def _weights(one: Orbit, name: str) -> tuple[float, float]:
    """Weights of the squares of a change of period and of the parameter."""
    return one.period**-2, max(abs(one.setting.value(name)), 1e-3) ** -2


def _length(change: np.ndarray, weights: tuple[float, float]) -> float:
    square = float(change[:-2] @ change[:-2])
    return math.sqrt(square + weights[0] * change[-2] ** 2 + weights[1] * change[-1] ** 2)


def _join(branch: OrbitBranch, walker: OrbitWalker, after: Orbit) -> None:
    before, name = branch.orbits[-1], branch.name
    change = _apart(before, after, name)
    old = float(walker.tangent[-1])
    walker.tangent = change / _length(change, _weights(after, name))
    found: list[OrbitPoint] = []
    position = len(branch.orbits) - 1
    turned = old * float(walker.tangent[-1]) < 0.0 and position > 0
    if turned:
        found.append(_fold(branch, after, position))
    if branch.spectra:
        found += _passed(name, before, after, position, turned, branch.nodes)
    branch.orbits.append(after)
    branch.special_points += found


def _advance(
    before: Orbit, walker: OrbitWalker, name: str, bounds: tuple[float, float], nodes: int | None
) -> Orbit | None:
    """Return the next orbit a step ahead, or nothing if even the smallest fails."""
    value = before.setting.value(name)
    while walker.step >= _SMALLEST:
        ahead = walker.step * walker.tangent
        ahead[-1] = min(max(value + float(ahead[-1]), bounds[0]), bounds[1]) - value
        after = _ahead(before, ahead, walker.tangent, name, nodes)
        if after is None:
            walker.step *= 0.4
            continue
        change = _apart(before, after, name)
        far = float(np.linalg.norm(change[:-2]))
        if far > _TOO_FAR and walker.step > 2.0 * _SMALLEST:
            walker.step *= 0.5
            continue
        walker.step *= 1.6 if far < 0.5 * _TOO_FAR else 1.0
        return after
    return None


def _ahead(
    before: Orbit, change: np.ndarray, tangent: np.ndarray, name: str, nodes: int | None
) -> Orbit | None:
    """Return the orbit a change away, that and the parameter across a tangent: also at folds."""
    weights = _weights(before, name)
    border = Border(
        name, tangent[:-2], weights[0] * float(tangent[-2]), float(tangent[-1]), weights[1]
    )
    try:
        value = before.setting.value(name) + float(change[-1])
        setting = before.setting.replace(name, value)
        guess = Flow(setting, COARSE).canonical(coarse_shape(before) + unscaled(change[:-2]))
        found = close(
            setting, before.reflected, guess, before.period + float(change[-2]),
            nodes=nodes, border=border,
        )  # fmt: skip
    except (NotFound, np.linalg.LinAlgError, InputError):
        return None
    return Orbit.of(setting.replace(name, found.parameter), before.reflected, found)


def _at_value(
    before: Orbit, walker: OrbitWalker, name: str, value: float, nodes: int | None
) -> Orbit | None:
    """Return the orbit at a given value just ahead."""
    part = (value - before.setting.value(name)) / float(walker.tangent[-1])
    ahead = part * walker.tangent
    return _near(before, ahead[:-2], float(ahead[-2]), name, value, nodes)


def _near(
    before: Orbit, change: np.ndarray, longer: float, name: str, value: float, nodes: int | None
) -> Orbit | None:
    try:
        setting = before.setting.replace(name, value)
        guess = Flow(setting, COARSE).canonical(coarse_shape(before) + unscaled(change))
        found = close(setting, before.reflected, guess, before.period + longer, nodes=nodes)
    except (NotFound, InputError):  # at the end of a range there may be no orbits
        return None
    return Orbit.of(setting, before.reflected, found)


def _fold(branch: OrbitBranch, after: Orbit, position: int) -> OrbitPoint:
    """Return the point at which the parameter turned round, on a parabola through three orbits."""
    name = branch.name
    first, middle = branch.orbits[-2], branch.orbits[-1]
    weights = _weights(middle, name)
    s = [0.0, _length(_apart(first, middle, name), weights)]
    s.append(s[1] + _length(_apart(middle, after, name), weights))
    p = [one.setting.value(name) for one in (first, middle, after)]
    a, b, _ = np.polyfit(s, p, 2)
    at = float(-b / (2.0 * a))
    value = float(np.polyval([a, b, np.polyfit(s, p, 2)[2]], at))
    near = (at - s[1]) / (s[2] - s[1])
    return OrbitPoint(FOLD, name, value, 1.0 + 0.0j, middle, position + min(max(near, 0.0), 1.0))


def _tests(values: np.ndarray) -> dict[str, float]:
    """Return how far the leading real and complex multipliers are from the circle."""
    complex_ones = np.abs(values.imag) > _REAL
    real = values[~complex_ones].real
    sizes = np.abs(values[complex_ones])
    return {
        "+": float(real.max()) - 1.0 if real.size else -1.0,
        "-": -float(real.min()) - 1.0 if real.size else -1.0,
        "pair": float(sizes.max()) - 1.0 if sizes.size else -1.0,
    }


def _passed(
    name: str, before: Orbit, after: Orbit, position: int, turned: bool, nodes: int | None
) -> list[OrbitPoint]:
    """Return the points between two orbits at which a multiplier crosses the unit circle."""
    ends = _tests(before.multipliers), _tests(after.multipliers)
    found = []
    for test in ("+", "-", "pair"):
        left, right = ends[0][test], ends[1][test]
        if left * right >= 0.0 or (test == "+" and turned):
            continue
        point = _locate(name, before, after, position, test, (left, right), nodes)
        if point is not None:
            found.append(point)
    return sorted(found, key=lambda point: point.position)


def _locate(
    name: str,
    before: Orbit,
    after: Orbit,
    position: int,
    test: str,
    ends: tuple[float, float],
    nodes: int | None,
) -> OrbitPoint | None:
    change = _apart(before, after, name)
    a, b, (fa, fb) = 0.0, 1.0, ends
    here, part = before, 0.0
    for _ in range(_TRIES):
        part = (a * fb - b * fa) / (fb - fa)
        made = _ahead(before, part * change, change, name, nodes)
        if made is None:
            return None
        here = made
        off = _tests(here.multipliers)[test]
        if abs(off) < _SETTLED:
            break
        if (off > 0.0) == (fb > 0.0):
            b, fb = part, off
        else:
            a, fa = part, off
    values = here.multipliers
    multiplier = complex(values[int(np.argmin(np.abs(np.abs(values) - 1.0)))])
    kind = {
        "+": BRANCHING, "-": PITCHFORK if before.reflected else DOUBLING, "pair": TORUS,
    }[test]  # fmt: skip
    return OrbitPoint(kind, name, here.setting.value(name), multiplier, here, position + part)
