"""Walls that push back where the edge enters them."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from cellcrawl.arguments import checked
from cellcrawl.errors import InputError
from cellcrawl.laws.expressions import cos, maximum, sin
from cellcrawl.laws.law import Parameter
from cellcrawl.surroundings.base import Place, Surrounding
from cellcrawl.surroundings.lookup import polygon_depth
from cellcrawl.validation import real_array

_SAMPLES = 201  # of a wall
_DEEPEST = 0.25  # in cell radii: a cell may be squeezed at the start, not cut


class Channel(Surrounding):
    """Two straight walls: beyond half the width the edge is pushed back with ``stiffness``."""

    width = Parameter(2.5, 0.1, 1e3, "distance between the walls, in cell radii")
    angle = Parameter(0.0, -10.0, 10.0, "direction of the channel from the x axis, in radians")
    shift = Parameter(0.0, -1e3, 1e3, "where the middle of the channel is, across it")
    stiffness = Parameter(1e4, 0.0, 1e7, "pressure over how deep the edge is in a wall")

    def conflict(self, points: np.ndarray) -> str | None:
        across = points[:, 1] * np.cos(self.angle) - points[:, 0] * np.sin(self.angle) - self.shift
        return _cut(float(np.max(np.abs(across))) - 0.5 * self.width)

    def change(self, at: Place, p: Any) -> Mapping[str, Any]:
        across = at.y * cos(self.angle) - at.x * sin(self.angle) - self.shift
        depth = maximum(maximum(across, -across) - 0.5 * self.width, 0.0)
        return {"pressure": p.pressure + self.stiffness * depth}


@checked
class Walls(Surrounding):
    """An obstacle or a room with straight walls.

    Parameters
    ----------
    corners : array, shape (corners, 2)
        Of a polygon, in cell radii.
    room : bool
        Whether the cell is kept inside; outside unless given.
    """

    stiffness = Parameter(1e4, 0.0, 1e7, "pressure over how deep the edge is in a wall")

    def __init__(self, corners: Any, room: bool = False, **values: float) -> None:
        made = real_array("corners", corners, (None, 2))
        if len(made) < 3:
            raise InputError(f"corners has {len(made)} points: a polygon has 3 or more")
        super().__init__(**values)
        self.corners, self.room = made, room

    def table(self) -> np.ndarray:
        return _as_table(self.corners)

    def describe(self) -> dict[str, Any]:
        found = super().describe()
        own = {"corners": self.corners.tolist(), "room": self.room}
        return {**found, "values": {**own, **found["values"]}}

    def conflict(self, points: np.ndarray) -> str | None:
        table, outline = self.table(), _as_table(points)
        side = -1.0 if self.room else 1.0
        into = max(side * polygon_depth(table, 0.0, x, y) for x, y in points)
        ahead = np.roll(self.corners, -1, axis=0)
        part = np.linspace(0.0, 1.0, _SAMPLES)[:, None, None]
        wall = (self.corners + part * (ahead - self.corners)).reshape(-1, 2)
        return _cut(max(into, *(polygon_depth(outline, 0.0, x, y) for x, y in wall)))

    def change(self, at: Place, p: Any) -> Mapping[str, Any]:
        depth = self.look_up("polygon_depth", at)
        into = maximum(-depth if self.room else depth, 0.0)
        return {"pressure": p.pressure + self.stiffness * into}


def _as_table(points: np.ndarray) -> np.ndarray:
    return np.concatenate([[len(points)], points.ravel()])


def _cut(depth: float) -> str | None:
    if depth <= _DEEPEST:
        return None
    return f"cuts through the cell at the start, {depth:.2g} radii deep"
