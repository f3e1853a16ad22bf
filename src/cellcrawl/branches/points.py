"""Special points of a branch: where it folds, and where a growth rate crosses zero."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final

import numpy as np
import xarray as xr

from cellcrawl.branches.spectrum import ANTISYMMETRIC, SYMMETRIC, unstable_count
from cellcrawl.branches.state import SteadyState
from cellcrawl.branches.system import NotFound, System
from cellcrawl.parameters import Parameters
from cellcrawl.threads import on_one_thread

if TYPE_CHECKING:
    from cellcrawl.branches.curves import PointCurve

FOLD, HOPF, PITCHFORK, CIRCLE, BRANCHING = "fold", "Hopf", "pitchfork", "circle", "branch point"
MEANINGS: Final = {
    FOLD: "the branch turns round: no such state beyond",
    HOPF: "a pair of growth rates crosses the axis: oscillations begin or end",
    PITCHFORK: "the mirror axis is lost: states that turn left and right branch off",
    CIRCLE: "the branch meets the resting circle",
    BRANCHING: "a real growth rate crosses zero: another branch of the same symmetry crosses",
}
_MOST_TRIES = 40
_REAL = 1e-7


@dataclass(frozen=True, eq=False)
class SpecialPoint:
    """A point at which the cell's fate changes.

    Attributes
    ----------
    kind : str
        One of `MEANINGS`: "fold", "Hopf", "pitchfork", "circle", "branch point".
    symmetry : str
        Of the change that neither grows nor decays: "symmetric", "antisymmetric", "" without a
        mirror axis.
    name, value : str, float
        The parameter that was followed and its value here.
    frequency : float
        Angular frequency of the change; 0 for a real growth rate.
    state : SteadyState
        The cell.
    vector : array, shape (m,)
        The change, as `SteadyState.eigenvector` spreads it.
    position : float
        Where on the branch: number of the state before, and how far to the next.
    """

    kind: str
    symmetry: str
    name: str
    value: float
    frequency: float
    state: SteadyState
    vector: np.ndarray | None
    position: float

    @property
    def parameters(self) -> Parameters:
        """Parameters of the cell."""
        return self.state.parameters

    def eigenvector(self, nodes: int = 256) -> tuple[np.ndarray, np.ndarray, Any]:
        """Return changes of angle, bound fraction and length, at equal arclengths, complex."""
        if self.vector is None:
            nothing = np.zeros(nodes, complex)
            return nothing, nothing, 0.0
        return self.state.spread(self.state.block(self.symmetry), self.vector, nodes)

    def continue_in(self, second: str, **options: Any) -> PointCurve:
        """Follow the point in a second parameter; see `cellcrawl.branches.curve_of`."""
        from cellcrawl.branches.curves import curve_of

        return curve_of(self, second, **options)

    def branch_off(self, *, amplitude: float = 0.01) -> SteadyState:
        """Return a state that leaves the branch here; see `cellcrawl.branches.branch_off`."""
        from cellcrawl.branches.switching import branch_off

        return branch_off(self, amplitude=amplitude)

    def dataset(self, amplitude: float = 0.1, nodes: int = 256) -> xr.Dataset:
        """Return the cell, and the cell with the change added and taken away, as three records."""
        from cellcrawl.branches.records import as_dataset

        cells = [self.state]
        if self.vector is not None:
            y = self._direction()
            largest = float(np.abs(y[: 2 * self.state.system.nodes]).max())
            for sign in (1.0, -1.0):
                cells.append(self._moved(sign * amplitude / largest * y))
        return as_dataset(cells, nodes)

    def _direction(self) -> np.ndarray:
        return change_of_whole(self.state, self.symmetry, self.vector)

    def _moved(self, change: np.ndarray) -> SteadyState:
        state = self.state
        system = System(state.mesh, mirror=False)
        y = system.pack(state.fields, 0.0, state.turning_rate) + change
        phi = state.phi
        if state.system.mirror:
            phi = state.mesh.unfolded(phi, 1.0)
        return SteadyState(state.setting, system, y, phi)

    def __repr__(self) -> str:
        spin = f", frequency {self.frequency:.6g}" if self.frequency else ""
        return f"SpecialPoint({self.kind}, {self.name} = {self.value:.9g}{spin})"


def change_of_whole(state: SteadyState, symmetry: str, vector: np.ndarray | None) -> np.ndarray:
    """Return a vector of a block as a change of the unknowns of a whole edge."""
    assert vector is not None
    count, mesh = state.system.nodes, state.mesh
    full = state.block(symmetry).on_nodes(vector.real, count)
    w, n = full[:count], full[count : 2 * count]
    if state.system.mirror:
        parity = -1.0 if symmetry == SYMMETRIC else 1.0
        w, n = mesh.unfolded(w, parity), mesh.unfolded(n, -parity)
    return np.concatenate([w, n, [full[-1], 0.0], np.zeros(4)])


class Between:
    """The piece of a branch between two neighbouring states, by its distance along the chord."""

    def __init__(self, name: str, weight: float, first: SteadyState, last: SteadyState) -> None:
        from cellcrawl.branches.resolution import resampled

        self.name, self.weight, self.first = name, weight, first
        system, y = last.system, last.unknowns
        other = first.unknowns
        if first.mesh != last.mesh:
            finer = first if first.mesh.nodes > last.mesh.nodes else last
            if finer is first:
                system, y = resampled(last.system, last.unknowns, first.mesh)
            else:
                system, other = resampled(first.system, first.unknowns, last.mesh)
        self.system, self.y, self.chord = system, other, y - other
        self.value = first.setting.value(name)
        self.reach = last.setting.value(name) - self.value
        self.setting = first.setting
        phi = last.phi
        if phi.size != system.nodes:
            phi = np.full(system.nodes, float(phi.mean()))
        self.phi = phi
        self.known: list[tuple[float, np.ndarray, float]] = [
            (0.0, self.y, self.value), (1.0, self.y + self.chord, self.value + self.reach),
        ]  # fmt: skip

    def at(self, part: float) -> SteadyState:
        """Return the state a part of the way along the chord.

        Raises
        ------
        NotFound
            If Newton's method does not come to it.
        """
        y, value = self._guess(part)
        chord = np.append(self.chord, self.reach)
        along = (self.name, chord, self.weight, value)
        root = self.system.solve(self.setting, y, self.phi, along=along)
        self.phi = root.phi
        self.known.append((part, root.unknowns, root.parameter))
        setting = self.setting.replace(self.name, root.parameter)
        return self.first.of(setting, self.system, root)

    def _guess(self, part: float) -> tuple[np.ndarray, float]:
        """Interpolate between up to four states known nearest."""
        near = sorted(self.known, key=lambda one: abs(one[0] - part))[:4]
        y, value = np.zeros_like(self.y), 0.0
        for k, (at, known, known_value) in enumerate(near):
            weight = math.prod(
                (part - other[0]) / (at - other[0]) for j, other in enumerate(near) if j != k
            )
            y += weight * known
            value += weight * known_value
        return y, value


def zero_between(function: Callable[[float], float], left: float, right: float) -> float:
    """Return where a function of the part between 0 and 1 vanishes; ``left``, ``right`` its ends.

    Bracketed secant steps (Illinois), to rounding of the part or of the function.
    """
    a, b, fa, fb = 0.0, 1.0, left, right
    side, part = 0, 0.5
    for _ in range(_MOST_TRIES):
        part = (a * fb - b * fa) / (fb - fa)
        part = min(max(part, a + 1e-3 * (b - a)), b - 1e-3 * (b - a))
        value = function(part)
        if value == 0.0 or b - a < 1e-11 or abs(value) < 1e-11:
            break
        if (value > 0.0) == (fb > 0.0):
            b, fb = part, value
            fa = 0.5 * fa if side == 1 else fa
            side = 1
        else:
            a, fa = part, value
            fb = 0.5 * fb if side == -1 else fb
            side = -1
    return part


@on_one_thread
def crossings(
    name: str, weight: float, first: SteadyState, last: SteadyState, position: int
) -> list[SpecialPoint]:
    """Return the points between two states at which growth rates cross zero.

    The real parts in order are continuous along the branch: that of the last which grows on one
    side and none on the other has one zero at least between them.
    """
    found = []
    for symmetry, before in first.eigenvalues_by_symmetry.items():
        after = last.eigenvalues_by_symmetry[symmetry]
        counts = unstable_count(before), unstable_count(after)
        rank = max(counts)
        while rank > min(counts):
            between = Between(name, weight, first, last)
            state, value, vector = _crossing(between, symmetry, rank, before, after)
            rank -= 1 if abs(value.imag) < _REAL else 2
            if state is None:
                continue
            part = between.known[-1][0]
            kind = _kind(symmetry, value)
            found.append(
                SpecialPoint(
                    kind,
                    symmetry,
                    name,
                    state.setting.value(name),
                    abs(value.imag),
                    state,
                    vector,
                    position + part,
                )
            )
    return sorted(found, key=lambda point: point.position)


def _kind(symmetry: str, value: complex) -> str:
    if abs(value.imag) > _REAL:
        return HOPF
    return PITCHFORK if symmetry == ANTISYMMETRIC else BRANCHING


def _crossing(
    between: Between, symmetry: str, rank: int, before: np.ndarray, after: np.ndarray
) -> tuple[SteadyState | None, complex, np.ndarray]:
    """Return the state at which the real part of the ``rank``-th growth rate vanishes."""
    states: dict[float, tuple[SteadyState, complex, np.ndarray | None]] = {}

    def real_part(part: float) -> float:
        state = between.at(part)
        block = state.block(symmetry)
        near = min(states, key=lambda at: abs(at - part)) if states else None
        if near is not None and abs(near - part) < 0.02 and abs(states[near][1].real) < 0.1:
            value, vector = block.near(states[near][1], states[near][2])
        else:
            value = complex(np.sort_complex(block.eigenvalues)[::-1][rank - 1])
            value, vector = block.near(value)
        states[part] = state, value, vector
        return value.real

    def ends(values: np.ndarray) -> float:
        return float(np.sort(values.real)[::-1][rank - 1])

    try:
        part = zero_between(real_part, ends(before), ends(after))
    except NotFound:
        kept = complex(before[rank - 1]) if rank <= before.size else 0.0
        return None, kept, np.zeros(0)
    state, value, vector = states[part]
    assert vector is not None
    between.known.append((part, state.unknowns, state.setting.value(between.name)))
    return state, value, vector


def fold_between(
    name: str,
    weight: float,
    first: SteadyState,
    last: SteadyState,
    slopes: tuple[float, float],
    position: int,
) -> SpecialPoint | None:
    """Return the point between two states at which the parameter turns round.

    ``slopes`` are the parameter's parts in the tangents at both.
    """
    between = Between(name, weight, first, last)
    states: dict[float, SteadyState] = {}
    chord = np.append(between.chord, between.reach)
    row = np.append(between.system.weights() * chord[:-1], weight * chord[-1])

    def slope(part: float) -> float:
        y, value = between._guess(part)
        along = (name, chord, weight, value)
        root = between.system.solve(between.setting, y, between.phi, along=along)
        between.phi = root.phi
        between.known.append((part, root.unknowns, root.parameter))
        setting = between.setting.replace(name, root.parameter)
        states[part] = SteadyState.of(setting, between.system, root)
        bordered = np.block([[root.jacobian, root.by_parameter[:, None]], [row[None, :]]])
        tangent = np.linalg.solve(bordered, np.append(np.zeros(row.size - 1), 1.0))
        return float(tangent[-1])

    try:
        part = zero_between(slope, slopes[0], slopes[1])
    except (NotFound, np.linalg.LinAlgError):
        return None
    state = states[part]
    symmetry = SYMMETRIC if state.system.mirror else ""
    _, vector = state.block(symmetry).near(0.0)
    return SpecialPoint(
        FOLD, symmetry, name, state.setting.value(name), 0.0, state, vector, position + part
    )
