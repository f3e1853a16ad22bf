"""The paper's scheme: explicit Euler for shape and tension, Crank-Nicolson for the linkers."""

from cellcrawl.solvers.paper.scheme import PaperSolver

__all__ = ["PaperSolver"]
