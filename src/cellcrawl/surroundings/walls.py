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
from cellcrawl.validation import real_array


class Channel(Surrounding):
    """Two straight walls: beyond half the width the edge is pushed back with ``stiffness``."""

    width = Parameter(2.5, 0.1, 1e3, "distance between the walls, in cell radii")
    angle = Parameter(0.0, -10.0, 10.0, "direction of the channel from the x axis, in radians")
    shift = Parameter(0.0, -1e3, 1e3, "where the middle of the channel is, across it")
    stiffness = Parameter(1e4, 0.0, 1e7, "pressure over how deep the edge is in a wall")

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
        return np.concatenate([[len(self.corners)], self.corners.ravel()])

    def describe(self) -> dict[str, Any]:
        found = super().describe()
        own = {"corners": self.corners.tolist(), "room": self.room}
        return {**found, "values": {**own, **found["values"]}}

    def change(self, at: Place, p: Any) -> Mapping[str, Any]:
        depth = self.look_up("polygon_depth", at)
        into = maximum(-depth if self.room else depth, 0.0)
        return {"pressure": p.pressure + self.stiffness * into}
