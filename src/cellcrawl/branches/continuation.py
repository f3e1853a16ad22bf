"""A branch followed by pseudo-arclength: round folds, with step control, to a named end."""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

import numpy as np

from cellcrawl.arguments import checked
from cellcrawl.branches.branch import Branch
from cellcrawl.branches.points import (
    BRANCHING,
    CIRCLE,
    FOLD,
    PITCHFORK,
    SpecialPoint,
    crossings,
    fold_between,
)
from cellcrawl.branches.resolution import better_mesh, resampled
from cellcrawl.branches.setting import bounds_of
from cellcrawl.branches.state import AT_REST, SteadyState
from cellcrawl.branches.system import NotFound, Root, System
from cellcrawl.errors import InputError
from cellcrawl.threads import on_one_thread
from cellcrawl.validation import real_number, whole_number

_FIRST, _LARGEST, _SMALLEST = 0.02, 0.12, 1e-6
_TURN = 0.9  # least cosine between neighbouring tangents
_FALLEN = 0.2  # part of its speed that a cell may keep in one step before the step is too long
_GUESS = 3.0
ENDS: Final = {
    "completed": "the parameter has come to the value asked for",
    "circle": "the branch met the resting circle, where gliding begins",
    "gliding": "the branch met gliding states, where the turning rate vanishes",
    "bound": "the parameter has come to the end of its range",
    "no convergence": "Newton's method found no next state even for the smallest step",
    "states": "the branch has as many states as asked for",
    "closed": "the branch came back to where it began",
    "interrupted": "stopped by the user; can go on",
    "running": "not ended: still going, or killed; can go on",
}
"""How a branch can end."""


@dataclass
class Walker:
    """Where a branch has come to: a state, the direction in which it goes on, and the step."""

    name: str
    weight: float
    state: SteadyState
    tangent: np.ndarray
    step: float

    @property
    def slope(self) -> float:
        """The parameter's part in the direction."""
        return float(self.tangent[-1])


def tangent_of(system: System, root: Root, weight: float, along: np.ndarray) -> np.ndarray:
    """Return the direction of the branch at a root, of length 1, that goes with ``along``."""
    weights = np.append(system.weights(), weight)
    row = weights * along
    bordered = np.block([[root.jacobian, root.by_parameter[:, None]], [row[None, :]]])
    tangent = np.linalg.solve(bordered, np.append(np.zeros(row.size - 1), 1.0))
    return np.asarray(tangent / math.sqrt(float(weights @ (tangent * tangent))))


def weight_of(value: float, reach: float = 0.0) -> float:
    """Return the weight of a parameter's square: its own size is a change of 1.

    From 0, or nearly, a tenth of how far it is to go is one.
    """
    return 1.0 / max(abs(value), 0.1 * abs(reach), 1e-3) ** 2


@checked
def continue_in(
    state: SteadyState,
    name: str,
    to: float,
    *,
    output: str | Path | None = None,
    overwrite: bool = False,
    spectra: bool = True,
    most_states: int = 400,
    largest_step: float = _LARGEST,
) -> Branch:
    """Follow a steady state as a parameter changes, round folds, up to the value asked.

    Parameters
    ----------
    state : SteadyState
        Where to begin.
    name : str
        A parameter of the model or of the law.
    to : float
        The value of the parameter at which to stop; the branch sets out towards it.
    output : str or Path, optional
        A file for the branch, ``branch.nc``; written as it grows, so that a branch that was killed
        goes on with `resume_branch`.
    overwrite : bool
        Replace what is there.
    spectra : bool
        Whether to find growth rates at each state, and with them the special points.
    most_states : int
        Stop after so many states, 2 to 100000.
    largest_step : float
        Largest step, 1e-4 to 1: of mean changes of angle and bound fraction, and of the relative
        change of the parameter.

    Returns
    -------
    Branch
        The states in order, the special points, and in ``status`` and ``message`` how it ended.
        Nothing that was computed is lost, however it ends.

    Raises
    ------
    InputError
        For a parameter that does not exist or a value out of its range.
    """
    low, high = bounds_of(state.setting.laws, name)
    to = real_number(f"to ({name})", to, low, high)
    largest = real_number("largest_step", largest_step, 1e-4, 1.0)
    count = whole_number("most_states", most_states, 2, 100_000)
    value = state.setting.value(name)
    if to == value:
        raise InputError(f"the state has {name} = {value:g} already: give another value to go to")
    state.setting.replace(name, to)  # refuses now what has no states
    if state.kind == AT_REST:
        raise InputError(
            "this state is the resting circle, which is known at all parameters: begin from a "
            "gliding cell, or from its onset with cellcrawl.branches.from_circle"
        )
    branch = Branch(name, to, [state], spectra=spectra)
    walker = first_step(state, name, to - value, min(_FIRST, largest))
    return walk(branch, walker, count, largest, output, overwrite)


