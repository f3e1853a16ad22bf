"""Linear stability of the resting circle: its state, and the two growth rates of a wavenumber."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from cellcrawl.arguments import checked
from cellcrawl.errors import InputError
from cellcrawl.laws import as_law
from cellcrawl.laws.law import PAPER
from cellcrawl.linear.any_law import law_growth_rates
from cellcrawl.linear.characteristic import (
    characteristic,
    checked_shapes,
    checked_values,
    checked_wavenumbers,
)
from cellcrawl.numerics.quadratic import ordered_roots
from cellcrawl.parameters import Parameters


@dataclass(frozen=True)
class BaseState:
    """The resting circle of radius 1 and the coefficients of its linear theory."""

    off_rate: float
    bound_fraction: float
    tension: float
    a: float
    b: float
    c: float


@checked
def base_state(parameters: Parameters) -> BaseState:
    """Return the resting circle of ``parameters`` under the paper's laws.

    That of other laws is `cellcrawl.laws.rest_state`.
    """
    p = parameters
    log_r = math.log(p.r_p)
    adhesion = p.zeta_1 * p.n_bar
    return BaseState(
        off_rate=p.r_p,
        bound_fraction=p.n_bar,
        tension=p.sigma_bar,
        a=1.0 + log_r + adhesion / p.r_p,
        b=adhesion * log_r,
        c=1.0 + log_r,
    )


@checked
def growth_rates(parameters: Parameters, k: Any, *, laws: Any = None, **values: Any) -> np.ndarray:
    """Growth rates of wavenumber ``k``, both roots of the characteristic equation.

    Parameters
    ----------
    parameters : Parameters
        The cell; its ``elasticity`` is the tension law of the breathing mode, ``k = 0``.
    k : int or array
        Wavenumbers. Any real number is taken, though only whole ones fit a circle.
    laws : Law or str, optional
        Another law set than the paper's, by itself or by name; parameters are then those of the
        cell alone.
    **values : float or array
        Parameters by name that replace those of the cell. They broadcast with each other and with
        ``k``: ``growth_rates(p, 1, r_on=r_on[:, None], zeta_1=zeta_1)`` is a map.

    Returns
    -------
    array, complex, shape (..., 2)
        The larger root comes first; of a complex pair the one with the positive imaginary part.
        ``k = 1`` always has the root 0, a shift of the circle.

    Raises
    ------
    InputError
        For wavenumbers that are not numbers or above a million, unknown names, values out of range,
        or shapes that do not broadcast.
    """
    k = checked_wavenumbers(k)
    law = PAPER if laws is None else as_law(laws)
    if law != PAPER:
        if values:
            raise InputError("under other laws give one cell's parameters, not values by name")
        return law_growth_rates(parameters, k, law)
    given = checked_values("growth_rates", values)
    checked_shapes(k, given)
    quadratic = characteristic(parameters, k, given)
    half = 0.5 * quadratic.damping / quadratic.a
    product = quadratic.restoring / quadratic.a
    square = 0.25 * quadratic.discriminant / (quadratic.a * quadratic.a)
    return ordered_roots(half, product, square)


@checked
def fastest_decay(parameters: Parameters) -> float:
    """Largest rate at which the breathing mode (k = 0) decays or oscillates."""
    return float(np.abs(growth_rates(parameters, 0)).max())
