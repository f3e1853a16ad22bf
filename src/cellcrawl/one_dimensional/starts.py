"""How two edges begin."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Final

from cellcrawl.errors import InputError, nearest_name
from cellcrawl.laws.law import PAPER, Law
from cellcrawl.laws.rest import CellAtRest, rest_state
from cellcrawl.one_dimensional.cell import still_tension
from cellcrawl.parameters import Parameters
from cellcrawl.validation import real_number, shown

_HIGHEST_TENSION = 1e6


@dataclass(frozen=True, kw_only=True)
class TwoEdges:
    """Bound fractions of front and rear and the tension at time 0; immutable.

    Parameters
    ----------
    front, rear : float
        Bound fractions, 0 to 1.
    tension : float, optional
        Membrane tension, up to a million; that of the still cell unless given.

    Raises
    ------
    InputError
        For values out of range.
    """

    front: float
    rear: float
    tension: float | None = None

    def __post_init__(self) -> None:
        for name in ("front", "rear"):
            object.__setattr__(self, name, real_number(name, getattr(self, name), 0.0, 1.0))
        if self.tension is not None:
            tension = real_number("tension", self.tension, -_HIGHEST_TENSION, _HIGHEST_TENSION)
            object.__setattr__(self, "tension", tension)


def _small(p: Parameters) -> TwoEdges:
    return TwoEdges(front=p.n_bar + 1e-3 * (1.0 - p.n_bar), rear=p.n_bar)


def _large(p: Parameters) -> TwoEdges:
    return TwoEdges(front=0.9, rear=0.02)


def _in_phase(p: Parameters) -> TwoEdges:
    return TwoEdges(front=0.8 * p.n_bar * (1.0 + 1e-6), rear=0.8 * p.n_bar)


STARTS: Final[dict[str, Callable[[Parameters], TwoEdges]]] = {
    "small": _small,
    "large": _large,
    "in_phase": _in_phase,
}
"""Named starts: the still cell with a front bound more by 1e-3 of what is free; a stuck front and a
slipping rear; both edges short of a fifth of their linkers, alike to a millionth."""


def start_of(parameters: Parameters, start: object, laws: Law = PAPER) -> TwoEdges:
    """Return the start that a name or a `TwoEdges` means, with its tension."""
    if isinstance(start, str) and start in STARTS:
        at_rest = CellAtRest.of(parameters, rest_state(parameters, laws, 0.0))
        start = STARTS[start](at_rest)
    if not isinstance(start, TwoEdges):
        hint = f" ({nearest_name(start, STARTS)})" if isinstance(start, str) else ""
        raise InputError(
            f"start = {shown(start)} is not known: it must be one of {', '.join(STARTS)} or "
            f"one_dimensional.TwoEdges(...){hint}"
        )
    tension = still_tension(parameters, laws) if start.tension is None else start.tension
    if laws.compiled is PAPER.compiled and parameters.sigma_c + tension < 0.0:
        raise InputError(
            f"tension = {tension:g} is below -sigma_c = {-parameters.sigma_c:g}: no off-rate "
            "r >= 1 balances the forces; give a higher tension"
        )
    return TwoEdges(front=start.front, rear=start.rear, tension=tension)
