"""What a cell crawls in: patterns, stiffness, walls, forces and fields, in space and time.

Each changes local parameters where the edge is. Several may be given together; each sees what the
earlier have made of the parameters::

    around = [cc.surroundings.Stripes(period=2.0, between=0.0), cc.surroundings.UniformForce(x=0.1)]
    run = cc.simulate(cc.Parameters(r_on=26), surroundings=around)
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, Final

from cellcrawl.arguments import checked
from cellcrawl.errors import InputError
from cellcrawl.laws.law import described
from cellcrawl.surroundings.base import Place, Surrounding, Surroundings
from cellcrawl.surroundings.discs import Islands, LocalPulse, Pillars
from cellcrawl.surroundings.fields import (
    AlongEdge,
    ElectricField,
    Gradient,
    TensionGradient,
    UniformForce,
)
from cellcrawl.surroundings.patterns import Island, Pattern, Stripes
from cellcrawl.surroundings.walls import Channel, Walls
from cellcrawl.validation import one_of, shown

SHIPPED: Final[dict[str, type[Any]]] = {
    "stripes": Stripes,
    "island": Island,
    "pattern": Pattern,
    "gradient": Gradient,
    "force": UniformForce,
    "electric-field": ElectricField,
    "tension-gradient": TensionGradient,
    "along-edge": AlongEdge,
    "channel": Channel,
    "walls": Walls,
    "islands": Islands,
    "pillars": Pillars,
    "pulse": LocalPulse,
}
"""Surroundings by the names that tables of TOML files take."""

__all__ = [
    "SHIPPED",
    "AlongEdge",
    "Channel",
    "ElectricField",
    "Gradient",
    "Island",
    "Islands",
    "LocalPulse",
    "Pattern",
    "Pillars",
    "Place",
    "Stripes",
    "Surrounding",
    "Surroundings",
    "TensionGradient",
    "UniformForce",
    "Walls",
    "as_surroundings",
]


@checked
def as_surroundings(given: Any) -> Surroundings | None:
    """Return surroundings from themselves, one `Surrounding`, some, or None.

    Raises
    ------
    InputError
        For anything else.
    """
    if given is None or isinstance(given, Surroundings):
        return given if given is None or given.parts else None
    if isinstance(given, (Surrounding, Mapping, str)):
        given = [given]
    if isinstance(given, Sequence):
        return Surroundings([_part(part) for part in given]) if len(given) else None
    raise InputError(f"surroundings must be of cellcrawl.surroundings, not {shown(given)}")


def _part(given: Any) -> Any:
    if isinstance(given, str):
        one_of("surroundings", given, SHIPPED)
        return SHIPPED[given]()
    if isinstance(given, Mapping):
        kind = str(given.get("kind", ""))
        if kind in SHIPPED:
            values = {name: value for name, value in given.items() if name != "kind"}
            return SHIPPED[kind](**values)
        return described(given, Surrounding, "surrounding")
    return given
