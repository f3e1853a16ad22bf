"""Whether a run's shape keeps what the model keeps: the tension law, and a closed edge.

``sigma_t = G A_t`` holds for the area of the shape itself. Solvers advance the shape and the
tension each in its own way, and an error that nothing restores adds up over a long run, unseen in
any single record. So the law is integrated here, from the areas that a solver reports, and the
tension held against it.
"""

from __future__ import annotations

import math

import numpy as np

from cellcrawl.solvers import Breakdown, Instant
from cellcrawl.solvers.conditions import Conditions

KEY = "tension_law"  # of the law's own state in a checkpoint


class TensionLaw:
    """The tension that goes with the areas seen so far, and how far a shape is off it.

    Parameters
    ----------
    conditions : Conditions
        Of the run: ``G`` may jump and ramp.
    tolerance : float
        How far the tension may be from the law, over the larger of ``G A`` and the tension (with
        the paper's parameters: the relative error of the area), and how large the gap in the edge
        may be, over its length.

    Notes
    -----
    Exact while ``G`` is constant, and across its jumps if `check` is given an instant at each
    `next_look`. While ``G`` ramps, ``G dA`` is summed by trapezoids over the time between two
    checks, and the tolerance widened by the most that they can miss of a steady change.
    """

    time: float
    """Time of the last check, minus infinity before the first."""

    def __init__(self, conditions: Conditions, tolerance: float) -> None:
        self.conditions = conditions
        self._tolerance = tolerance
        self.time = -math.inf
        self._area = self._tension = self._slack = 0.0
        breaks = (-math.inf, *conditions.schedule.breaks)
        sides = {
            conditions.tension_rate(time, before=side) for time in breaks for side in (False, True)
        }
        self._constant_rate = sides.pop() if len(sides) == 1 else None

    def next_look(self, time: float) -> float:
        """Return the next time at which ``G`` may jump or a ramp of it begin or end."""
        changes = self._constant_rate is None
        return self.conditions.next_break(time) if changes else math.inf

    def check(self, seen: Instant) -> Breakdown | None:
        """Take in the cell at a time not before the last; return how it breaks the law, or None."""
        if self.time == -math.inf:
            self._tension = seen.tension
        elif seen.time > self.time:
            change = seen.area - self._area
            if self._constant_rate is not None:
                self._tension += self._constant_rate * change
            else:
                first, last = self._rate(self.time), self._rate(seen.time, before=True)
                self._tension += 0.5 * (first + last) * change
                self._slack += 0.5 * abs((last - first) * change)
        self.time, self._area = seen.time, seen.area
        scale = max(self._rate(seen.time) * seen.area, abs(seen.tension))
        miss = abs(seen.tension - self._tension)
        if not miss <= self._tolerance * scale + self._slack:
            return Breakdown(
                "inconsistent",
                seen.time,
                f"the shape has left the tension law at t = {seen.time:.6g}: its area goes with a "
                f"tension of {self._tension:.8g}, not {seen.tension:.8g}, an error of "
                f"{miss / scale:.1e} where {self._tolerance:.1e} is allowed; {_ADVICE}",
            )
        if not seen.closure_gap <= self._tolerance:
            return Breakdown(
                "inconsistent",
                seen.time,
                f"the edge has come open at t = {seen.time:.6g}: its ends are "
                f"{seen.closure_gap:.1e} of its length apart where {self._tolerance:.1e} is "
                f"allowed; {_ADVICE}",
            )
        return None

    def _rate(self, time: float, *, before: bool = False) -> float:
        """Return ``G``, which seldom changes and is asked for at every check."""
        if self._constant_rate is not None:
            return self._constant_rate
        return self.conditions.tension_rate(time, before=before)

    def checkpoint(self) -> np.ndarray:
        """Return the state from which `restore` goes on."""
        return np.array([self.time, self._area, self._tension, self._slack])

    def restore(self, state: np.ndarray) -> None:
        """Take up the state a `checkpoint` holds."""
        self.time, self._area, self._tension, self._slack = (float(value) for value in state)


_ADVICE = "use a smaller rtol or dt, or more nodes"
