"""Eigenmodes of the resting circle, and what they make of it at second order.

A growing mode pushes a mean and a second harmonic along with it. Where those are in step with it
(the invariant manifold of the mode) they grow at exactly twice its rate; without them the state
also holds free modes, which go their own way.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from cellcrawl.linear.theory import BaseState, base_state
from cellcrawl.parameters import Parameters

_RESONANT = 1e-9


class Amplitudes(NamedTuple):
    """Complex amplitudes ``f`` of ``Re f exp(i m phi)`` in the fields, phi the polar angle."""

    radius: complex
    bound_fraction: complex
    off_rate: complex


def linear_mode(parameters: Parameters, k: int, rate: complex) -> Amplitudes:
    """Return the eigenmode of ``k`` with the growth rate ``rate``, in any one size.

    It solves ``lam R = -epsilon c r``, ``(lam + q) n = -n_bar r`` and the linear force balance.
    """
    p = parameters
    q = p.r_on + p.r_p + p.D * k**2
    c = base_state(p).c
    return Amplitudes(p.epsilon * c * (rate + q), p.n_bar * rate, -rate * (rate + q))


def second_order(
    parameters: Parameters, k: int, rate: complex, mode: Amplitudes
) -> dict[int, Amplitudes]:
    """Return the mean (0) and the second harmonic (2 k) that go with a mode of a given size.

    The equations in polar angle, to second order in the mode, with the harmonics growing as
    ``exp(2 lam t)`` and the mean as its modulus. A harmonic for which that is itself a growth rate
    is left out.
    """
    base = base_state(parameters)
    conjugate = Amplitudes(*np.conj(mode))
    found: dict[int, Amplitudes] = {}
    for m, at_rate, partner, slope in (
        (2 * k, 2.0 * rate, mode, -(k**2)),
        (0, complex(2.0 * rate.real), conjugate, k**2),
    ):
        matrix = _operator(parameters, base, m, at_rate)
        forcing = _products(parameters, base, k, m, mode, partner, slope)
        scale = float(np.prod(np.linalg.norm(matrix, axis=1)))
        if abs(np.linalg.det(matrix)) <= _RESONANT * scale:
            continue
        answer = np.linalg.solve(matrix, forcing)
        earlier = found.get(m, Amplitudes(0.0, 0.0, 0.0))
        found[m] = Amplitudes(*(answer + np.array(earlier)).tolist())
    return found


def _operator(p: Parameters, base: BaseState, m: int, rate: complex) -> np.ndarray:
    """Linear equations of shape, kinetics and force balance for radius, bound fraction, off-rate.

    Singular where ``rate`` is a growth rate of ``m``.
    """
    pull = base.tension * p.h * (m**2 - 1)
    if m == 0:
        pull += 2.0 * math.pi * (1.0 + p.h) * p.tension_rate
    q = p.r_on + p.r_p + p.D * m**2
    return np.array(
        [
            [rate, 0.0, p.epsilon * base.c],
            [0.0, rate + q, base.bound_fraction],
            [pull, -p.zeta_1 * math.log(p.r_p), -base.a],
        ]
    )


def _products(
    p: Parameters,
    base: BaseState,
    k: int,
    m: int,
    mode: Amplitudes,
    partner: Amplitudes,
    slope: float,
) -> np.ndarray:
    """Quadratic terms of shape, kinetics and force balance; ``slope`` is that of f'g' over fg."""

    def product(f: str, g: str) -> complex:
        one, other = getattr(mode, f), getattr(mode, g)
        return complex(0.25 * (one * getattr(partner, g) + other * getattr(partner, f)))

    shape = product("radius", "radius")
    off_rates = product("off_rate", "off_rate")
    linkers = product("bound_fraction", "off_rate")
    spread = product("radius", "bound_fraction")
    curvature = (1.0 - 2.0 * k**2 + 0.5 * slope) * shape
    pull = base.tension * p.h * curvature
    if m == 0:  # the area has the mean of the radius squared
        pull += math.pi * p.tension_rate * (1.0 + p.h) * shape
    if k == 0:  # the tension changes with the curvature
        pull -= 2.0 * math.pi * p.tension_rate * p.h * shape
    friction = (
        0.5 * off_rates / p.r_p
        + p.zeta_1 * linkers / p.r_p
        - 0.5 * p.zeta_1 * base.bound_fraction * off_rates / p.r_p**2
    )
    kinetics = -linkers + p.D * (2.0 * k**2 - slope) * spread
    return np.array([-0.5 * p.epsilon * off_rates / p.r_p, kinetics, friction - pull])
