"""The pointwise laws of the model (equations 3 and 5-8 of Chen, Saintillan & Rangamani 2023).

Kernels use the paper's letters: ``n`` bound fraction, ``r`` off-rate, ``y = log r``, ``sigma``
membrane tension, ``kappa`` curvature. Everything is dimensionless. Every solver compiles these
functions; none repeats them. Each takes and returns scalars, so a solver may call them inside any
loop, with parameters that differ from node to node.
"""

from __future__ import annotations

from cellcrawl._compile import inlined_kernel


@inlined_kernel
def retrograde_velocity(y: float, r: float) -> float:
    """``v_r = r log r``, in units of v_beta."""
    return y * r


@inlined_kernel
def edge_velocity(y: float, r: float, v_p: float, epsilon: float) -> float:
    """Outward normal velocity of the edge, ``U = epsilon (v_p - v_r)``."""
    return epsilon * (v_p - retrograde_velocity(y, r))


@inlined_kernel
def friction(y: float, r: float, n: float, zeta_1: float) -> float:
    """Friction (traction) on the edge, ``r log r + zeta_1 n log r``."""
    return y * (r + zeta_1 * n)


@inlined_kernel
def friction_slope(y: float, r: float, n: float, zeta_1: float) -> float:
    """Slope of `friction` in ``y = log r``; positive for ``y >= 0``."""
    return r * (1.0 + y) + zeta_1 * n


@inlined_kernel
def friction_bend(y: float, r: float) -> float:
    """Second derivative of `friction` with respect to ``y = log r``."""
    return r * (2.0 + y)


@inlined_kernel
def driving_force(sigma: float, kappa: float, sigma_c: float, h: float) -> float:
    """Inward pull the friction must balance, ``sigma_c + sigma (1 + kappa h)``."""
    return sigma_c + sigma * (1.0 + kappa * h)


@inlined_kernel
def binding_rate(n: float, r: float, r_on: float) -> float:
    """Kinetics of the linkers at a material point without diffusion, ``r_on (1 - n) - r n``."""
    return r_on * (1.0 - n) - r * n
