"""Geometry of ellipses, whose length, area, centroid and curvature are known."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Final

import numpy as np

from cellcrawl.curve import Curve, from_path
from cellcrawl.parameters import Parameters
from cellcrawl.solvers import SOLVERS
from cellcrawl.starts import CellState
from cellcrawl.verification.check import Result, at_most
from cellcrawl.verification.engines import frames, started
from cellcrawl.verification.transformations import Given

AXES: Final = ((1.0, 1.0), (2.0, 1.0), (1.0, 0.4), (3.0, 1.0))
_SAMPLES: Final = 1024
_CENTER: Final = (0.3, -0.2)


def ellipse(a: float, b: float, nodes: int = 512) -> tuple[Curve, np.ndarray]:
    """Return an ellipse about (0, 0), and its parameter at the nodes."""
    t = 2.0 * math.pi * np.arange(_SAMPLES) / _SAMPLES
    return from_path(a * np.cos(t) + 1j * b * np.sin(t), nodes)


def ellipse_length(a: float, b: float) -> float:
    """Return the length of an ellipse with a >= b, by the arithmetic-geometric mean."""
    total, weight = a * a - 0.5 * (a * a - b * b), 1.0
    x, y = a, b
    while abs(x - y) > 1e-9:
        x, y, half = 0.5 * (x + y), math.sqrt(x * y), 0.5 * (x - y)
        total -= weight * half * half
        weight *= 2.0
    return 2.0 * math.pi * total / (0.5 * (x + y))


def ellipse_curvature(a: float, b: float, t: np.ndarray) -> np.ndarray:
    """Return the curvature of an ellipse at parameters ``t``."""
    return np.asarray(a * b / (a**2 * np.sin(t) ** 2 + b**2 * np.cos(t) ** 2) ** 1.5)


def curve_errors(a: float, b: float, nodes: int = 512) -> dict[str, float]:
    """Return what `Curve` gets wrong of an ellipse: relative, or in units of its size."""
    curve, t = ellipse(a, b, nodes)
    exact = np.column_stack([a * np.cos(t), b * np.sin(t)])
    return {
        "length": abs(curve.length / ellipse_length(max(a, b), min(a, b)) - 1.0),
        "area": abs(curve.area / (math.pi * a * b) - 1.0),
        "centroid": float(np.abs(curve.moved(_CENTER).centroid - _CENTER).max()),
        "curvature": float(np.abs(curve.curvature / ellipse_curvature(a, b, t) - 1.0).max()),
        "points": float(np.abs(curve.points - exact).max()),
    }


def solver_errors(name: str, a: float, b: float, **options: float) -> dict[str, float]:
    """Return what a solver's first frame gets wrong of an ellipse it is given."""
    p = Parameters(sigma_c=300.0)
    scheme = SOLVERS[name]
    nodes = scheme.checked_nodes(options.pop("nodes", None))
    curve, _ = ellipse(a, b, scheme.start_nodes(nodes, **options))
    state = CellState(curve.moved(_CENTER), np.full(curve.nodes, p.n_bar), p.sigma_bar)
    (frame,) = frames(started(name, p, Given(state), nodes=nodes, **options), [0.0])
    _, t = ellipse(a, b, nodes)
    exact = np.array([a * np.cos(t) + _CENTER[0], b * np.sin(t) + _CENTER[1]])
    centroid = math.hypot(frame.centroid_x - _CENTER[0], frame.centroid_y - _CENTER[1])
    return {
        "length": abs(frame.length / ellipse_length(max(a, b), min(a, b)) - 1.0),
        "area": abs(frame.area / (math.pi * a * b) - 1.0),
        "centroid": centroid,
        "curvature": float(np.abs(frame.curvature / ellipse_curvature(a, b, t) - 1.0).max()),
        "points": float(np.abs(np.array([frame.x, frame.y]) - exact).max()),
    }


LIMITS: Final = {
    "length": 1e-12,
    "area": 1e-11,
    "centroid": 1e-9,
    "curvature": 1e-7,
    "points": 1e-11,
}
"""What `curve_errors` may be at 512 nodes."""

_SOLVER_LIMITS: Final = {"adaptive": 1e-5, "spline": 1e-5, "paper": 1e-4}
_SOLVER_OPTIONS: Final[dict[str, dict[str, float]]] = {"adaptive": {"rtol": 1e-8}}


def curves(full: bool) -> Iterator[Result]:
    """Measure ellipses as curves with equally spaced nodes."""
    found = {axes: curve_errors(*axes) for axes in AXES}
    for name, limit in LIMITS.items():
        worst = max(AXES, key=lambda axes: found[axes][name])
        yield at_most(
            f"error of the {name} of ellipses on 512 nodes",
            found[worst][name],
            limit,
            note=f"worst at half axes {worst[0]:g} and {worst[1]:g}",
        )


def of_solvers(full: bool) -> Iterator[Result]:
    """Measure ellipses as each solver sees them."""
    for name, limit in _SOLVER_LIMITS.items():
        errors = solver_errors(name, 1.3, 0.8, **_SOLVER_OPTIONS.get(name, {}))
        worst = max(errors, key=lambda key: errors[key])
        yield at_most(
            f"error of an ellipse's length, area, centroid, curvature and points in the {name} "
            "solver",
            errors[worst],
            limit,
            note=f"usual nodes; the largest is that of the {worst}",
            values=errors,
        )
