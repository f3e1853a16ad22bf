"""A ground that gives way: bonds in series with springs of the substrate."""

from __future__ import annotations

from typing import Any, ClassVar

from cellcrawl.laws.law import Law, Parameter


class Stiffness(Law):
    """A soft ground: ``v_r = phi r / chi`` with ``chi = k_s / (k_b + k_s)``, 1 on a rigid ground.

    ``chi`` may differ from place to place: surroundings change it like any other parameter.
    """

    source: ClassVar[str] = (
        "Chan & Odde, Science 322, 1687 (2008), for bonds in series with springs"
    )
    chi = Parameter(1.0, 0.001, 1.0, "stiffness k_s / (k_b + k_s) of ground and bond in series")

    def retrograde_velocity(self, phi: Any, r: Any, p: Any) -> Any:
        return phi * r / self.chi

    def friction(self, phi: Any, r: Any, n: Any, p: Any) -> Any:
        return phi * (r / self.chi + p.zeta_1 * n)
