"""What surroundings ask of a table or of the cell's motion at a place, for kernels."""

from __future__ import annotations

import math
from typing import Final

import numpy as np

from cellcrawl.numerics.kernels import inlined_kernel, kernel

APPEARS: Final = 0.5  # time over which a disc comes or goes


@kernel
def image_value(data: np.ndarray, table: float, x: float, y: float) -> float:
    """Value of an image, by a cubic B-spline-free Catmull-Rom patch; its border outside.

    The table holds rows, columns, x and y of the middle of the first pixel, the size of a pixel,
    and the values, row by row, the first at the lowest y.
    """
    k = int(table)
    rows, columns = int(data[k]), int(data[k + 1])
    u, v = (x - data[k + 2]) / data[k + 4], (y - data[k + 3]) / data[k + 4]
    u, v = min(max(u, 0.0), columns - 1.0), min(max(v, 0.0), rows - 1.0)
    column, row = min(int(u), columns - 2), min(int(v), rows - 2)
    value = 0.0
    for i in range(-1, 3):
        line = 0.0
        at = k + 5 + min(max(row + i, 0), rows - 1) * columns
        for j in range(-1, 3):
            line += _weight(u - column - j) * data[at + min(max(column + j, 0), columns - 1)]
        value += _weight(v - row - i) * line
    return value


@inlined_kernel
def _weight(t: float) -> float:
    """Weight of a sample ``t`` away in cubic convolution (Keys 1981, a = -1/2)."""
    s = abs(t)
    if s < 1.0:
        return (1.5 * s - 2.5) * s * s + 1.0
    if s < 2.0:
        return ((-0.5 * s + 2.5) * s - 4.0) * s + 2.0
    return 0.0


@kernel
def polygon_depth(data: np.ndarray, table: float, x: float, y: float) -> float:
    """How deep a place is inside a polygon: distance to its edge, below 0 outside.

    The table holds the number of corners and their x and y in turn.
    """
    k = int(table)
    corners = int(data[k])
    least, inside = math.inf, False
    for i in range(corners):
        j = (i + 1) % corners
        ax, ay = data[k + 1 + 2 * i], data[k + 2 + 2 * i]
        bx, by = data[k + 1 + 2 * j], data[k + 2 + 2 * j]
        dx, dy = bx - ax, by - ay
        part = ((x - ax) * dx + (y - ay) * dy) / (dx * dx + dy * dy)
        part = min(max(part, 0.0), 1.0)
        gap_x, gap_y = x - ax - part * dx, y - ay - part * dy
        least = min(least, gap_x * gap_x + gap_y * gap_y)
        if (ay > y) != (by > y) and x < ax + (y - ay) / (by - ay) * dx:
            inside = not inside
    return math.sqrt(least) if inside else -math.sqrt(least)


@inlined_kernel
def angle_from_front(velocity_x: float, velocity_y: float, arm_x: float, arm_y: float) -> float:
    """Angle from the velocity to an arm, positive to the left."""
    ahead = velocity_x * arm_x + velocity_y * arm_y
    return math.atan2(velocity_x * arm_y - velocity_y * arm_x, ahead)


@inlined_kernel
def _swell(u: float) -> float:
    """From 0 at 0 to 1 at 1, smoothly."""
    u = min(max(u, 0.0), 1.0)
    return u * u * (3.0 - 2.0 * u)


@inlined_kernel
def _part_there(time: float, begin: float, end: float) -> float:
    """How much of a disc is there: it comes and goes within `APPEARS`."""
    return _swell((time - begin) / APPEARS) * (1.0 - _swell((time - end) / APPEARS))


@kernel
def disc_depth(data: np.ndarray, table: float, x: float, y: float, time: float) -> float:
    """How deep a place is inside the nearest of some discs: distance to its rim, below 0 outside.

    The table holds from where below 0 radii grow, the number of discs, and x, y, radius, begin and
    end of each in turn. Minus infinity while there is none.
    """
    k = int(table)
    depth = -math.inf
    for disc in range(int(data[k + 1])):
        at = k + 2 + 5 * disc
        there = _part_there(time, data[at + 3], data[at + 4])
        radius = data[at + 2] - (1.0 - there) * (data[at + 2] + data[k])
        reach = radius - depth
        if there > 0.0 and reach > 0.0:
            dx, dy = x - data[at], y - data[at + 1]
            square = dx * dx + dy * dy
            if square < reach * reach:
                depth = radius - math.sqrt(square)
    return depth


@kernel
def disc_presence(data: np.ndarray, table: float, x: float, y: float, time: float) -> float:
    """How much of any disc is there, 0 to 1; the table as for `disc_depth`."""
    k = int(table)
    absent = 1.0
    for disc in range(int(data[k + 1])):
        at = k + 2 + 5 * disc
        absent *= 1.0 - _part_there(time, data[at + 3], data[at + 4])
        if absent == 0.0:
            break
    return 1.0 - absent
