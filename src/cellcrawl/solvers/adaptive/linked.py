"""Where the kernels of a law lie that the solver's others call: these compile once for all laws."""

from __future__ import annotations

from typing import Any, NamedTuple

from cellcrawl.laws.addresses import address
from cellcrawl.solvers.adaptive.frame import balance_frame
from cellcrawl.solvers.adaptive.newton import factor
from cellcrawl.solvers.adaptive.rates import rates, renew_rates


class Linked(NamedTuple):
    """Addresses by the kernels' names, in place of a law."""

    rates: int
    renew_rates: int
    factor: int
    balance_frame: int


def linked(laws: Any, around: Any, placed: Any) -> Linked:
    """Return them for a compiled law, and surroundings at work on the midpoints and on a frame."""
    return Linked(
        rates=address(rates, laws, around),
        renew_rates=address(renew_rates, laws, around),
        factor=address(factor, laws, around),
        balance_frame=address(balance_frame, laws, placed),
    )
