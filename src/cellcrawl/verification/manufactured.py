"""A manufactured solution of the full system: a circle that travels and breathes.

Its bound fraction and off-rate are prescribed waves along the edge. Parameters may vary along the
edge and in time, so r_on, v_p and sigma_c are chosen such that the prescribed cell solves the
model exactly: kinetics with diffusion and sliding nodes, shape, elasticity and force balance.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, Final

import numpy as np

from cellcrawl.curve import Curve
from cellcrawl.parameters import Parameters
from cellcrawl.solvers import SOLVERS, Frame
from cellcrawl.solvers.conditions import Conditions
from cellcrawl.starts import CellState

DRIFT: Final = 0.3  # speed over radius
SWELL: Final = 0.01  # radius 1 + SWELL sin t
START: Final = 1.0  # polar angle of node 0 at t = 0
T_END: Final = 1.0


def radius(t: float) -> float:
    """The radius of the cell."""
    return 1.0 + SWELL * math.sin(t)


def center_x(t: float) -> float:
    """The centre moves along x at speed DRIFT times the radius."""
    return DRIFT * (t + SWELL * (1.0 - math.cos(t)))


def polar_angles(t: float, nodes: int) -> np.ndarray:
    """Polar angle of the nodes: node 0 moves along its normal, the rest keep their distances."""
    first = 2.0 * math.atan(math.tan(0.5 * START) * math.exp(DRIFT * t))
    return np.asarray(first + 2.0 * math.pi * np.arange(nodes) / nodes)


def bound(phi: np.ndarray, t: float) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Bound fraction, n_t, n_phi and n_phiphi: a wave of many harmonics that travels."""
    turn = phi - 0.7 * t
    size = 0.4 * math.cos(0.5 * t)
    bump = np.exp(2.0 * (np.cos(turn) - 1.0))
    slope = -2.0 * np.sin(turn) * bump
    bend = (4.0 * np.sin(turn) ** 2 - 2.0 * np.cos(turn)) * bump
    n_t = -0.2 * math.sin(0.5 * t) * bump - 0.7 * size * slope
    return 0.3 + size * bump, n_t, size * slope, size * bend


def off_rate(phi: np.ndarray, t: float) -> np.ndarray:
    """The off-rate, a wave that turns."""
    return np.asarray(40.0 + 20.0 * np.sin(phi + 0.4 * t) + 5.0 * np.cos(3.0 * phi))


@dataclass(frozen=True)
class Manufactured(Conditions):
    """Parameters along the edge and in time that make the prescribed cell a solution."""

    def tension(self, t: float) -> float:
        """The tension that goes with the area."""
        stretched = math.pi * (radius(t) ** 2 - radius(0.0) ** 2)
        return 800.0 + self.parameters.tension_rate * stretched

    def edge(self, time: float, nodes: int, *, before: bool = False) -> np.ndarray:
        p, phi, size = self.parameters, polar_angles(time, nodes), radius(time)
        n, n_t, n_phi, n_bend = bound(phi, time)
        r = off_rate(phi, time)
        speed = DRIFT * size  # of the centre
        outward = speed * np.cos(phi) + SWELL * math.cos(time)
        along = -speed * np.sin(phi)  # the centre's velocity along the tangent
        r_on = (n_t - along / size * n_phi + r * n - p.D * n_bend / size**2) / (1.0 - n)
        pull = (r + p.zeta_1 * n) * np.log(r)
        sigma_c = pull - self.tension(time) * (1.0 + p.h / size)
        v_p = outward / p.epsilon + r * np.log(r)
        held = [np.full(nodes, value) for value in (p.zeta_1, p.D, p.epsilon, p.h)]
        return np.ascontiguousarray([r_on, *held, sigma_c, v_p, np.zeros(nodes)])  # no pressure

    @property
    def uniform(self) -> bool:
        return False

    def varies(self, start: float, end: float) -> bool:
        return True


P: Final = Parameters(zeta_1=50)  # stable: nothing magnifies the errors made


def solve(name: str, **options: Any) -> tuple[Frame, Manufactured]:
    """Return the cell as a solver has it at `T_END`, and its parameters."""
    scheme = SOLVERS[name]
    nodes = scheme.checked_nodes(options.pop("nodes", 256))
    count = scheme.start_nodes(nodes, **options)
    phi, conditions = polar_angles(0.0, count), Manufactured(P)
    first = np.array([math.cos(phi[0]), math.sin(phi[0])])
    curve = Curve(phi + 0.5 * math.pi, 2.0 * math.pi, first)
    start = CellState(curve, bound(phi, 0.0)[0], conditions.tension(0.0))
    solver = scheme(start, conditions, nodes=nodes, **options)
    broken = solver.advance(T_END)
    if broken is not None:
        raise RuntimeError(broken.message)
    return solver.frame(T_END), conditions


def errors(frame: Frame, conditions: Manufactured) -> dict[str, float]:
    """Return the errors of every field of a frame at `T_END`."""
    phi, size = polar_angles(T_END, frame.x.size), radius(T_END)
    return {
        "position": float(
            np.hypot(
                frame.x - center_x(T_END) - size * np.cos(phi), frame.y - size * np.sin(phi)
            ).max()
        ),
        "bound_fraction": float(np.abs(frame.bound_fraction - bound(phi, T_END)[0]).max()),
        "off_rate": float(np.abs(frame.off_rate / off_rate(phi, T_END) - 1.0).max()),
        "length": abs(frame.length / (2.0 * math.pi * size) - 1.0),
        "tension": abs(frame.tension / conditions.tension(T_END) - 1.0),
    }
