"""Where the steps of a scheme with a fixed step fall: at multiples of it from an anchor."""

from __future__ import annotations

import math
from typing import Final

ON_GRID: Final = 1e-9  # a time this close to a step, in steps, is that step


def steps_towards(target: float, end: float, anchor: float, taken: int, dt: float) -> int:
    """Steps from the ``taken``-th to the first at or after ``target``, before ``end``; at least 1.

    Steps are counted from ``anchor``; ``end`` is the next break, infinity if there is none.
    """
    needed = math.ceil((target - anchor) / dt - ON_GRID) - taken
    if math.isfinite(end):
        room = math.ceil((end - anchor) / dt - ON_GRID) - 1
        needed = min(needed, room - taken)
    return max(needed, 1)
