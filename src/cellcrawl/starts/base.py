"""What a start is: a rule that gives the first state of a cell."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Protocol, runtime_checkable

import numpy as np

from cellcrawl.arguments import checked
from cellcrawl.curve import Curve
from cellcrawl.errors import InputError
from cellcrawl.parameters import Parameters
from cellcrawl.validation import real_array, real_number


@checked
@dataclass(frozen=True, eq=False)
class CellState:
    """The state of a cell: everything the model needs to go on; immutable.

    Parameters
    ----------
    curve : Curve
        The edge.
    bound_fraction : array, shape (nodes,)
        Fraction of bound linkers at the nodes, 0 to 1.
    tension : float
        Membrane tension.

    Raises
    ------
    InputError
        For a bound fraction outside [0, 1] or values that are not finite.
    """

    curve: Curve
    bound_fraction: np.ndarray
    tension: float

    def __post_init__(self) -> None:
        bound = real_array("bound_fraction", self.bound_fraction, (self.curve.nodes,))
        outside = np.flatnonzero((bound < 0.0) | (bound > 1.0))
        if outside.size:
            raise InputError(
                f"bound_fraction is {bound[outside[0]]:.4g} at node {outside[0]}: "
                "it must be from 0 to 1"
            )
        bound.setflags(write=False)
        object.__setattr__(self, "bound_fraction", bound)
        tension = real_number("tension", self.tension, -1e12, 1e12)
        object.__setattr__(self, "tension", tension)


@runtime_checkable
class Start(Protocol):
    """A frozen description of the first state of a cell."""

    def state(self, parameters: Parameters, nodes: int) -> CellState:
        """Return the first state on ``nodes`` nodes."""
        ...

    def describe(self) -> dict[str, Any]:
        """Return what is needed to make this start again, as plain values for JSON."""
        ...
