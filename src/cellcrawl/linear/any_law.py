"""Growth rates of waves on an edge under any law, from the law's own derivatives."""

from __future__ import annotations

import math

import numpy as np

from cellcrawl.laws.law import Law
from cellcrawl.laws.rest import RestState, local_values, rest_state
from cellcrawl.numerics.quadratic import ordered_roots
from cellcrawl.parameters import Parameters


def law_matrix(
    parameters: Parameters, k: np.ndarray, law: Law, rest: RestState | None = None
) -> np.ndarray:
    """Rates of radius and bound fraction by both, for waves of wavenumber ``k``.

    The force on a bond follows from the balance ``G(phi, n, sigma, kappa) = 0``; a wave changes the
    curvature by ``(k^2 - 1)`` times its radius, and for ``k = 0`` the tension by ``2 pi G_A``.

    Returns
    -------
    array, shape (..., 2, 2)
    """
    at = rest_state(parameters, law) if rest is None else rest
    stretching = np.where(np.equal(k, 0), 2.0 * math.pi * parameters.tension_rate, 0.0)
    return edge_matrix(parameters, k, law, at, 1.0, stretching)


def edge_matrix(
    parameters: Parameters,
    k: np.ndarray,
    law: Law,
    at: RestState,
    curvature: float,
    stretching: np.ndarray,
    springs: float = 0.0,
) -> np.ndarray:
    """Rates of outward displacement and bound fraction by both, for waves along a uniform edge.

    Parameters
    ----------
    k : array
        Wavenumbers; a wave of displacement changes the curvature by ``k^2`` less the square of the
        edge's own.
    at : RestState
        The uniform edge.
    curvature : float
        That of the edge: 1 for the circle, 0 for a straight edge.
    stretching : array
        Change of the tension with the displacement.
    springs : float
        Pull inwards with the displacement.

    Returns
    -------
    array, shape (..., 2, 2)
    """
    values = {**local_values(parameters, law), "phi": at.bond_force, "r": at.off_rate}
    values |= {"n": at.bound_fraction, "sigma": at.tension, "kappa": curvature}

    def slope(what: str, by: str) -> float:
        return float(law.compiled.evaluate(f"{what}/{by}", values))

    bending = np.square(k) - curvature**2
    by_phi = slope("balance", "phi")
    by_radius = slope("balance", "kappa") * bending + slope("balance", "sigma") * stretching
    by_radius = by_radius - springs
    phi_radius, phi_bound = -by_radius / by_phi, -slope("balance", "n") / by_phi
    speed = slope("velocity", "kappa") * bending + slope("velocity", "sigma") * stretching
    matrix = np.empty((*np.shape(k), 2, 2))
    matrix[..., 0, 0] = slope("velocity", "phi") * phi_radius + speed
    matrix[..., 0, 1] = slope("velocity", "phi") * phi_bound
    matrix[..., 1, 0] = slope("binding", "phi") * phi_radius
    matrix[..., 1, 1] = slope("binding", "n") - parameters.D * np.square(k)
    matrix[..., 1, 1] += slope("binding", "phi") * phi_bound
    return matrix


def law_growth_rates(
    parameters: Parameters, k: np.ndarray, law: Law, rest: RestState | None = None
) -> np.ndarray:
    """Growth rates, complex, shape (..., 2), in the order of `growth_rates`."""
    return matrix_rates(law_matrix(parameters, k, law, rest))


def matrix_rates(matrix: np.ndarray) -> np.ndarray:
    """Eigenvalues of matrices (..., 2, 2), complex, in the order of `growth_rates`."""
    half = -0.5 * (matrix[..., 0, 0] + matrix[..., 1, 1])
    crossed = matrix[..., 0, 1] * matrix[..., 1, 0]
    product = matrix[..., 0, 0] * matrix[..., 1, 1] - crossed
    square = np.square(0.5 * (matrix[..., 0, 0] - matrix[..., 1, 1])) + crossed
    return ordered_roots(half, product, square)
