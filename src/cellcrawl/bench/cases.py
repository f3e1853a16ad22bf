"""What is solved in the benchmarks, and how far from the truth an answer is."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final

import numpy as np

from cellcrawl.parameters import Conditions, Parameters
from cellcrawl.solvers import SOLVERS, Frame
from cellcrawl.starts import CellState, PerturbedCircle, RandomPerturbation

POINTS: Final = ((26, 600), (24, 540), (36, 560), (16, 600), (56, 560))
LAWS: Final = ("printed", "consistent")
REFERENCE_RTOL: Final = 1e-9


@dataclass(frozen=True)
class Case:
    """One cell to simulate to a time."""

    r_on: float
    zeta_1: float
    elasticity: str = "printed"
    D: float = 0.05
    t_end: float = 5.0
    random: bool = False

    @property
    def parameters(self) -> Parameters:
        """The cell's parameters."""
        return Parameters(r_on=self.r_on, zeta_1=self.zeta_1, elasticity=self.elasticity, D=self.D)

    @property
    def conditions(self) -> Conditions:
        """The cell's parameters as solvers want them."""
        return Conditions(self.parameters)

    @property
    def label(self) -> str:
        """A short name."""
        return f"({self.r_on:g}, {self.zeta_1:g}) {self.elasticity}, D = {self.D:g}"

    def start(self, nodes: int) -> CellState:
        """Return the start: the paper's random one, or the deterministic check start."""
        p = self.parameters
        if self.random:
            return RandomPerturbation(seed=1).state(p, nodes)
        return check_start(p).state(p, nodes)


def check_start(parameters: Parameters) -> PerturbedCircle:
    """Return the deterministic start that all accuracy figures refer to."""
    n = parameters.n_bar
    return PerturbedCircle(
        radius={1: (0.01, 0.0), 2: (0.02, 0.0), 3: (0.0, 0.01)},
        bound_fraction={
            1: (0.05 * n * math.cos(0.3), -0.05 * n * math.sin(0.3)),
            2: (0.03 * n * math.cos(1.0), 0.03 * n * math.sin(1.0)),
        },
    )


def summary(frame: Frame) -> np.ndarray:
    """Return length and centroid, the quantities errors are measured in."""
    return np.array([frame.length, frame.centroid_x, frame.centroid_y])


def reference(case: Case) -> np.ndarray:
    """Return the converged `summary` of a case, by the adaptive solver at its tightest."""
    scheme = SOLVERS["adaptive"]
    start = case.start(scheme.start_nodes(256, rtol=REFERENCE_RTOL))
    solver = scheme(start, case.conditions, nodes=256, rtol=REFERENCE_RTOL)
    broken = solver.advance(case.t_end)
    if broken is not None:
        raise RuntimeError(f"no reference for {case.label}: {broken.message}")
    return summary(solver.frame(case.t_end))


def error(found: np.ndarray, truth: np.ndarray) -> float:
    """Return the larger of the relative error of the length and the centroid's distance."""
    length = abs(found[0] / truth[0] - 1.0)
    centroid = math.hypot(found[1] - truth[1], found[2] - truth[2])
    return float(max(length, centroid)) if np.isfinite(found).all() else math.inf
