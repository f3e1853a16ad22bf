"""From a special point to the states that leave the branch there."""

from __future__ import annotations

import math

import numpy as np

from cellcrawl.arguments import checked
from cellcrawl.branches.circle import from_circle
from cellcrawl.branches.continuation import weight_of
from cellcrawl.branches.points import (
    BRANCHING,
    CIRCLE,
    HOPF,
    PITCHFORK,
    SpecialPoint,
    change_of_whole,
)
from cellcrawl.branches.spectrum import ANTISYMMETRIC
from cellcrawl.branches.state import SteadyState
from cellcrawl.branches.system import NotFound, System
from cellcrawl.errors import InputError
from cellcrawl.threads import on_one_thread
from cellcrawl.validation import real_number

_STILL = 1e-5  # turning rate of a state that has fallen back onto gliding ones


@checked
@on_one_thread
def branch_off(point: SpecialPoint, *, amplitude: float = 0.01) -> SteadyState:
    """Return a state on the branch that leaves at a special point.

    Parameters
    ----------
    point : SpecialPoint
        A pitchfork, where turning cells leave gliding ones; the circle's onset, where gliding ones
        leave it; or a branch point.
    amplitude : float
        Mean change of angle and bound fraction, 1e-4 to 0.3; below 0 for the mirror image.

    Raises
    ------
    InputError
        At a fold, where nothing leaves; at a Hopf point, where orbits do; or if no state is found.
    """
    size = real_number("amplitude", amplitude, -0.3, 0.3)
    if abs(size) < 1e-4:
        raise InputError(f"amplitude = {size:g} must be at least 1e-4, either way")
    if point.kind == CIRCLE:
        setting = point.state.setting
        return from_circle(
            setting.parameters, point.name, near=point.value, laws=setting.laws,
            speed=min(abs(size), 0.05),
        )  # fmt: skip
    if point.kind == HOPF:
        raise InputError(
            "oscillating cells, not steady ones, leave at a Hopf point: "
            "cellcrawl.branches.from_hopf finds them"
        )
    if point.kind not in (PITCHFORK, BRANCHING) or point.vector is None:
        raise InputError(f"no other branch leaves at this {point.kind}")
    state, setting = point.state, point.state.setting
    weight = weight_of(point.value)
    if point.symmetry == ANTISYMMETRIC:
        system = System(state.mesh, mirror=False)
        y = system.pack(state.fields)
        phi = state.mesh.unfolded(state.phi, 1.0)
        change = change_of_whole(state, point.symmetry, point.vector)
    else:
        raise InputError(
            "states that leave at a branch point of the same symmetry are not followed yet"
        )
    direction = np.append(change / system.norm(change), 0.0)
    along = (point.name, direction, weight, point.value)
    try:
        root = system.solve(setting, y + size * direction[:-1], phi, along=along)
    except NotFound as error:
        raise InputError(f"no state was found beside the pitchfork: {error}") from None
    found = SteadyState.of(setting.replace(point.name, root.parameter), system, root)
    if not math.isfinite(found.turning_rate) or abs(found.turning_rate) < _STILL:
        raise InputError("the state beside the pitchfork does not turn: give a larger amplitude")
    return found
