"""Linear stability of the resting circle (MODEL: a circle of radius 1 at off-rate r_p).

For wavenumber k the growth rates are the two roots of
``a lam**2 + (a q_k + S_k c - b) lam + S_k c q_k = 0``.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from cellcrawl.errors import InputError
from cellcrawl.parameters import Parameters
from cellcrawl.validation import real_array

_HIGHEST = 1e6


@dataclass(frozen=True)
class BaseState:
    """The resting circle of radius 1 and the coefficients of its linear theory."""

    off_rate: float
    bound_fraction: float
    tension: float
    a: float
    b: float
    c: float


def base_state(parameters: Parameters) -> BaseState:
    """Return the resting circle of ``parameters``."""
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


def growth_rates(parameters: Parameters, k: Any) -> np.ndarray:
    """Growth rates of wavenumber ``k``, complex, shape ``k.shape + (2,)``.

    The larger root comes first; of a complex pair the one with the positive imaginary part.
    ``k = 0`` is the breathing mode, with the tension law of ``parameters``.

    Raises
    ------
    InputError
        For wavenumbers that are not numbers, or above a million.
    """
    p, base = parameters, base_state(parameters)
    k = real_array("k", k, None)
    if np.abs(k).max(initial=0.0) > _HIGHEST:
        raise InputError(f"k = {np.abs(k).max():g} is out of range: it must be up to {_HIGHEST:g}")
    q = p.r_on + p.r_p + p.D * k**2
    stiffness = p.epsilon * p.h * base.tension * (k**2 - 1.0)
    breathing = 2.0 * math.pi * p.epsilon * (1.0 + p.h) * p.tension_rate
    stiffness = stiffness + np.where(k == 0, breathing, 0.0)
    half = 0.5 * (base.a * q + stiffness * base.c - base.b) / base.a
    product = stiffness * base.c * q / base.a
    discriminant = half**2 - product
    root = np.sqrt(np.abs(discriminant))
    far = -half - np.copysign(root, half)  # no cancellation; the other root from the product
    near = np.divide(product, far, out=np.zeros_like(far), where=far != 0.0)
    real = np.stack([np.maximum(far, near), np.minimum(far, near)], axis=-1)
    pair = np.stack([-half + 1j * root, -half - 1j * root], axis=-1)
    return np.where(discriminant[..., None] < 0.0, pair, real)


def fastest_decay(parameters: Parameters) -> float:
    """Largest rate at which the breathing mode (k = 0) decays or oscillates."""
    return float(np.abs(growth_rates(parameters, 0)).max())
