"""A stiff step of order four for two edges: the Rosenbrock method RODAS (Hairer & Wanner 1996).

Six stages, L-stable and stiffly accurate, with an embedded method of order three. The tension mode
of the consistent law decays at rates of thousands; an implicit step follows it without small steps,
and its linear system is an arrow that is solved by hand. Linear invariants are kept to rounding.

Kernels use the letters ``n`` bound fraction, ``y = log r``, ``sigma`` tension, ``x`` how far an
edge has moved outwards. The imbalance is half of what springs pull more on the front.
"""

from __future__ import annotations

from typing import Final

import numpy as np

from cellcrawl._compile import kernel
from cellcrawl.physics.exponential import exponential
from cellcrawl.physics.laws import (
    binding_rate,
    driving_force,
    edge_velocity,
    friction,
    friction_slope,
)
from cellcrawl.physics.slip_bond import ROUND_OFF, balance, halley_step

# entries of a state
N_FRONT, N_REAR, TENSION, IMBALANCE, X_FRONT, X_REAR = range(6)
STATE: Final = 6
# entries of `constants`
R_ON, ZETA_1, V_P, EPSILON, SIGMA_C, STIFFNESS, HELD, RELAXATION = range(8)

_GAMMA: Final = 0.25
_A: Final = np.array(
    [
        [0.0, 0.0, 0.0, 0.0, 0.0],
        [1.544, 0.0, 0.0, 0.0, 0.0],
        [0.9466785280815826, 0.2557011698983284, 0.0, 0.0, 0.0],
        [3.314825187068521, 2.896124015972201, 0.9986419139977817, 0.0, 0.0],
        [1.221224509226641, 6.019134481288629, 12.53708332932087, -0.687886036105895, 0.0],
        [1.221224509226641, 6.019134481288629, 12.53708332932087, -0.687886036105895, 1.0],
    ]
)
_C: Final = np.array(
    [
        [0.0, 0.0, 0.0, 0.0, 0.0],
        [-5.6688, 0.0, 0.0, 0.0, 0.0],
        [-2.430093356833875, -0.2063599157091915, 0.0, 0.0, 0.0],
        [-0.1073529058151375, -9.594562251023355, -20.47028614809616, 0.0, 0.0],
        [7.496443313967647, -10.24680431464352, -33.99990352819905, 11.7089089320616, 0.0],
        [
            8.083246795921522,
            -7.981132988064893,
            -31.52159432874371,
            16.31930543123136,
            -6.058818238834054,
        ],
    ]
)
_STAGES: Final = 6


@kernel
def off_rate(y: float, n: float, zeta_1: float, force: float) -> float:
    """``log r``: two Halley steps from a guess that is usually near, or the search."""
    z = y + halley_step(y, exponential(y), n, zeta_1, force)
    z = z + halley_step(z, exponential(z), n, zeta_1, force)
    residual = friction(z, exponential(z), n, zeta_1) - force
    if abs(residual) <= ROUND_OFF * (1.0 + abs(force)) and z >= 0.0:
        return z
    return balance(y, n, zeta_1, force)


@kernel
def rates(state: np.ndarray, constants: np.ndarray, y: np.ndarray, out: np.ndarray) -> bool:
    """Fill ``out`` with the rates of ``state``; ``y`` (edges,) is a guess in, ``log r`` out.

    False where an edge has no off-rate.
    """
    for edge in range(2):
        n, side = state[edge], 1.0 - 2.0 * edge
        tension = state[TENSION] + side * state[IMBALANCE]
        force = driving_force(tension, 0.0, constants[SIGMA_C], 0.0)
        y[edge] = off_rate(y[edge], n, constants[ZETA_1], force)
        if y[edge] != y[edge]:
            return False
        r = exponential(y[edge])
        out[edge] = binding_rate(n, r, constants[R_ON])
        out[X_FRONT + edge] = edge_velocity(y[edge], r, constants[V_P], constants[EPSILON])
    front, rear = out[X_FRONT], out[X_REAR]
    out[TENSION] = constants[STIFFNESS] * (front + rear)
    out[IMBALANCE] = constants[HELD] * (front - rear) - constants[RELAXATION] * state[IMBALANCE]
    return True


@kernel
def slopes(state: np.ndarray, constants: np.ndarray, y: np.ndarray, out: np.ndarray) -> None:
    """Fill ``out`` (4, edges) with the slopes of the rates at given ``y``.

    Rows: binding rate over n, over sigma; edge velocity over n, over sigma.
    """
    for edge in range(2):
        n, r = state[edge], exponential(y[edge])
        steepness = friction_slope(y[edge], r, n, constants[ZETA_1])
        y_n, y_sigma = -constants[ZETA_1] * y[edge] / steepness, 1.0 / steepness
        slowing = -constants[EPSILON] * r * (1.0 + y[edge])
        out[0, edge] = -constants[R_ON] - r - n * r * y_n
        out[1, edge] = -n * r * y_sigma
        out[2, edge] = slowing * y_n
        out[3, edge] = slowing * y_sigma


@kernel
def _solve(
    diagonal: float, slope: np.ndarray, constants: np.ndarray, right: np.ndarray, out: np.ndarray
) -> None:
    """Solve ``(diagonal - Jacobian) out = right`` by elimination down to the two tensions."""
    total, difference, load, tilt = 0.0, 0.0, 0.0, 0.0
    for edge in range(2):
        side = 1.0 - 2.0 * edge
        pivot = diagonal - slope[0, edge]
        given = slope[3, edge] + slope[2, edge] * slope[1, edge] / pivot
        pushed = slope[2, edge] * right[edge] / pivot
        total += given
        difference += side * given
        load += pushed
        tilt += side * pushed
    stiffness, held = constants[STIFFNESS], constants[HELD]
    first = right[TENSION] + stiffness * load
    second = right[IMBALANCE] + held * tilt
    corner = diagonal - stiffness * total
    last = diagonal + constants[RELAXATION] - held * total
    determinant = corner * last - stiffness * held * difference * difference
    out[TENSION] = (first * last + stiffness * difference * second) / determinant
    out[IMBALANCE] = (second * corner + held * difference * first) / determinant
    for edge in range(2):
        pull = out[TENSION] + (1.0 - 2.0 * edge) * out[IMBALANCE]
        out[edge] = (right[edge] + slope[1, edge] * pull) / (diagonal - slope[0, edge])
        push = slope[2, edge] * out[edge] + slope[3, edge] * pull
        out[X_FRONT + edge] = (right[X_FRONT + edge] + push) / diagonal


@kernel
def step(
    state: np.ndarray,
    y: np.ndarray,
    constants: np.ndarray,
    h: float,
    after: np.ndarray,
    error: np.ndarray,
) -> bool:
    """Step ``state`` by ``h`` into ``after`` with the local ``error``; False where it has no root.

    ``y`` (edges,) is ``log r`` at the start of the step and is kept.
    """
    slope = np.empty((4, 2))
    stages = np.empty((_STAGES, STATE))
    rate, right, at = np.empty(STATE), np.empty(STATE), y.copy()
    slopes(state, constants, y, slope)
    for i in range(_STAGES):
        after[:] = state
        for j in range(i):
            for m in range(STATE):
                after[m] += _A[i, j] * stages[j, m]
        if not rates(after, constants, at, rate):
            return False
        right[:] = rate
        for j in range(i):
            for m in range(STATE):
                right[m] += _C[i, j] / h * stages[j, m]
        _solve(1.0 / (_GAMMA * h), slope, constants, right, stages[i])
    error[:] = stages[_STAGES - 1]
    after += error
    return True
