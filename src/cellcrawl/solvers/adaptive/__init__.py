"""The adaptive solver: the user gives a tolerance, it chooses nodes and steps."""

from cellcrawl.solvers.adaptive.solver import AdaptiveSolver

__all__ = ["AdaptiveSolver"]
