"""The numerical schemes, by name."""

from __future__ import annotations

from cellcrawl.solvers.adaptive import AdaptiveSolver
from cellcrawl.solvers.base import Breakdown, Frame, Instant, Solver
from cellcrawl.solvers.paper import PaperSolver
from cellcrawl.solvers.spline import SplineSolver
from cellcrawl.solvers.stochastic import StochasticSolver

SOLVERS: dict[str, type[Solver]] = {
    solver.name: solver for solver in (AdaptiveSolver, PaperSolver, SplineSolver, StochasticSolver)
}

__all__ = ["SOLVERS", "Breakdown", "Frame", "Instant", "Solver"]
