"""What is solved in the benchmarks, and how far from the truth an answer is."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final, NamedTuple

import numpy as np

from cellcrawl.parameters import Parameters
from cellcrawl.solvers import Instant, Solver
from cellcrawl.solvers.conditions import Conditions
from cellcrawl.starts import CellState, PerturbedCircle, RandomPerturbation

POINTS: Final = ((26, 600), (24, 540), (36, 560), (16, 600), (56, 560))
LAWS: Final = ("printed", "consistent")
LONG: Final = 50.0
"""From this length on a run is measured over its second half: a single time can be lucky."""
_RECORDS = 11  # over which it is measured


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

    @property
    def times(self) -> tuple[float, ...]:
        """When the cell is compared: at the end, or over the second half of a long run."""
        if self.t_end < LONG:
            return (self.t_end,)
        return tuple(float(t) for t in np.linspace(0.5 * self.t_end, self.t_end, _RECORDS))

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


class Errors(NamedTuple):
    """Largest errors over the times of a case: three relative ones, and a distance over R_0."""

    length: float
    tension: float
    area: float
    centroid: float

    @property
    def largest(self) -> float:
        """The larger of those of length and centroid, by which solvers are compared."""
        return max(self.length, self.centroid)


def summary(whole: Instant) -> list[float]:
    """Return length, tension, area and centroid, the quantities errors are measured in."""
    return [whole.length, whole.tension, whole.area, whole.centroid_x, whole.centroid_y]


def sampled(solver: Solver, times: tuple[float, ...]) -> np.ndarray:
    """Return the `summary` at rising times, shape (times, 5); NaN from where it breaks down on."""
    found = np.full((len(times), 5), np.nan)
    for row, time in zip(found, times, strict=True):
        if solver.advance(time) is not None:
            break
        row[:] = summary(solver.instant(time))
    return found


def errors(found: np.ndarray, truth: np.ndarray) -> Errors:
    """Return the largest errors over all times; infinite where there is no answer.

    Both have shape (times, 5): length, tension, area and centroid.
    """
    if not np.isfinite(found).all():
        return Errors(math.inf, math.inf, math.inf, math.inf)
    length, tension, area = np.abs(found[:, :3] / truth[:, :3] - 1.0).max(axis=0)
    away = np.hypot(*(found - truth)[:, 3:].T).max()
    return Errors(float(length), float(tension), float(area), float(away))
