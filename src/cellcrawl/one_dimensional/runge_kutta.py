"""The flat edge in time: an error-controlled explicit Runge-Kutta method of order five.

Space is a periodic line of equal spacing with differences of order eight. Kernels use the letters
``n`` bound fraction, ``u`` height of the edge, ``phi`` force on a bond; ``kappa = -u_ss`` is the
curvature of a gentle slope, positive where the edge bulges outwards; ``laws`` and ``edge`` (rows,
nodes) are those of `cellcrawl.laws.functions`. A state holds n and u of all nodes, then the
tension.
"""

from __future__ import annotations

from typing import Any, Final

import numpy as np

from cellcrawl.laws.force_balance import SOLVED, solve_bonds
from cellcrawl.laws.functions import binding, off_rate, velocity
from cellcrawl.laws.law import LOCAL
from cellcrawl.numerics.kernels import kernel

# what `run` returns beside the number of records made
REACHED, NO_ROOT, STEP_TOO_SMALL, TOO_MANY_STEPS = range(4)
# entries of `constants`
D, SPACING, TENSION_RATE, HOLD = range(4)
# entries of `counters`
STEPS, REJECTED = range(2)
NEAR: Final = 4  # nodes to each side in a difference
_PRESSURE: Final = LOCAL.index("pressure")  # the row of what springs pull

