"""The independent check scheme: markers on a periodic cubic spline."""

from __future__ import annotations

from cellcrawl.solvers.spline.solver import SplineSolver

__all__ = ["SplineSolver"]
