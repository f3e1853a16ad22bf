"""Myosin that the flow of the network sweeps along."""

from __future__ import annotations

from typing import Any, ClassVar

from cellcrawl.laws.law import Law, Parameter


class SweptMyosin(Law):
    """Contraction that grows with the retrograde flow: ``sigma_c [1 + sweep (v_r / v_p - 1)]``.

    The faster the network flows back, the more motors it gathers. From ``sweep = v_p / sigma_c`` on
    the balance of forces has no unique root: such a value is refused.
    """

    source: ClassVar[str] = "after Barnhart et al., PNAS 112, 5045 (2015)"
    sweep = Parameter(0.0, 0.0, 100.0, "part of the contraction that goes with the flow")

    def contraction(self, phi: Any, r: Any, p: Any) -> Any:
        flow = self.retrograde_velocity(phi, r, p)
        return p.sigma_c * (1.0 + self.sweep * (flow / p.v_p - 1.0))

    def check(self, parameters: Any) -> str | None:
        limit = parameters.v_p / max(parameters.sigma_c, 1e-300)
        if self.sweep < limit:
            return None
        return (
            f"sweep = {self.sweep:g} must be below v_p / sigma_c = {limit:.4g}: from there on the "
            "balance of forces has no unique root"
        )
