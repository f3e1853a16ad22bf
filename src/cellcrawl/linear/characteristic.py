"""The characteristic equation of the resting circle, on arrays of wavenumbers and parameters.

``a lam**2 + (a q + S c - b) lam + S c q = 0``, with ``q = r_on + r_p + D k**2`` and the stiffness
of the shape ``S = epsilon h sigma_bar (k**2 - 1)``; for ``k = 0`` the stiffness of the area,
``S = epsilon (2 pi (1 + h) G - h sigma_bar)``.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np

from cellcrawl.errors import InputError
from cellcrawl.parameters import DESCRIPTIONS, Parameters
from cellcrawl.validation import known_names, real_array

HIGHEST_WAVENUMBER = 1e6


class Characteristic(NamedTuple):
    """Coefficients of the quadratic for the growth rates; arrays that broadcast."""

    a: np.ndarray
    b: np.ndarray
    c: float | np.ndarray
    q: np.ndarray
    stiffness: np.ndarray

    @property
    def damping(self) -> np.ndarray:
        """Coefficient of ``lam``: below 0, a mode grows."""
        damping: np.ndarray = self.a * self.q + self.stiffness * self.c - self.b
        return damping

    @property
    def restoring(self) -> np.ndarray:
        """Constant coefficient: below 0, a mode grows; its sign is that of the stiffness."""
        restoring: np.ndarray = self.stiffness * self.c * self.q
        return restoring

    @property
    def discriminant(self) -> np.ndarray:
        """``damping**2 - 4 a restoring``, with less cancellation: below 0, roots are complex.

        Squares are products: NumPy's power gives single numbers other last digits than arrays.
        """
        gap = self.a * self.q - self.stiffness * self.c - self.b
        discriminant: np.ndarray = gap * gap - 4.0 * self.b * self.stiffness * self.c
        return discriminant

    @property
    def margin(self) -> np.ndarray:
        """A rate that is above 0 where the mode grows and below 0 where it decays (Routh-Hurwitz).

        Where the stiffness is 0 (k = 1) one root is 0, a shift of the circle, and does not count.
        """
        by_damping = -self.damping / self.a
        by_stiffness = -self.stiffness * self.c / self.a
        margin: np.ndarray = np.where(
            self.stiffness == 0.0, by_damping, np.maximum(by_damping, by_stiffness)
        )
        return margin


def characteristic(
    parameters: Parameters, k: Any, values: Mapping[str, Any] | None = None
) -> Characteristic:
    """Return the quadratic for wavenumbers ``k``, with some parameters replaced by arrays.

    Nothing is checked here; see `checked_wavenumbers` and `checked_values`.
    """
    at = {**parameters.to_dict(), **(values or {})}
    r_on, r_p, zeta_1, epsilon, h = (at[name] for name in ("r_on", "r_p", "zeta_1", "epsilon", "h"))
    log_r = np.log(r_p)
    adhesion = zeta_1 * (r_on / (r_on + r_p))
    tension = ((r_p + adhesion) * log_r - at["sigma_c"]) / (1.0 + h)
    gain = at["k_sigma"] / (epsilon if parameters.elasticity == "consistent" else 1.0)
    square = np.square(k)
    bending = epsilon * h * tension
    breathing = 2.0 * math.pi * epsilon * (1.0 + h) * gain
    return Characteristic(
        a=1.0 + log_r + adhesion / r_p,
        b=adhesion * log_r,
        c=1.0 + log_r,
        q=r_on + r_p + at["D"] * square,
        stiffness=bending * (square - 1.0) + np.where(np.equal(k, 0), breathing, 0.0),
    )


def checked_wavenumbers(k: Any) -> np.ndarray:
    """Return ``k`` as an array, or raise `InputError`."""
    wavenumbers = real_array("k", k, None)
    highest = np.abs(wavenumbers).max(initial=0.0)
    if highest > HIGHEST_WAVENUMBER:
        raise InputError(
            f"k = {highest:g} is out of range: it must be up to {HIGHEST_WAVENUMBER:g}"
        )
    return wavenumbers


def checked_values(what: str, given: Mapping[str, Any]) -> dict[str, np.ndarray]:
    """Return arrays of parameter values, or raise `InputError` for a wrong name or value."""
    known_names(what, given, DESCRIPTIONS)
    values = {}
    for name, value in given.items():
        array = real_array(name, value, None)
        _, low, high = DESCRIPTIONS[name]
        outside = array[(array < low) | (array > high)]
        if outside.size:
            raise InputError(
                f"{name} = {outside[0]:g} is out of range: it must be a number "
                f"from {low:g} to {high:g}"
            )
        values[name] = array
    return values


def two_axes(what: str, ranges: Mapping[str, Any]) -> dict[str, np.ndarray]:
    """Return the increasing values of the two parameters of a map, or raise `InputError`."""
    values = checked_values(what, ranges)
    if len(values) != 2:
        raise InputError(
            f"{what} is over two parameters, not {len(values)}: give the values of two, "
            "as in r_on=[...], zeta_1=[...]"
        )
    for name, array in values.items():
        if array.ndim != 1 or array.size < 2 or not np.all(np.diff(array) > 0.0):
            raise InputError(f"{name} must be at least two values, increasing")
    return values


def checked_shapes(k: np.ndarray, values: Mapping[str, np.ndarray]) -> None:
    """Raise `InputError` unless the wavenumbers and values broadcast together."""
    try:
        np.broadcast_shapes(k.shape, *(value.shape for value in values.values()))
    except ValueError:
        shapes = ", ".join(f"{name} {array.shape}" for name, array in {"k": k, **values}.items())
        raise InputError(f"these shapes do not broadcast together: {shapes}") from None