def first_step(state: SteadyState, name: str, reach: float, step: float) -> Walker:
    """Return a walker at a state that sets out to larger or smaller values, as reach says."""
    weight, sign = weight_of(state.setting.value(name), reach), math.copysign(1.0, reach)
    system, phi = state.system, state.phi
    reference = system.unpack(state.unknowns)[0]
    jac = _jacobian(state)
    by = system.by_parameter(state.setting, name, state.unknowns, phi, reference)
    root = Root(state.unknowns, state.setting.value(name), phi, jac, by, 0)
    along = np.append(np.zeros(system.size), sign / math.sqrt(weight))
    try:
        tangent = tangent_of(system, root, weight, along)
    except np.linalg.LinAlgError:
        raise InputError("the state is at a fold: the branch cannot set out from it") from None
    return Walker(name, weight, state, tangent, step)


def _jacobian(state: SteadyState) -> np.ndarray:
    system, y = state.system, state.unknowns
    reference = system.unpack(y)[0]
    _, now, of_whole = system.evaluate(state.setting, y, state.phi, reference)
    return system.jacobian(state.setting, y, now, of_whole, reference)


@on_one_thread
def walk(
    branch: Branch,
    walker: Walker,
    most_states: int,
    largest: float,
    output: str | Path | None = None,
    overwrite: bool = False,
) -> Branch:
    """Go on with a branch until it ends."""
    from cellcrawl.branches.storage import Keeper

    with Keeper(output, overwrite) as keeper:
        try:
            status = _walk(branch, walker, most_states, largest, keeper)
        except KeyboardInterrupt:
            status = "interrupted"
        branch.end(status, walker.step)
        keeper.keep(branch, walker, last=True)
    return branch


def _walk(branch: Branch, walker: Walker, most: int, largest: float, keeper: Any) -> str:
    low, high = bounds_of(walker.state.setting.laws, walker.name)
    while len(branch.states) < most:
        _refit(walker)
        before, slope = walker.state, walker.slope
        value = before.setting.value(walker.name)
        bound = low if slope < 0.0 else high
        for end, status in ((branch.to, "completed"), (bound, "bound")):
            reached = (end - value) * slope
            if reached >= 0.0 and abs(slope) * walker.step >= abs(end - value):
                last = _at_value(walker, end)
                if last is not None:
                    _join(branch, walker, before, last, (slope, slope))
                    return status
        status = _advance(walker, largest)
        if status:
            return status
        after = walker.state
        ended = _met(before, after)
        if ended:
            branch.add_points([_meeting(walker, before, after, ended, len(branch.states) - 1)])
            return ended
        _join(branch, walker, before, after, (slope, walker.slope))
        keeper.keep(branch, walker)
        if _came_back(branch, after):
            return "closed"
    return "states"


def _join(
    branch: Branch,
    walker: Walker,
    before: SteadyState,
    after: SteadyState,
    slopes: tuple[float, float],
) -> None:
    """Add a state to a branch, and the special points between it and the one before."""
    position = len(branch.states) - 1
    found: list[SpecialPoint] = []
    if slopes[0] * slopes[1] < 0.0:
        fold = fold_between(walker.name, walker.weight, before, after, slopes, position)
        found += [fold] if fold is not None else []
    if branch.spectra:
        passed = crossings(walker.name, walker.weight, before, after, position)
        folds = {FOLD} & {point.kind for point in found}
        found += [point for point in passed if not (folds and point.kind == BRANCHING)]
        after = after.without_matrices()
        branch.states[-1] = branch.states[-1].without_matrices()
    branch.states.append(after)
    branch.add_points(found)


def _refit(walker: Walker) -> None:
    """Take other nodes where the shape asks for them."""
    state = walker.state
    mesh = better_mesh(state.system, state.unknowns)
    if mesh is None:
        return
    system, y = resampled(state.system, state.unknowns, mesh)
    try:
        root = system.solve(state.setting, y, np.full(system.nodes, float(state.phi.mean())))
    except NotFound:
        return
    _, change = resampled(state.system, walker.tangent[:-1], mesh)
    walker.tangent = np.append(change, walker.tangent[-1])
    walker.state = SteadyState(
        state.setting, system, root.unknowns, root.phi, 0.0, dict(state._spectrum)
    )
    walker.state._spectrum.pop("blocks", None)


