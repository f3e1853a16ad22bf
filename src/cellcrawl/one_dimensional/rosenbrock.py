"""A stiff step of order four for two edges: the Rosenbrock method RODAS (Hairer & Wanner 1996).

Six stages, L-stable and stiffly accurate, with an embedded method of order three. The tension mode
of the consistent law decays at rates of thousands; an implicit step follows it without small steps,
and its linear system is an arrow that is solved by hand. Linear invariants are kept to rounding.

Kernels use the letters ``n`` bound fraction, ``phi`` force on a bond, ``x`` how far an edge has
moved outwards; ``laws`` and ``edge`` (rows, edges) are those of `cellcrawl.laws.functions`. The
imbalance is half of what springs pull more on the front.
"""

from __future__ import annotations

from typing import Any, Final

import numpy as np

from cellcrawl.laws.force_balance import bond_force_near
from cellcrawl.laws.functions import binding, off_rate, partials, velocity
from cellcrawl.numerics.kernels import kernel

# entries of a state
N_FRONT, N_REAR, TENSION, IMBALANCE, X_FRONT, X_REAR = range(6)
STATE: Final = 6
# entries of `constants`
STIFFNESS, HELD, RELAXATION = range(3)

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
def rates(
    laws: Any,
    edge: np.ndarray,
    state: np.ndarray,
    constants: np.ndarray,
    phi: np.ndarray,
    out: np.ndarray,
) -> bool:
    """Fill ``out`` with the rates of ``state``; ``phi`` (edges,) is a guess in, the root out.

    False where the forces on an edge have no balance.
    """
    for i in range(2):
        n, tension = state[i], state[TENSION] + (1.0 - 2.0 * i) * state[IMBALANCE]
        phi[i] = bond_force_near(laws, phi[i], n, tension, 0.0, edge, i)
        if phi[i] != phi[i]:
            return False
        r = off_rate(laws, phi[i], edge, i)
        out[i] = binding(laws, phi[i], r, n, edge, i)
        out[X_FRONT + i] = velocity(laws, phi[i], r, tension, 0.0, edge, i)
    front, rear = out[X_FRONT], out[X_REAR]
    out[TENSION] = constants[STIFFNESS] * (front + rear)
    out[IMBALANCE] = constants[HELD] * (front - rear) - constants[RELAXATION] * state[IMBALANCE]
    return True


@kernel
def slopes(
    laws: Any, edge: np.ndarray, state: np.ndarray, phi: np.ndarray, out: np.ndarray
) -> None:
    """Fill ``out`` (4, edges) with the slopes of the rates where the forces balance.

    Rows: binding rate over n, over sigma; edge velocity over n, over sigma.
    """
    for i in range(2):
        tension = state[TENSION] + (1.0 - 2.0 * i) * state[IMBALANCE]
        r = off_rate(laws, phi[i], edge, i)
        g_phi, g_n, g_sigma, _, v_phi, v_sigma, _, b_phi, b_n = partials(
            laws, phi[i], r, state[i], tension, 0.0, edge, i
        )
        phi_n, phi_sigma = -g_n / g_phi, -g_sigma / g_phi
        out[0, i] = b_n + b_phi * phi_n
        out[1, i] = b_phi * phi_sigma
        out[2, i] = v_phi * phi_n
        out[3, i] = v_sigma + v_phi * phi_sigma


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
    laws: Any,
    edge: np.ndarray,
    state: np.ndarray,
    phi: np.ndarray,
    constants: np.ndarray,
    h: float,
    after: np.ndarray,
    error: np.ndarray,
) -> bool:
    """Step ``state`` by ``h`` into ``after`` with the local ``error``; False where it has no root.

    ``phi`` (edges,) is the force on a bond at the start of the step and is kept.
    """
    slope = np.empty((4, 2))
    stages = np.empty((_STAGES, STATE))
    rate, right, at = np.empty(STATE), np.empty(STATE), phi.copy()
    slopes(laws, edge, state, phi, slope)
    for i in range(_STAGES):
        after[:] = state
        for j in range(i):
            for m in range(STATE):
                after[m] += _A[i, j] * stages[j, m]
        if not rates(laws, edge, after, constants, at, rate):
            return False
        right[:] = rate
        for j in range(i):
            for m in range(STATE):
                right[m] += _C[i, j] / h * stages[j, m]
        _solve(1.0 / (_GAMMA * h), slope, constants, right, stages[i])
    error[:] = stages[_STAGES - 1]
    after += error
    return True
