"""The adaptive solver's state array: made from a cell, moved to another grid, read back."""

from __future__ import annotations

import math

import numpy as np

from cellcrawl.numerics import fourier
from cellcrawl.solvers.adaptive.entries import AREA, FIELDS, LENGTH, ORIGIN_X, SCALARS, TENSION
from cellcrawl.solvers.adaptive.staggered import HALO
from cellcrawl.solvers.adaptive.waves import resample
from cellcrawl.starts.base import CellState


def size(nodes: int) -> int:
    """Entries of a state on ``nodes`` nodes."""
    return FIELDS * (nodes + 2 * HALO) + SCALARS


def nodes_of(state: np.ndarray) -> int:
    """Nodes of a state, or of a stack of them."""
    return int(state.shape[-1] - SCALARS) // FIELDS - 2 * HALO


def angle(state: np.ndarray) -> np.ndarray:
    """Tangent angle less its winding at the nodes; a view."""
    return state[..., HALO : HALO + nodes_of(state)]


def bound(state: np.ndarray) -> np.ndarray:
    """Bound fraction at the midpoints; a view."""
    nodes = nodes_of(state)
    first = nodes + 3 * HALO
    return state[..., first : first + nodes]


def density(state: np.ndarray) -> np.ndarray:
    """Density of the arclength over the nodes, of mean 1, at the midpoints; a view."""
    nodes = nodes_of(state)
    first = 2 * nodes + 5 * HALO
    return state[..., first : first + nodes]


def fields(state: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Angle, bound fraction and density with their halos, of one state; views."""
    span = nodes_of(state) + 2 * HALO
    return state[:span], state[span : 2 * span], state[2 * span : 3 * span]


def scalars(state: np.ndarray) -> np.ndarray:
    """Length, tension, area and position of node 0; a view."""
    return state[..., -SCALARS:]


def winding(nodes: int) -> np.ndarray:
    """Tangent angle of a circle at the nodes."""
    return 2.0 * math.pi * np.arange(nodes) / nodes


def from_cell(cell: CellState, nodes: int) -> np.ndarray:
    """State of a cell on ``nodes`` nodes."""
    state = np.zeros(size(nodes))
    curve = cell.curve
    wobble = curve.theta - winding(curve.nodes)
    bound_fraction = cell.bound_fraction.copy()  # kernels compile anew for what is read-only
    if nodes != curve.nodes:
        resample(wobble, wobble, 0.0, angle(state), angle(state))
        resample(bound_fraction, bound_fraction, math.pi / nodes, bound(state), bound(state))
    else:
        angle(state)[:] = wobble
        bound(state)[:] = fourier.resample(bound_fraction, nodes, math.pi / nodes)
    density(state)[:] = 1.0
    values = scalars(state)
    values[LENGTH], values[TENSION], values[AREA] = curve.length, cell.tension, curve.area
    values[ORIGIN_X : ORIGIN_X + 2] = curve.origin
    return state
