"""States turned, mirrored and renumbered: the model treats them all alike."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from cellcrawl.curve import Curve
from cellcrawl.parameters import Parameters
from cellcrawl.starts import CellState


@dataclass(frozen=True, eq=False)
class Given:
    """A start that is a state already made; immutable."""

    given: CellState

    def state(self, parameters: Parameters, nodes: int) -> CellState:
        """Return the state; it must have as many nodes as are asked for."""
        if nodes != self.given.curve.nodes:
            raise ValueError(f"the state has {self.given.curve.nodes} nodes, not {nodes}")
        return self.given

    def describe(self) -> dict[str, Any]:
        return {"kind": "Given"}


def rotated(state: CellState, angle: float) -> CellState:
    """Return the state turned about (0, 0)."""
    c, s = math.cos(angle), math.sin(angle)
    curve = state.curve
    origin = np.array([[c, -s], [s, c]]) @ curve.origin
    turned = Curve(curve.theta + angle, curve.length, origin)
    return CellState(turned, state.bound_fraction, state.tension)


def reflected(state: CellState) -> CellState:
    """Return the state mirrored in the x axis, still counter-clockwise, node 0 in place."""
    curve = state.curve
    back = np.roll(np.arange(curve.nodes)[::-1], 1)
    theta = np.unwrap(math.pi - curve.theta[back])
    origin = curve.origin * np.array([1.0, -1.0])
    return CellState(Curve(theta, curve.length, origin), state.bound_fraction[back], state.tension)


def shifted(state: CellState, nodes: int) -> CellState:
    """Return the state with another node as node 0."""
    curve = state.curve
    theta = np.roll(curve.theta, -nodes)
    theta[-nodes:] += 2.0 * math.pi
    moved = Curve(theta, curve.length, curve.points[nodes])
    return CellState(moved, np.roll(state.bound_fraction, -nodes), state.tension)
