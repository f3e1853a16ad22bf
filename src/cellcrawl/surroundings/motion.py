"""The velocity of the cell where its surroundings ask for it: two numbers to solve for.

What the edge does follows from the local parameters, these from the velocity ``V`` of the centroid,
and that from what the whole edge does: ``V = (1/A) * integral of (x - c) U ds``. The velocity is
found by Broyden's method from the last one; its matrix goes on from call to call.
"""

from __future__ import annotations

import math
from typing import Final

import numpy as np

from cellcrawl.numerics.kernels import kernel

# entries of `motion`: whether curvature and motion are asked for; velocity; its last change and
# what was amiss before that; the inverse matrix; centroid and area on the last edge; tries
BENDS, MOVES = 0, 1
VX, VY, STEP_X, STEP_Y, MISS_X, MISS_Y, INVERSE, CENTER_X, CENTER_Y, AREA, TRIES = (
    2, 3, 4, 5, 6, 7, 8, 12, 13, 14, 15,
)  # fmt: skip
MOTION: Final = 16
MOST_TRIES: Final = 40
_AGREED = 1e-12  # of the velocity, beside a speed of 0.01


def at_rest(bends: bool, moves: bool) -> np.ndarray:
    """Return the motion of a cell that does not move."""
    motion = np.zeros(MOTION)
    motion[BENDS], motion[MOVES] = bends, moves
    motion[INVERSE] = motion[INVERSE + 3] = -1.0
    return motion


@kernel
def improve(found_x: float, found_y: float, motion: np.ndarray) -> bool:
    """Take in the velocity that follows from the one in ``motion``; True once they agree."""
    miss_x, miss_y = found_x - motion[VX], found_y - motion[VY]
    if math.hypot(miss_x, miss_y) <= _AGREED * (0.01 + math.hypot(motion[VX], motion[VY])):
        motion[TRIES] = 0.0
        return True
    inverse = motion[INVERSE : INVERSE + 4]
    if motion[TRIES] > 0.0:
        _learn(miss_x - motion[MISS_X], miss_y - motion[MISS_Y], motion[STEP_X], motion[STEP_Y],
               inverse)  # fmt: skip
    motion[STEP_X] = -(inverse[0] * miss_x + inverse[1] * miss_y)
    motion[STEP_Y] = -(inverse[2] * miss_x + inverse[3] * miss_y)
    motion[MISS_X], motion[MISS_Y] = miss_x, miss_y
    motion[VX] += motion[STEP_X]
    motion[VY] += motion[STEP_Y]
    motion[TRIES] += 1.0
    return False


@kernel
def _learn(y_x: float, y_y: float, s_x: float, s_y: float, inverse: np.ndarray) -> None:
    """Broyden's change of the inverse matrix: the last step has made this difference."""
    by_x = inverse[0] * y_x + inverse[1] * y_y
    by_y = inverse[2] * y_x + inverse[3] * y_y
    row_x = s_x * inverse[0] + s_y * inverse[2]
    row_y = s_x * inverse[1] + s_y * inverse[3]
    divisor = s_x * by_x + s_y * by_y
    if abs(divisor) < 1e-3 * (s_x * s_x + s_y * s_y) or divisor == 0.0:
        return
    off_x, off_y = (s_x - by_x) / divisor, (s_y - by_y) / divisor
    inverse[0] += off_x * row_x
    inverse[1] += off_x * row_y
    inverse[2] += off_y * row_x
    inverse[3] += off_y * row_y
