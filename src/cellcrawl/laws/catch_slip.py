"""Bonds that hold longer under a moderate force, and slip under a strong one."""

from __future__ import annotations

from typing import Any, ClassVar

from cellcrawl.laws.expressions import exp
from cellcrawl.laws.law import Law, Parameter


class CatchSlip(Law):
    """Catch-slip bonds: ``r = catch exp(-catch_force phi) + slip exp(slip_force phi)``.

    With ``catch = 0``, ``slip = 1`` and ``slip_force = 1`` this is the paper's slip bond. Where the
    retrograde flow falls with the force on a bond, few linkers leave the balance of forces without
    a unique root; a run that comes there ends as "out_of_range". A resting cell whose bonds are in
    their catch range does not polarise.
    """

    source: ClassVar[str] = "Pereverzev et al., Biophys. J. 89, 1446 (2005)"
    catch = Parameter(0.0, 0.0, 1e6, "off-rate of the catch path at no force, over k_off0")
    catch_force = Parameter(0.8, 0.0, 100.0, "force scale of the slip bond over that of the catch")
    slip = Parameter(1.0, 0.0, 1e6, "off-rate of the slip path at no force, over k_off0")
    slip_force = Parameter(1.0, 0.0, 100.0, "force scale of the slip bond over that of this path")

    def off_rate(self, phi: Any, p: Any) -> Any:
        weakening = self.slip * exp(self.slip_force * phi)
        return self.catch * exp(-self.catch_force * phi) + weakening
