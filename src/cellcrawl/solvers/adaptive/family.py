"""What a family of steps is made of, so that a run compiles the one it uses."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

from cellcrawl.solvers.adaptive.drive import Rules
from cellcrawl.solvers.adaptive.scheme import Scheme


class Family(NamedTuple):
    """Explicit steps of one order, each with an error estimate; see `Rules` for the numbers.

    ``tolerance``: local error that leaves a global error of about ``rtol`` at t = 5 (measured).
    ``run``: compiled; many steps of this family, between `next_step` and `after_step`.
    """

    order: int
    power: float
    amplified: float
    tension_weight: float
    tolerance: Callable[[float], float]
    scheme: Callable[[], Scheme]
    run: Callable[..., int]

    def rules(self, rtol: float, allowed: float, fewest_nodes: int, most_nodes: int) -> Rules:
        """Return what the steps are held against at ``rtol``."""
        return Rules(
            tolerance=self.tolerance(rtol),
            order=self.order,
            power=self.power,
            amplified=self.amplified,
            tension_weight=self.tension_weight,
            allowed=allowed,
            fewest_nodes=fewest_nodes,
            most_nodes=most_nodes,
        )
