"""Theory of the flat edge: uniform states, growth rates and waves, and the speed of fronts."""

from __future__ import annotations

import math
from typing import Any, Final, NamedTuple

import numpy as np

from cellcrawl._compile import kernel
from cellcrawl.arguments import checked
from cellcrawl.errors import InputError
from cellcrawl.linear.bracketing import all_roots
from cellcrawl.linear.characteristic import characteristic, checked_wavenumbers
from cellcrawl.linear.quadratic import ordered_roots
from cellcrawl.one_dimensional.cell import checked_cell
from cellcrawl.parameters import Parameters
from cellcrawl.physics.laws import binding_rate
from cellcrawl.physics.slip_bond import balance
from cellcrawl.validation import one_of, real_number

TENSION_LAWS: Final = ("fixed", "elastic")
LONGEST: Final = 1e4
_HIGHEST = 1e9
_STEPS = 4000


class FlatMode(NamedTuple):
    """Complex amplitudes ``f`` of ``Re f exp(i k s + rate t)`` on a flat edge."""

    rate: complex
    bound_fraction: complex
    height: complex
    off_rate: complex


@checked
def uniform_states(parameters: Parameters, tension: float) -> np.ndarray:
    """Return the off-rates at which a uniform flat edge can be at a tension, lowest first.

    One, or three: the stuck state, an unstable one between, and the slipping state.

    Parameters
    ----------
    parameters : Parameters
        The cell.
    tension : float
        Membrane tension; with contraction it must pull, ``sigma_c + tension >= 0``.

    Raises
    ------
    InputError
        For a pull below 0, which no off-rate balances.
    """
    checked_cell(parameters)
    tension = real_number("tension", tension, -_HIGHEST, _HIGHEST)
    force = parameters.sigma_c + tension
    if force < 0.0:
        raise InputError(
            f"tension = {tension:g} is below -sigma_c = {-parameters.sigma_c:g}: no off-rate "
            "r >= 1 balances the forces; give a higher tension"
        )
    if force == 0.0:
        return np.ones(1)
    p = parameters

    def excess(y: np.ndarray) -> np.ndarray:
        r = np.exp(y)
        pull: np.ndarray = y * (r + p.zeta_1 * p.r_on / (p.r_on + r)) - force
        return pull

    states: np.ndarray = np.exp(all_roots(excess, 0.0, math.log1p(force) + 1e-9, 4001))
    return states


@checked
def flat_growth_rates(
    parameters: Parameters,
    k: Any,
    *,
    off_rate: float | None = None,
    tension_law: str = "fixed",
    length: float = 2.0 * math.pi,
    anchoring: float = 0.0,
) -> np.ndarray:
    """Growth rates of waves of wavenumber ``k`` on a uniform flat edge.

    Parameters
    ----------
    parameters : Parameters
        The cell.
    k : float or array
        Wavenumbers; a wave of complex rate travels at ``Im(rate) / k`` along the edge.
    off_rate : float, optional
        That of the uniform edge, at least 1; ``r_p``, at which the edge stands still, unless given.
    tension_law : {"fixed", "elastic"}
        Whether the tension is held or follows the area swept, which only ``k = 0`` feels.
    length : float
        Length of the edge, which matters to the elastic tension only.
    anchoring : float
        Stiffness of springs to a body that never moves.

    Returns
    -------
    array, complex, shape (..., 2)
        The larger root first; of a complex pair the one with the positive imaginary part. At a
        fixed tension without springs ``k = 0`` has the roots ``b/a - q`` and 0.

    Raises
    ------
    InputError
        For values out of range.
    """
    checked_cell(parameters)
    wavenumbers = checked_wavenumbers(k)
    one_of("tension_law", tension_law, TENSION_LAWS)
    p, r = parameters, parameters.r_p
    if off_rate is not None:
        r = real_number("off_rate", off_rate, 1.0, 1e6)
    length = real_number("length", length, 0.0, LONGEST, open_low=True)
    springs = real_number("anchoring", anchoring, 0.0, _HIGHEST)
    base = characteristic(p, wavenumbers, {"r_p": np.asarray(r)})
    tension = math.log(r) * (r + p.zeta_1 * p.r_on / (p.r_on + r)) - p.sigma_c
    stiffness = p.epsilon * (p.h * tension * np.square(wavenumbers) + springs)
    if tension_law == "elastic":
        stiffness = stiffness + np.where(
            wavenumbers == 0.0, p.epsilon * p.tension_rate * length, 0.0
        )
    quadratic = base._replace(stiffness=np.asarray(stiffness))
    half = np.asarray(0.5 * quadratic.damping / quadratic.a)
    product = np.asarray(quadratic.restoring / quadratic.a)
    return ordered_roots(half, product, half**2 - product)


