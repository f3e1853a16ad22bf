"""One step with noise: Heun's for the shape, trapezoids for the linkers, one kick for both.

The state is that of the paper's scheme. A step is tried once, with the velocities and off-rates at
its beginning, and taken with the means of those at both ends; the kick of the noise is that of the
beginning (Ito). Reaction, diffusion and drift of the linkers are trapezoids: while the off-rate
stays, every wave of the grid has its exact variance and its exact integral in time, whatever the
step.
"""

from __future__ import annotations

import math
from typing import Any, Final

import numpy as np

from cellcrawl.laws.force_balance import SOLVED, halley_step
from cellcrawl.laws.functions import binding, off_rate, partials, turnover, velocity
from cellcrawl.numerics.cyclic import solve_cyclic_tridiagonal
from cellcrawl.numerics.kernels import inlined_kernel, kernel
from cellcrawl.solvers.paper.step import (
    LENGTH,
    NO_ROOT,
    NOT_FINITE,
    ORIGIN_X,
    ORIGIN_Y,
    STEPPED,
    TENSION,
    measure,
)
from cellcrawl.solvers.paper.tangent_angle import (
    central_difference,
    curvature,
    tangential_velocity,
)
from cellcrawl.solvers.stochastic.normals import fill_normals
from cellcrawl.surroundings.place import balance_in_place

# rows of a set of slopes: of the angle, tangential velocity, binding at the old n, its slope, D
_TURN, _SLIDE, _BIND, _LOSS, _SPREAD = range(5)
_SLOPES: Final = 5
WORK_ROWS: Final = 2 * _SLOPES + 18
# entries of `tally`: kicks, those near an end of [0, 1], those too strong for it, values cut off
KICKS, NEAR, WEAKENED, CUT = range(4)
TALLY: Final = 4
_FAR: Final = 4.0  # deviations from an end of [0, 1] at which a kick is normal
_ROOT_HALF: Final = math.sqrt(0.5)


@inlined_kernel
def kicked(mean: float, top: float, variance: float, normal: float, tally: np.ndarray) -> float:
    """A random number in [0, top] of that mean and variance, made from a normal one.

    Near an end it is one of two values; the variance can be ``mean * (top - mean)`` at most.
    """
    tally[KICKS] += 1
    room = min(mean, top - mean)
    deviation = math.sqrt(variance)
    if _FAR * deviation <= room:
        return min(max(mean + deviation * normal, 0.0), top)
    tally[NEAR] += 1
    if room <= 0.0:
        tally[CUT] += 1
        return min(max(mean, 0.0), top)
    most = mean * (top - mean)
    if variance > most:
        tally[WEAKENED] += 1
        variance, deviation = most, math.sqrt(most)
    below = min(deviation, mean)
    above = variance / below
    if above > top - mean:
        above = top - mean
        below = variance / above
    is_above = 0.5 * math.erfc(_ROOT_HALF * normal) < below / (below + above)
    return mean + above if is_above else mean - below


@kernel
def kicked_linkers(
    n: np.ndarray,
    slopes: np.ndarray,
    spacing: float,
    dt: float,
    variance: np.ndarray,
    normals: np.ndarray,
    out: np.ndarray,
    tally: np.ndarray,
    work: np.ndarray,
) -> None:
    """Step ``n`` by trapezoids with a kick into ``out``; off-rate and drift are held.

    The matrix has no negative entry in its inverse, and its rows have the sum ``top``: what a kick
    leaves in [0, top] on the right is in [0, 1] on the left.
    """
    nodes = n.size
    lower, diagonal, upper, right = work[0], work[1], work[2], work[3]
    half = 0.5 * dt
    for i in range(nodes):
        spread = half * slopes[_SPREAD, i] / (spacing * spacing)
        drift = half * slopes[_SLIDE, i] / (2.0 * spacing)
        lower[i] = drift - spread
        upper[i] = -drift - spread
        top = 1.0 - half * slopes[_LOSS, i]
        diagonal[i] = top + 2.0 * spread
        before = n[i - 1] if i > 0 else n[nodes - 1]
        after = n[i + 1] if i < nodes - 1 else n[0]
        mean = (top - 2.0 * spread) * n[i] + dt * slopes[_BIND, i]
        mean -= lower[i] * before + upper[i] * after
        right[i] = kicked(mean, top, variance[i], normals[i], tally)
    solve_cyclic_tridiagonal(lower, diagonal, upper, right, work[4:6])
    for i in range(nodes):
        tally[CUT] += 1 if not 0.0 <= right[i] <= 1.0 else 0
        out[i] = min(max(right[i], 0.0), 1.0)


