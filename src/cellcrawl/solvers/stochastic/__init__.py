"""Few bonds: the model with the noise of their binding and unbinding."""

from cellcrawl.solvers.stochastic.scheme import StochasticSolver

__all__ = ["StochasticSolver"]
