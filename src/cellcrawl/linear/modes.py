"""Which modes grow: the cutoff wavenumber, the unstable modes, the fastest one."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np

from cellcrawl.arguments import checked
from cellcrawl.errors import InputError
from cellcrawl.linear.characteristic import Characteristic, characteristic, checked_values
from cellcrawl.linear.theory import growth_rates
from cellcrawl.parameters import Parameters


class Mode(NamedTuple):
    """A mode and how it grows."""

    k: int
    growth_rate: float
    frequency: float
    """Angular frequency, 0 for a mode that grows without oscillating."""


@checked
def cutoff_wavenumber(parameters: Parameters, **values: Any) -> np.ndarray:
    """Real wavenumber at which the damping changes sign: ``1 <= k < cutoff`` grow, the rest decay.

    The damping rises with ``k**2``, so this is a closed form. Above k = 1 it is a true Hopf point.

    Parameters
    ----------
    parameters : Parameters
        The cell.
    **values : float or array
        Parameters by name that replace those of the cell, as for `growth_rates`.

    Returns
    -------
    array
        NaN where the damping is positive at every k; infinite where the tension of the resting
        circle is negative, so that every k from 2 on grows.
    """
    return cutoff(parameters, checked_values("cutoff_wavenumber", values))


@checked
def unstable_modes(parameters: Parameters) -> np.ndarray:
    """Whole wavenumbers that grow, in order; 0 is the breathing mode.

    With the tension law as printed the breathing mode can be among them.

    Raises
    ------
    InputError
        Where the tension of the resting circle is negative: every wavenumber from 2 on grows.
    """
    highest = float(cutoff(parameters, {}))
    if math.isinf(highest):
        raise InputError(
            f"the resting circle has the negative tension {parameters.sigma_bar:.4g}: every "
            "wavenumber from 2 on grows; give a smaller sigma_c"
        )
    k = np.arange(0 if math.isnan(highest) else math.ceil(highest) + 1)
    margin = characteristic(parameters, np.union1d(k, [0])).margin
    return np.flatnonzero(margin > 0.0)


@checked
def fastest_mode(parameters: Parameters) -> Mode | None:
    """Return the mode that grows fastest, or None if none grows.

    Of the modes from k = 1 on it is always k = 1: damping and restoring both rise with k. Only the
    breathing mode, k = 0, can outgrow it.

    Raises
    ------
    InputError
        Where the tension of the resting circle is negative: the shortest waves grow fastest.
    """
    unstable = unstable_modes(parameters)
    if not unstable.size:
        return None
    rates = growth_rates(parameters, unstable)[:, 0]
    best = int(np.argmax(rates.real))
    return Mode(int(unstable[best]), float(rates[best].real), float(rates[best].imag))


def cutoff(parameters: Parameters, values: Mapping[str, np.ndarray]) -> np.ndarray:
    """Return the cutoff wavenumber for checked values."""
    low, high = (characteristic(parameters, k, values).damping for k in (1.0, 2.0))
    slope = (high - low) / 3.0  # the damping is linear in k**2
    stiffness = characteristic(parameters, 2.0, values).stiffness
    with np.errstate(divide="ignore", invalid="ignore"):
        square = 1.0 - low / slope
    highest = np.sqrt(np.where(square >= 0.0, square, np.nan))
    highest, stiffness = np.broadcast_arrays(highest, stiffness)
    return np.where(stiffness < 0.0, np.inf, highest)


def unstable_count(parameters: Parameters, values: Mapping[str, np.ndarray]) -> np.ndarray:
    """Return the number of whole wavenumbers that grow, infinite at negative tension."""
    highest = cutoff(parameters, values)
    above = np.maximum(np.ceil(np.nan_to_num(highest, nan=0.0, posinf=np.inf)) - 1.0, 0.0)
    count: np.ndarray = above + _grows(characteristic(parameters, 0, values))
    return count


def fastest_wavenumber(parameters: Parameters, values: Mapping[str, np.ndarray]) -> np.ndarray:
    """Return the wavenumber that grows fastest: NaN for none, infinite at negative tension."""
    breathing, translation = (growth_rates(parameters, k, **values)[..., 0].real for k in (0, 1))
    fastest = np.where(breathing > translation, 0.0, 1.0)
    fastest = np.where(np.maximum(breathing, translation) > 0.0, fastest, np.nan)
    return np.where(np.isinf(cutoff(parameters, values)), np.inf, fastest)


def _grows(quadratic: Characteristic) -> np.ndarray:
    grows: np.ndarray = quadratic.margin > 0.0
    return grows
