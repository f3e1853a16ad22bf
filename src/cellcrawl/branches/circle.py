"""The resting circle: its spectrum, the onset of gliding, and the states that leave there."""

from __future__ import annotations

import math
from typing import Any, Final

import numpy as np

from cellcrawl.arguments import checked
from cellcrawl.branches.equations import Fields
from cellcrawl.branches.mesh import Mesh
from cellcrawl.branches.setting import Setting, bounds_of
from cellcrawl.branches.state import SteadyState
from cellcrawl.branches.system import NotFound, System
from cellcrawl.errors import InputError
from cellcrawl.laws import as_law
from cellcrawl.laws.law import PAPER, Law
from cellcrawl.laws.rest import rest_state
from cellcrawl.linear.any_law import law_matrix
from cellcrawl.parameters import Parameters
from cellcrawl.validation import real_number, whole_number

_NODES = 65
_SAMPLES = 400
_HALVINGS = 200
_SMALLEST: Final = 3e-3


@checked
def circle(parameters: Parameters, *, laws: Any = None, nodes: int = _NODES) -> SteadyState:
    """Return the resting circle as a steady state, with growth rates by symmetry.

    ``nodes`` is 17 to 2001, made odd; wavenumbers up to half of it are there.
    """
    law = PAPER if laws is None else as_law(laws)
    setting = Setting(parameters, law)
    rest = setting.rest
    nodes = whole_number("nodes", nodes, 17, 2001)
    system = System(Mesh(nodes | 1), mirror=True)
    half = np.zeros(system.nodes)
    shape = Fields(half, half + rest.bound_fraction, 2.0 * math.pi, rest.tension)
    return SteadyState(setting, system, system.pack(shape), half + rest.bond_force)


def moving_growth_rate(setting: Setting) -> float:
    """Growth rate of the front that makes a circle glide (k = 1), under any law."""
    matrix = law_matrix(setting.parameters, np.array(1), setting.laws)
    return float(matrix[1, 1])


@checked
def onsets(
    parameters: Parameters, name: str, low: float, high: float, *, laws: Any = None
) -> list[float]:
    """Values of a parameter between two at which the circle's front neither grows nor decays.

    Gliding states meet the circle there. Under the paper's laws ``b / a = q_1``.
    """
    law = PAPER if laws is None else as_law(laws)
    least, most = bounds_of(law, name)
    low = real_number("low", low, least, most)
    high = real_number("high", high, low, most)
    setting = Setting(parameters, law)

    def rate(value: float) -> float:
        return moving_growth_rate(setting.replace(name, value))

    values = np.linspace(low, high, _SAMPLES)
    rates = []
    for value in values:
        try:
            rates.append(rate(float(value)))
        except InputError:
            rates.append(math.nan)
    found = []
    for k in np.flatnonzero(np.sign(rates[:-1]) * np.sign(rates[1:]) < 0.0):
        found.append(_root(rate, float(values[k]), float(values[k + 1])))
    return found


def _root(rate: Any, a: float, b: float) -> float:
    up = rate(a) > 0.0
    for _ in range(_HALVINGS):
        middle = 0.5 * (a + b)
        if middle in (a, b):
            break
        if (rate(middle) > 0.0) == up:
            a = middle
        else:
            b = middle
    return a


@checked
def from_circle(
    parameters: Parameters,
    name: str = "r_on",
    *,
    near: float | None = None,
    speed: float = _SMALLEST,
    laws: Any = None,
) -> SteadyState:
    """Return a slowly gliding state beside the point where gliding leaves the circle.

    Parameters
    ----------
    parameters : Parameters
        The cell, which gives all but the parameter ``name``.
    name : str
        The parameter in which the onset is looked for.
    near : float, optional
        Take the onset nearest to this value; the parameter's own unless given.
    speed : float
        Of the state, 1e-4 to 0.05.

    Raises
    ------
    InputError
        If there is no onset in the parameter's range.

    Notes
    -----
    On that branch ``name`` is ``r_c + beta V^2`` (see `onset_slope`): the state is found at the
    speed, with the parameter as the unknown.
    """
    law: Law = PAPER if laws is None else as_law(laws)
    speed = real_number("speed", speed, 1e-4, 0.05)
    low, high = bounds_of(law, name)
    setting = Setting(parameters, law)
    here = setting.value(name) if near is None else real_number("near", near, low, high)
    found = onsets(parameters, name, low, high, laws=law)
    if not found:
        raise InputError(
            f"no value of {name} from {low:g} to {high:g} makes the resting circle glide: change "
            "another parameter"
        )
    at = min(found, key=lambda value: abs(value - here))
    return _beside(setting.replace(name, at), name, speed)


def _beside(setting: Setting, name: str, speed: float) -> SteadyState:
    """Return the state of a small speed: a step along the circle's marginal mode."""
    still = circle(setting.parameters, laws=setting.laws)
    system, y = still.system, still.unknowns
    mode = np.zeros(system.size + 1)
    cosine = np.cos(system.mesh.alpha[: system.nodes])
    first = system.nodes - 1
    mode[first : first + system.nodes] = cosine
    from cellcrawl.branches.continuation import weight_of

    weight = weight_of(setting.value(name))
    mode /= system.norm(mode[:-1])
    rate = _speed_of_mode(setting, still)
    amplitude = speed / rate
    along = (name, mode, weight, setting.value(name))
    try:
        root = system.solve(setting, y + amplitude * mode[:-1], still.phi, along=along)
    except NotFound as error:
        raise InputError(f"no gliding state was found beside the circle: {error}") from None
    return SteadyState.of(setting.replace(name, root.parameter), system, root)


def _speed_of_mode(setting: Setting, still: SteadyState) -> float:
    """Speed of a circle with the marginal mode of size 1 in the norm of the system."""
    rest = rest_state(setting.parameters, setting.laws)
    at = setting.pointwise(
        np.array([rest.bond_force]), np.array([rest.bound_fraction]), rest.tension, np.ones(1)
    )
    by_bound = float(at.speed_by[1][0])
    return abs(by_bound) * math.sqrt(2.0)


@checked
def onset_slope(
    parameters: Parameters, name: str = "r_on", *, near: float | None = None, laws: Any = None
) -> tuple[float, float]:
    """Return where gliding begins, and ``beta`` of ``name = r_c + beta V^2`` there.

    Where ``beta`` points to where the circle is stable, slow gliding cells are unstable and gliding
    begins with a jump (subcritical); else it begins with no speed.
    """
    states = [
        from_circle(parameters, name, near=near, speed=speed, laws=laws) for speed in (3e-3, 1.5e-3)
    ]
    law = PAPER if laws is None else as_law(laws)
    low, high = bounds_of(law, name)
    value = states[0].setting.value(name)
    at = min(onsets(parameters, name, low, high, laws=law), key=lambda v: abs(v - value))
    slopes = [(state.setting.value(name) - at) / state.speed**2 for state in states]
    return at, slopes[1] + (slopes[1] - slopes[0]) / 3.0