def flat_mode(parameters: Parameters, k: float, off_rate: float, rate: complex) -> FlatMode:
    """Return the eigenmode of a growth rate, of size 1 in the bound fraction."""
    p, r = parameters, off_rate
    n = p.r_on / (p.r_on + r)
    change = -(rate + p.r_on + r + p.D * k**2) / n
    height = -p.epsilon * (1.0 + math.log(r)) * change / rate if rate != 0.0 else 0.0
    return FlatMode(rate, 1.0 + 0.0j, complex(height), complex(change))


@checked
def front_speed(parameters: Parameters, tension: float) -> float:
    """Speed at which the stuck state invades the slipping one along a flat edge without curvature.

    Below 0 where the slipping state invades. Found by shooting in the plane of bound fraction and
    its slope; ``h`` is taken as 0.

    Parameters
    ----------
    parameters : Parameters
        The cell.
    tension : float
        A tension at which both states exist.

    Raises
    ------
    InputError
        Where the edge has only one uniform state.
    """
    states = uniform_states(parameters, tension)
    if states.size != 3:
        raise InputError(
            f"at tension = {tension:g} a flat edge has one uniform state, not a stuck and a "
            "slipping one: no front joins them; give another tension"
        )
    p = parameters
    stuck, _, slipping = (float(p.r_on / (p.r_on + r)) for r in states)
    grid = np.linspace(slipping, stuck, 2 * _STEPS + 1)
    source = np.empty(grid.size)
    _sources(grid, p.r_on, p.zeta_1, p.sigma_c + tension, source)
    source[[0, -1]] = 0.0
    slope = (source[1] - source[0]) / (grid[1] - grid[0])
    high = 2.0 * math.sqrt(p.D * float(np.abs(np.gradient(source, grid)).max()))
    low = -high
    for _ in range(60):
        middle = 0.5 * (low + high)
        if _reaches(source, grid[1] - grid[0], p.D, middle, slope):
            high = middle
        else:
            low = middle
    return 0.5 * (low + high)


@kernel
def _sources(n: np.ndarray, r_on: float, zeta_1: float, force: float, out: np.ndarray) -> None:
    y = np.nan
    for i in range(n.size):
        y = balance(y, n[i], zeta_1, force)
        out[i] = binding_rate(n[i], np.exp(y), r_on)


@kernel
def _reaches(source: np.ndarray, half: float, D: float, c: float, slope: float) -> bool:
    """Whether the path from the slipping state at speed ``c`` keeps a slope up to the stuck one.

    ``p = -n_s`` over n obeys ``D p p_n = c p - g``; the nodes of ``source`` are half steps.
    """
    step = 2.0 * half
    p = step * 0.5 * (c + np.sqrt(c * c - 4.0 * D * slope)) / D
    for i in range(2, source.size - 2, 2):
        k1 = (c - source[i] / p) / D
        p2 = p + half * k1
        if p2 <= 0.0:
            return False
        k2 = (c - source[i + 1] / p2) / D
        p3 = p + half * k2
        if p3 <= 0.0:
            return False
        k3 = (c - source[i + 1] / p3) / D
        p4 = p + step * k3
        if p4 <= 0.0:
            return False
        k4 = (c - source[i + 2] / p4) / D
        p += step / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4)
        if p <= 0.0:
            return False
    return True
