"""The model as a plain system of equations on a uniform grid that never changes.

What a general solver is given to integrate, and of no use to ours: it shares the pointwise laws of
`cellcrawl.laws` with them and nothing else, so that it checks them too. Tangent angle less its
winding (``w``) at the nodes, bound fraction (``n``) at the midpoints between them, tenth-order
differences on that staggered grid; length, tension, area and the position of node 0 are integrated
beside them, and nothing ties the shape's own area to the tension: its error falls with the grid.
"""

from __future__ import annotations

import math
from typing import Any, Final, NamedTuple

import numpy as np

from cellcrawl.laws.force_balance import SOLVED, halley_step, solve_bonds
from cellcrawl.laws.functions import (
    binding,
    nearly_renewed_rate,
    off_rate,
    renewed_rate,
    velocity,
)
from cellcrawl.laws.rest import rest_state
from cellcrawl.numerics import fourier
from cellcrawl.numerics.kernels import kernel
from cellcrawl.solvers.conditions import Conditions
from cellcrawl.starts import CellState

SCALARS: Final = 5  # length, tension, area, position of node 0: the last entries of a state
_PAD = 5
_ROWS = 8  # of the work array, each with room to wrap a stencil round
_W, _N, _KAPPA, _RATE, _SPEED, _STRETCH, _SLIDE, _BINDING = range(_ROWS)
_NEAR, _SETTLED = 0.12, 4e-6  # steps of the force from which two Halley steps reach rounding

# weights by distance: derivative and mean half-way between samples, derivatives at a sample, mean
# over a cell
_BETWEEN = np.array([19845 / 16384, -735 / 8192, 567 / 40960, -405 / 229376, 35 / 294912])
_MIDDLE = np.array([19845 / 32768, -2205 / 16384, 567 / 16384, -405 / 65536, 35 / 65536])
_CENTRAL = np.array([5 / 6, -5 / 21, 5 / 84, -5 / 504, 1 / 1260])
_SECOND = np.array([5 / 3, -5 / 21, 5 / 126, -5 / 1008, 1 / 3150])
_SECOND_AT = -5269 / 1800
_CELL = np.array([3629953 / 58060800, -801973 / 116121600, 49879 / 58060800, -27859 / 464486400])
_CELL_AT = 41208059 / 46448640


class Whole(NamedTuple):
    """The cell as a whole, measured on its shape by Fourier series."""

    length: float
    tension: float
    area: float
    centroid_x: float
    centroid_y: float


class UniformGrid:
    """The equations of one cell on a fixed number of nodes.

    Parameters
    ----------
    start : CellState
        On at least as many nodes.
    conditions : Conditions
        Constant in time.
    nodes : int
    """

    def __init__(self, start: CellState, conditions: Conditions, nodes: int) -> None:
        curve = start.curve
        winding = 2.0 * math.pi * np.arange(curve.nodes) / curve.nodes
        scalars = [curve.length, start.tension, curve.area, *curve.origin]
        self.start = np.concatenate(
            [
                fourier.resample(curve.theta - winding, nodes),
                fourier.resample(start.bound_fraction, nodes, math.pi / nodes),
                scalars,
            ]
        )
        self.nodes = nodes
        self.calls = 0
        self._edge = conditions.edge(0.0, nodes)
        self._tension_rate = conditions.tension_rate(0.0)
        self._laws = conditions.laws.compiled
        rest = rest_state(conditions.at(0.0), conditions.laws)
        self._phi = np.full(nodes, rest.bond_force)
        self._work = np.zeros((_ROWS, nodes + 2 * _PAD))
        self._work[_RATE] = rest.off_rate

    def __call__(self, t: float, u: np.ndarray, out: np.ndarray) -> None:
        """Write the rates of ``u`` to ``out``; NaN where the forces have no balance."""
        self.calls += 1
        if not _rates(self._laws, u, out, self._phi, self._edge, self._tension_rate, self._work):
            out[:] = np.nan

    def function(self, t: float, u: np.ndarray) -> np.ndarray:
        """Return the rates of ``u``."""
        out = np.empty_like(u)
        self(t, u, out)
        return out

    def whole(self, u: np.ndarray) -> Whole:
        """Return length, tension, area of the shape and its centroid."""
        nodes = self.nodes
        length, tension, _, origin_x, origin_y = map(float, u[2 * nodes :])
        theta = u[:nodes] + 2.0 * math.pi * np.arange(nodes) / nodes
        tangent = np.exp(1j * theta)
        tangent -= tangent.mean()  # spreads the gap between the ends
        place = fourier.integral(tangent, length)
        x, y, step = place.real, place.imag, length / nodes
        area = 0.5 * step * float(np.sum(x * tangent.imag - y * tangent.real))
        moment_x = 0.5 * step * float(np.sum(x * x * tangent.imag))
        moment_y = -0.5 * step * float(np.sum(y * y * tangent.real))
        return Whole(length, tension, area, origin_x + moment_x / area, origin_y + moment_y / area)


