"""How small perturbations of the resting circle evolve: both roots at once, from any amplitudes."""

from __future__ import annotations

from typing import Any

import numpy as np

from cellcrawl.arguments import checked
from cellcrawl.linear.theory import base_state
from cellcrawl.parameters import Parameters
from cellcrawl.validation import real_array, whole_number


@checked
def evolution(
    parameters: Parameters, k: int, radius: complex, bound_fraction: complex, times: Any
) -> tuple[np.ndarray, np.ndarray]:
    """Return how the amplitudes of one wavenumber evolve in linear theory.

    With ``r_k`` from the force balance, ``a r_k = S_k R_k / epsilon - zeta_1 log(r_p) n_k``, the
    amplitudes of radius and bound fraction obey ``R_k' = -epsilon c r_k`` and
    ``n_k' = -q_k n_k - n_bar r_k``: both roots take part, each with its share of the start.

    Parameters
    ----------
    parameters : Parameters
        The cell.
    k : int
        Wavenumber, 1 or more; k = 0 changes the tension too and is not of this kind.
    radius, bound_fraction : complex
        Amplitudes at time 0, as `observables.fourier_amplitude` gives them.
    times : array of float, shape (time,)
        Times since then.

    Returns
    -------
    radius, bound_fraction : array of complex, shape (time,)

    Raises
    ------
    InputError
        For a wavenumber below 1 or times that are no finite numbers.

    Notes
    -----
    Holds while all perturbations are small: those of order 1e-4 that grow at a rate of 12 do so
    until about t = 0.5.
    """
    p, state = parameters, base_state(parameters)
    k = whole_number("k", k, 1)
    t = real_array("times", np.atleast_1d(real_array("times", times, None)), (None,))
    a, c = state.a, state.c
    q = p.r_on + p.r_p + p.D * k**2
    # the off-rate's amplitude over those of radius and bound fraction
    per_radius = state.tension * p.h * (k**2 - 1) / a
    per_bound = -p.zeta_1 * np.log(p.r_p) / a
    rates = np.array(
        [
            [-p.epsilon * c * per_radius, -p.epsilon * c * per_bound],
            [-state.bound_fraction * per_radius, -q - state.bound_fraction * per_bound],
        ],
        dtype=complex,
    )
    mean = 0.5 * np.trace(rates)
    apart = np.sqrt(mean**2 - np.linalg.det(rates))
    spread = np.where(apart == 0.0, t, np.sinh(apart * t) / (apart or 1.0))
    now = np.array([radius, bound_fraction], dtype=complex)
    moved = np.exp(mean * t) * (
        np.cosh(apart * t) * now[:, None] + spread * ((rates - mean * np.eye(2)) @ now)[:, None]
    )
    return moved[0], moved[1]
