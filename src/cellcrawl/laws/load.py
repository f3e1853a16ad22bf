"""Polymerisation that a load slows down and stops."""

from __future__ import annotations

from typing import Any, ClassVar

from cellcrawl.laws.expressions import maximum
from cellcrawl.laws.law import Law, Parameter


class PolymerizationUnderLoad(Law):
    """``v_p [1 - (P / stall)^steepness]`` under the load ``P`` of the membrane and of walls.

    At ``P = stall`` polymerisation stops; the edge still retracts. A very large ``stall`` is the
    paper's law.
    """

    source: ClassVar[str] = "Keren et al., Nature 453, 475 (2008), for the force-velocity relation"
    stall = Parameter(1e300, 1.0, 1e300, "load on a unit length at which polymerisation stops")
    steepness = Parameter(1.0, 0.1, 1000.0, "exponent of the force-velocity relation")

    def polymerization(self, sigma: Any, kappa: Any, p: Any) -> Any:
        load = maximum(self.membrane(sigma, kappa, p) + p.pressure, 0.0)
        return p.v_p * (1.0 - (load / self.stall) ** self.steepness)
