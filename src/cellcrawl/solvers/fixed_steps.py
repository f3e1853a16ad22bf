"""Where the steps of a scheme with a fixed step fall: at multiples of it from an anchor."""

from __future__ import annotations

import math
import sys
from typing import Final

_ON_GRID: Final = 1e-9  # of a step
_ROUNDING: Final = 4.0 * sys.float_info.epsilon  # of the time, which is the larger after long


def slack(time: float, dt: float) -> float:
    """Return how far a time may be from a step's and be the same."""
    return max(_ON_GRID * dt, _ROUNDING * abs(time))


def steps_towards(target: float, end: float, anchor: float, taken: int, dt: float) -> int:
    """Steps from the ``taken``-th to the first at or after ``target``, before ``end``; at least 1.

    Steps are counted from ``anchor``; ``end`` is the next break, infinity if there is none.
    """
    needed = math.ceil((target - slack(target, dt) - anchor) / dt) - taken
    if math.isfinite(end):
        room = math.ceil((end - slack(end, dt) - anchor) / dt) - 1
        needed = min(needed, room - taken)
    return max(needed, 1)
