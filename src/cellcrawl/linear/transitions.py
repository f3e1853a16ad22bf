"""Where the roots change kind along the wavenumber or a parameter.

Two things the paper calls alike are kept apart: real roots that become a complex pair (its "Hopf
bifurcation"), and a complex pair that crosses the imaginary axis (a Hopf point).
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from cellcrawl.arguments import checked
from cellcrawl.errors import InputError
from cellcrawl.linear.characteristic import (
    HIGHEST_WAVENUMBER,
    Characteristic,
    characteristic,
    checked_values,
)
from cellcrawl.numerics.bracketing import all_roots
from cellcrawl.parameters import DESCRIPTIONS, Parameters
from cellcrawl.validation import known_names, real_array, real_number


class Transition(NamedTuple):
    """A point at which the two roots of a mode change kind."""

    along: str
    """What varies: ``"k"`` or the name of a parameter."""
    value: float
    """Where, to rounding."""
    growth_rate: float
    """Real part there, the same for both roots."""
    frequency: float
    """Angular frequency there; 0 where a pair is born."""
    rising: bool
    """Whether the pair exists, or at a Hopf point grows, above ``value`` rather than below."""


@checked
def oscillation_onset(parameters: Parameters, k: Any, **ranges: Any) -> list[Transition]:
    """Points at which two real roots meet and turn into a complex pair, or back.

    The paper calls this a Hopf bifurcation. It is where oscillation begins, growing or decaying; no
    mode gains or loses stability there.

    Parameters
    ----------
    parameters : Parameters
        The cell.
    k : float or (float, float)
        The wavenumber, or the range along which to look, above 0.
    **ranges : (float, float)
        With one wavenumber: the parameter along which to look, by name, with its range.

    Returns
    -------
    list of Transition
        In order along the range.

    Raises
    ------
    InputError
        Unless exactly one of k and the parameters has a range, and for values out of range.

    Examples
    --------
    >>> from cellcrawl import Parameters, linear
    >>> p = Parameters(r_on=25, zeta_1=600)
    >>> [round(float(t.value), 1) for t in linear.oscillation_onset(p, k=(1, 20))]
    [7.8]
    """
    along, low, high, quadratic = _line("oscillation_onset", parameters, k, ranges)
    found = all_roots(lambda at: -quadratic(at).discriminant, low, high)
    return [_transition(along, at, low, high, quadratic, "discriminant") for at in found]


@checked
def hopf_points(parameters: Parameters, k: Any, **ranges: Any) -> list[Transition]:
    """Points at which a complex pair crosses the imaginary axis: Hopf points in the usual sense.

    The mode gains or loses stability there with a frequency. k = 1 has none: its roots are real.

    Parameters
    ----------
    parameters : Parameters
        The cell.
    k : float or (float, float)
        The wavenumber, 0 for the breathing mode, or the range along which to look, above 0.
    **ranges : (float, float)
        With one wavenumber: the parameter along which to look, by name, with its range.

    Returns
    -------
    list of Transition
        In order along the range.

    Raises
    ------
    InputError
        Unless exactly one of k and the parameters has a range, and for values out of range.

    Examples
    --------
    >>> from cellcrawl import Parameters, linear
    >>> p = Parameters(r_on=25, zeta_1=600)
    >>> [round(float(t.value), 1) for t in linear.hopf_points(p, k=(1, 20))]
    [15.3]
    """
    along, low, high, quadratic = _line("hopf_points", parameters, k, ranges)
    found = all_roots(lambda at: -quadratic(at).damping, low, high)
    return [
        _transition(along, at, low, high, quadratic, "damping")
        for at in found
        if quadratic(np.asarray(at)).restoring > 0.0
    ]


def _line(
    what: str, parameters: Parameters, k: Any, ranges: dict[str, Any]
) -> tuple[str, float, float, Callable[[np.ndarray], Characteristic]]:
    """Return what varies, its range, and the characteristic equation along it."""
    known_names(what, ranges, DESCRIPTIONS)
    wavenumber = real_array("k", k, None)
    given = {"k": wavenumber} if wavenumber.ndim else {}
    given |= {name: real_array(name, value, None) for name, value in ranges.items()}
    if len(given) != 1:
        raise InputError(
            f"{what} looks along one range, not {len(given)}: give k=(low, high), or one k and one "
            "parameter as in r_on=(low, high)"
        )
    ((along, ends),) = given.items()
    if ends.shape != (2,) or not ends[0] < ends[1]:
        raise InputError(f"{along} must be a range of two numbers, the lower one first")
    low, high = (float(end) for end in ends)
    if along == "k":
        real_number("k", low, 0.0, HIGHEST_WAVENUMBER, open_low=True)
        real_number("k", high, 0.0, HIGHEST_WAVENUMBER)
        return along, low, high, lambda at: characteristic(parameters, at)
    checked_values(what, {along: ends})
    at_k = real_number("k", float(wavenumber), 0.0, HIGHEST_WAVENUMBER)
    return along, low, high, lambda at: characteristic(parameters, at_k, {along: at})


def _transition(
    along: str,
    value: float,
    low: float,
    high: float,
    quadratic: Callable[[np.ndarray], Characteristic],
    crossed: str,
) -> Transition:
    at = quadratic(np.asarray(value))
    born = crossed == "discriminant"
    growth = float(-0.5 * at.damping / at.a) if born else 0.0
    frequency = 0.0 if born else float(np.sqrt(at.restoring / at.a))
    step = 1e-7 * (high - low)
    after, before = (getattr(quadratic(np.asarray(value + way)), crossed) for way in (step, -step))
    return Transition(along, float(value), growth, frequency, bool(after < before))