def _advance(walker: Walker, largest: float) -> str:
    """Make one step; return how the branch ended, or nothing."""
    state, system = walker.state, walker.state.system
    value = state.setting.value(walker.name)
    while walker.step >= _SMALLEST:
        ahead = walker.step * walker.tangent
        along = (walker.name, walker.tangent, walker.weight, value + ahead[-1])
        try:
            root = system.solve(state.setting, state.unknowns + ahead[:-1], state.phi, along=along)
            tangent = tangent_of(system, root, walker.weight, walker.tangent)
        except (NotFound, np.linalg.LinAlgError):
            walker.step *= 0.4
            continue
        weights = np.append(system.weights(), walker.weight)
        cosine = float(weights @ (tangent * walker.tangent))
        after = SteadyState.of(state.setting.replace(walker.name, root.parameter), system, root)
        fallen = after.kind == AT_REST or 0.0 <= _pace(after) < _FALLEN * _pace(state)
        if (cosine < _TURN or fallen) and walker.step > 4.0 * _SMALLEST:
            walker.step *= 0.4
            continue
        walker.state, walker.tangent = after, tangent
        if root.steps <= 3 and cosine > 0.5 * (1.0 + _TURN):
            walker.step = min(1.5 * walker.step, largest)
        elif root.steps >= 6:
            walker.step *= 0.6
        return ""
    return "no convergence"


def _pace(state: SteadyState) -> float:
    """Speed forwards along the mirror axis, or turning rate to the side first turned to."""
    if state.system.mirror:
        return float(state._motion.velocity[0])
    return state.turning_rate


def _met(before: SteadyState, after: SteadyState) -> str:
    """Return the end at which a branch goes through its own mirror image."""
    if _pace(before) * _pace(after) >= 0.0:
        return ""
    return "circle" if before.system.mirror else "gliding"


def _meeting(
    walker: Walker, before: SteadyState, after: SteadyState, end: str, position: int
) -> SpecialPoint:
    """Return the point at which a branch ends in one of more symmetry: halfway between images."""
    values = [state.setting.value(walker.name) for state in (before, after)]
    paces = [_pace(state) for state in (before, after)]
    squares = [pace * pace for pace in paces]
    if abs(squares[1] - squares[0]) > 1e-12 * max(squares):
        slope = (values[1] - values[0]) / (squares[1] - squares[0])
        value = values[0] - slope * squares[0]  # the branch is a parabola there
    else:
        value = 0.5 * (values[0] + values[1])
    if end == "circle":
        value = _nearest_onset(before, walker.name, value)
        return SpecialPoint(
            CIRCLE, "symmetric", walker.name, value, 0.0, before, None, position + 0.5
        )
    return SpecialPoint(PITCHFORK, "", walker.name, value, 0.0, before, None, position + 0.5)


def _nearest_onset(state: SteadyState, name: str, value: float) -> float:
    """Return where the circle's front neither grows nor decays, next to a value."""
    from cellcrawl.branches.circle import onsets

    setting = state.setting
    if setting.rest_area != math.pi:
        return value  # circles of another size
    low, high = bounds_of(setting.laws, name)
    low, high = max(low, value - 0.1 * abs(value)), min(high, value + 0.1 * abs(value))
    found = onsets(setting.parameters, name, low, high, laws=setting.laws)
    return min(found, key=lambda one: abs(one - value)) if found else value


def _at_value(walker: Walker, value: float) -> SteadyState | None:
    """Return the state at a given value just ahead."""
    state, system = walker.state, walker.state.system
    part = (value - state.setting.value(walker.name)) / walker.slope
    guess = state.unknowns + part * walker.tangent[:-1]
    try:
        setting = state.setting.replace(walker.name, value)
        root = system.solve(setting, guess, state.phi)
    except (NotFound, InputError):  # at the end of a range there may be no states
        return None
    found = SteadyState.of(setting, system, root)
    return None if found.kind == AT_REST else found


def _came_back(branch: Branch, state: SteadyState) -> bool:
    """Whether a branch is a closed loop and has come round."""
    first = branch.states[0]
    if len(branch.states) < 20 or first.mesh != state.mesh:
        return False
    near = abs(first.setting.value(branch.name) / state.setting.value(branch.name) - 1.0)
    return near < 1e-3 and state.system.norm(state.unknowns - first.unknowns) < 1e-3