@kernel
def _wrap(a: np.ndarray, nodes: int) -> None:
    for k in range(_PAD):
        a[k] = a[nodes + k]
        a[_PAD + nodes + k] = a[_PAD + k]


@kernel
def _rates(
    laws: Any,
    u: np.ndarray,
    out: np.ndarray,
    phi: np.ndarray,
    edge: np.ndarray,
    tension_rate: float,
    work: np.ndarray,
) -> bool:
    """Rates of a state from the last ``phi``; False where the forces have no balance."""
    nodes = phi.size
    length, sigma = u[2 * nodes], u[2 * nodes + 1]
    if not 0.0 < length < np.inf:
        return False
    w, n, slide = work[_W], work[_N], work[_SLIDE]
    speed, stretch, bound = work[_SPEED], work[_STRETCH], work[_BINDING]
    per_spacing, winding, spacing = nodes / length, 2.0 * math.pi / length, length / nodes
    for i in range(nodes):
        w[_PAD + i] = u[i]
        n[_PAD + i] = u[nodes + i]
    _wrap(w, nodes)
    _wrap(n, nodes)
    if not _velocities(laws, sigma, winding, per_spacing, phi, edge, work):
        return False
    _wrap(speed, nodes)
    _wrap(stretch, nodes)
    mean = area_t = 0.0
    for i in range(_PAD, nodes + _PAD):
        mean += stretch[i]
        area_t += speed[i]
    mean /= nodes
    running = 0.0
    for i in range(nodes):
        j = i + _PAD
        slide[j] = running
        inside = _CELL_AT * stretch[j]
        for k in range(4):
            inside += _CELL[k] * (stretch[j + 1 + k] + stretch[j - 1 - k])
        running += spacing * (mean - inside)
    _wrap(slide, nodes)
    for i in range(nodes):
        j = i + _PAD
        bend = speed_s = n_s = slid = 0.0
        n_ss = _SECOND_AT * n[j]
        for k in range(5):
            bend += _CENTRAL[k] * (w[j + 1 + k] - w[j - 1 - k])
            speed_s += _BETWEEN[k] * (speed[j + k] - speed[j - 1 - k])
            n_s += _CENTRAL[k] * (n[j + 1 + k] - n[j - 1 - k])
            n_ss += _SECOND[k] * (n[j + 1 + k] + n[j - 1 - k])
            slid += _MIDDLE[k] * (slide[j + 1 + k] + slide[j - k])
        out[i] = slide[j] * (winding + per_spacing * bend) - per_spacing * speed_s
        spread = edge[2, i] * per_spacing * per_spacing * n_ss
        out[nodes + i] = bound[j] + spread + slid * per_spacing * n_s
    first_speed = 0.0
    for k in range(5):
        first_speed += _MIDDLE[k] * (speed[_PAD + k] + speed[_PAD - 1 - k])
    area_t *= spacing
    out[2 * nodes] = length * mean
    out[2 * nodes + 1] = tension_rate * area_t
    out[2 * nodes + 2] = area_t
    out[2 * nodes + 3] = first_speed * math.sin(u[0])
    out[2 * nodes + 4] = -first_speed * math.cos(u[0])
    return True


@kernel
def _velocities(
    laws: Any,
    sigma: float,
    winding: float,
    per_spacing: float,
    phi: np.ndarray,
    edge: np.ndarray,
    work: np.ndarray,
) -> bool:
    """Off-rate, velocity and binding at the midpoints; False where the balance has no root."""
    nodes = phi.size
    w, n, kappa, rate = work[_W], work[_N], work[_KAPPA], work[_RATE]
    unsettled = 0
    for i in range(nodes):
        j = i + _PAD
        bend = 0.0
        for k in range(5):
            bend += _BETWEEN[k] * (w[j + 1 + k] - w[j - k])
        kappa[i] = winding + per_spacing * bend
        r = rate[i]  # of the last state: an exponential less
        first = halley_step(laws, phi[i], r, n[j], sigma, kappa[i], edge, i)
        near = phi[i] + first
        r = renewed_rate(laws, r, near, first, edge, i)
        second = halley_step(laws, near, r, n[j], sigma, kappa[i], edge, i)
        phi[i] = near + second
        rate[i] = nearly_renewed_rate(laws, r, phi[i], second, edge, i)
        good = (abs(first) < _NEAR) & (abs(second) < _SETTLED) & (phi[i] >= 0.0) & (rate[i] > 0.5)
        unsettled += 0 if good else 1
    if unsettled > 0:
        at_midpoints = n[_PAD : _PAD + nodes]
        if solve_bonds(laws, phi, at_midpoints, sigma, kappa[:nodes], edge) != SOLVED:
            return False
        for i in range(nodes):
            rate[i] = off_rate(laws, phi[i], edge, i)
    for i in range(nodes):
        j = i + _PAD
        work[_SPEED, j] = velocity(laws, phi[i], rate[i], sigma, kappa[i], edge, i)
        work[_STRETCH, j] = kappa[i] * work[_SPEED, j]
        work[_BINDING, j] = binding(laws, phi[i], rate[i], n[j], edge, i)
    return True