_WEIGHTS: Final = (-205.0 / 72.0, 8.0 / 5.0, -1.0 / 5.0, 8.0 / 315.0, -1.0 / 560.0)
# Dormand & Prince 1980; the last row is the solution of order five
_A: Final = np.array(
    [
        [0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
        [1 / 5, 0.0, 0.0, 0.0, 0.0, 0.0],
        [3 / 40, 9 / 40, 0.0, 0.0, 0.0, 0.0],
        [44 / 45, -56 / 15, 32 / 9, 0.0, 0.0, 0.0],
        [19372 / 6561, -25360 / 2187, 64448 / 6561, -212 / 729, 0.0, 0.0],
        [9017 / 3168, -355 / 33, 46732 / 5247, 49 / 176, -5103 / 18656, 0.0],
        [35 / 384, 0.0, 500 / 1113, 125 / 192, -2187 / 6784, 11 / 84],
    ]
)
_E: Final = np.array([71 / 57600, 0.0, -71 / 16695, 71 / 1920, -17253 / 339200, 22 / 525, -1 / 40])
_STAGES: Final = 7
_SAFETY: Final = 0.9
_LONGEST: Final = 0.1
_SHORTEST: Final = 1e-10


@kernel
def second_derivative(field: np.ndarray, spacing: float, out: np.ndarray) -> None:
    """Fill ``out`` (nodes,) with the second derivative of a periodic field, to order eight."""
    nodes = field.size
    padded = np.empty(nodes + 2 * NEAR)
    padded[NEAR : NEAR + nodes] = field
    padded[:NEAR] = field[nodes - NEAR :]
    padded[NEAR + nodes :] = field[:NEAR]
    scale = 1.0 / (spacing * spacing)
    for i in range(nodes):
        j = i + NEAR
        out[i] = scale * (
            _WEIGHTS[0] * padded[j]
            + _WEIGHTS[1] * (padded[j - 1] + padded[j + 1])
            + _WEIGHTS[2] * (padded[j - 2] + padded[j + 2])
            + _WEIGHTS[3] * (padded[j - 3] + padded[j + 3])
            + _WEIGHTS[4] * (padded[j - 4] + padded[j + 4])
        )


@kernel
def rates(
    laws: Any,
    edge: np.ndarray,
    state: np.ndarray,
    constants: np.ndarray,
    kappa: np.ndarray,
    phi: np.ndarray,
    out: np.ndarray,
) -> int:
    """Fill ``out`` with the rates of ``state``; `SOLVED`, or a node where no forces balance.

    ``kappa`` and ``phi`` are results too, ``phi`` from a guess, and so is the pull of the springs
    in ``edge``.
    """
    nodes = phi.size
    n, u, sigma = state[:nodes], state[nodes : 2 * nodes], state[2 * nodes]
    second_derivative(u, constants[SPACING], kappa)
    for i in range(nodes):
        kappa[i] = -kappa[i]
        edge[_PRESSURE, i] = constants[HOLD] * u[i]
    found = solve_bonds(laws, phi, n, sigma, kappa, edge)
    if found != SOLVED:
        return found
    second_derivative(n, constants[SPACING], out[:nodes])
    swept = 0.0
    for i in range(nodes):
        r = off_rate(laws, phi[i], edge, i)
        out[i] = constants[D] * out[i] + binding(laws, phi[i], r, n[i], edge, i)
        outward = velocity(laws, phi[i], r, sigma, kappa[i], edge, i)
        out[nodes + i] = outward
        swept += outward
    out[2 * nodes] = constants[TENSION_RATE] * constants[SPACING] * swept
    return SOLVED


@kernel
def _error(stages: np.ndarray, nodes: int, scales: np.ndarray) -> float:
    """Largest error of a unit step over the scales of bound fraction, height and tension."""
    largest = 0.0
    for m in range(stages.shape[1]):
        error = 0.0
        for i in range(_STAGES):
            error += _E[i] * stages[i, m]
        largest = max(largest, abs(error) / scales[m // nodes])
    return largest


@kernel
def run(
    laws: Any,
    edge: np.ndarray,
    times: np.ndarray,
    constants: np.ndarray,
    rtol: float,
    scales: np.ndarray,
    most_steps: int,
    records: np.ndarray,
    bond_forces: np.ndarray,
    curvatures: np.ndarray,
    counters: np.ndarray,
) -> tuple[int, int]:
    """Fill ``records`` (times, 2 nodes + 1) from its first on, bond forces and curvatures with it.

    The error of a step is held below ``rtol * scales`` in bound fraction, height and tension, at
    every node. Steps end on the records exactly.
    """
    nodes, size = bond_forces.shape[1], records.shape[1]
    state, after, stages = records[0].copy(), np.empty(size), np.empty((_STAGES, size))
    kappa, phi = np.empty(nodes), np.full(nodes, np.nan)
    trial_phi = np.empty(nodes)
    if rates(laws, edge, state, constants, kappa, phi, stages[0]) != SOLVED:
        return NO_ROOT, 0
    bond_forces[0], curvatures[0] = phi, kappa
    h = 1e-4
    for record in range(1, times.size):
        time, end = times[record - 1], times[record]
        while time < end:
            left = end - time
            trial = left if h >= 0.999 * left else min(h, 0.5 * left)
            if counters[STEPS] + counters[REJECTED] >= most_steps:
                return TOO_MANY_STEPS, record
            trial_phi[:] = phi
            found = SOLVED
            for i in range(1, _STAGES):
                after[:] = state
                for j in range(i):
                    factor = trial * _A[i, j]
                    for m in range(size):
                        after[m] += factor * stages[j, m]
                found = rates(laws, edge, after, constants, kappa, trial_phi, stages[i])
                if found != SOLVED:
                    break
            error = trial * _error(stages, nodes, scales) / rtol if found == SOLVED else np.inf
            if not error <= 1.0:
                counters[REJECTED] += 1
                h = trial * (max(0.2, _SAFETY * error**-0.2) if error < np.inf else 0.2)
                if h < _SHORTEST:
                    return NO_ROOT if found != SOLVED else STEP_TOO_SMALL, record
                continue
            counters[STEPS] += 1
            state[:], phi[:], stages[0] = after, trial_phi, stages[_STAGES - 1]
            time = end if trial == left else time + trial
            grown = trial * min(5.0, _SAFETY * max(error, 1e-10) ** -0.2)
            h = min(_LONGEST, max(h, grown) if trial < h else grown)
        records[record] = state
        bond_forces[record], curvatures[record] = phi, kappa
    return REACHED, times.size