@kernel
def slopes_of(
    laws: Any,
    local: np.ndarray,
    length: float,
    tension: float,
    n: np.ndarray,
    y: np.ndarray,
    kappa: np.ndarray,
    held: np.ndarray,
    slopes: np.ndarray,
    work: np.ndarray,
) -> tuple[float, float]:
    """Fill ``slopes`` at a state, with the binding at ``held``; velocity of node 0, stretching."""
    nodes = n.size
    speed, along, spare = work[0], work[1], work[2:4]
    for i in range(nodes):
        r = off_rate(laws, y[i], local, i)
        speed[i] = velocity(laws, y[i], r, tension, kappa[i], local, i)
        slopes[_BIND, i] = binding(laws, y[i], r, held[i], local, i)
        _, _, _, _, _, _, _, _, loss = partials(laws, y[i], r, held[i], tension, kappa[i], local, i)
        slopes[_LOSS, i] = loss
        slopes[_SPREAD, i] = local[2, i]
    central_difference(speed, length / nodes, 0.0, along)
    growth = tangential_velocity(kappa, speed, length, slopes[_SLIDE], spare)
    for i in range(nodes):
        slopes[_TURN, i] = slopes[_SLIDE, i] * kappa[i] - along[i]
    return speed[0], growth


@kernel
def _approach(
    laws: Any, y: np.ndarray, n: np.ndarray, sigma: float, kappa: np.ndarray, edge: np.ndarray
) -> None:
    """Bring the force on the bonds so near its root after a kick that the last steps are few."""
    for i in range(n.size):
        for _ in range(2):
            r = off_rate(laws, y[i], edge, i)
            y[i] += halley_step(laws, y[i], r, n[i], sigma, kappa[i], edge, i)


@kernel
def advance(
    laws: Any,
    around: Any,
    time: float,
    steps: int,
    dt: float,
    tension_rate: float,
    bonds: float,
    seed: int,
    taken_before: int,
    edge: np.ndarray,
    theta: np.ndarray,
    n: np.ndarray,
    y: np.ndarray,
    scalars: np.ndarray,
    tally: np.ndarray,
    work: np.ndarray,
) -> tuple[int, int, int]:
    """Take up to ``steps`` steps in place, as `cellcrawl.solvers.paper.step.advance` does.

    ``bonds`` is their number on a unit length, ``taken_before`` the number of the first step's
    noise.
    """
    nodes = theta.size
    first, last = work[:_SLOPES], work[_SLOPES : 2 * _SLOPES]
    rest = work[2 * _SLOPES :]
    kappa, variance, normals = rest[0], rest[1], rest[2]
    x, z, cosine, sine = rest[3], rest[4], rest[5], rest[6]
    new_theta, new_n, new_y, bend, spare = rest[7], rest[8], rest[9], rest[10], rest[12:18]
    new = scalars.copy()
    local = edge
    if around is not None:
        local = around.local
    for step in range(steps):
        length, sigma = scalars[LENGTH], scalars[TENSION]
        curvature(theta, length, kappa)
        speed, growth = slopes_of(laws, local, length, sigma, n, y, kappa, n, first, spare)
        per_bond = dt * nodes / (bonds * length)
        for i in range(nodes):
            r = off_rate(laws, y[i], local, i)
            changes = turnover(laws, y[i], r, n[i], local, i)
            variance[i] = max(changes, 0.0) * per_bond
        fill_normals(seed, taken_before + step, normals)
        pushed_x, pushed_y = speed * math.sin(theta[0]), -speed * math.cos(theta[0])
        stretch, spacing = length * growth, length / nodes
        for attempt in range(2):
            if attempt == 1:
                curvature(new_theta, new[LENGTH], bend)
                speed, growth = slopes_of(
                    laws, local, new[LENGTH], new[TENSION], new_n, new_y, bend, n, last, spare
                )
                for row in range(_SLOPES):
                    for i in range(nodes):
                        first[row, i] = 0.5 * (first[row, i] + last[row, i])
                stretch = 0.5 * (stretch + new[LENGTH] * growth)
                pushed_x = 0.5 * (pushed_x + speed * math.sin(new_theta[0]))
                pushed_y = 0.5 * (pushed_y - speed * math.cos(new_theta[0]))
                spacing = 0.5 * (length + new[LENGTH]) / nodes
            for i in range(nodes):
                new_theta[i] = theta[i] + dt * first[_TURN, i]
            new[LENGTH] = length + dt * stretch
            new[ORIGIN_X] = scalars[ORIGIN_X] + dt * pushed_x
            new[ORIGIN_Y] = scalars[ORIGIN_Y] + dt * pushed_y
            if not (0.0 < new[LENGTH] < np.inf):
                return NOT_FINITE, 0, step
            measure(new_theta, scalars, tension_rate, cosine, sine, bend, x, z, new)
            kicked_linkers(n, first, spacing, dt, variance, normals, new_n, tally, spare)
            if not (math.isfinite(new[TENSION]) and math.isfinite(new_n.sum() + bend.sum())):
                return NOT_FINITE, 0, step
            if attempt == 0:
                new_y[:] = y
            if around is not None:
                for i in range(nodes):
                    x[i] += new[ORIGIN_X]
                    z[i] += new[ORIGIN_Y]
            _approach(laws, new_y, new_n, new[TENSION], bend, local)
            failed = balance_in_place(
                laws,
                around,
                time + (step + 1) * dt,
                x,
                z,
                cosine,
                sine,
                bend,
                new[TENSION],
                new_n,
                new_y,
                edge,
            )
            if failed != SOLVED:
                return NO_ROOT, failed, step
        theta[:] = new_theta
        n[:] = new_n
        y[:] = new_y
        scalars[:] = new
    return STEPPED, 0, steps
