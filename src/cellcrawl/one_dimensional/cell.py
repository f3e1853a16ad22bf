"""The one-dimensional cell: how its numbers follow from those of the two-dimensional one."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from cellcrawl.arguments import checked
from cellcrawl.errors import InputError
from cellcrawl.laws import as_law
from cellcrawl.laws.law import PAPER, Law
from cellcrawl.laws.rest import rest_state
from cellcrawl.parameters import Parameters
from cellcrawl.solvers.conditions import edge_column
from cellcrawl.validation import real_number, shown

_STIFFEST = 1e9


@dataclass(frozen=True, kw_only=True)
class Anchoring:
    """Springs that tie an edge to a cell body which gives way slowly; immutable.

    Not part of the model of Chen, Saintillan and Rangamani: an addition without which two edges
    cannot take turns (see the documentation page). An edge that has moved by ``u`` from where the
    body would have it is pulled back by ``stiffness * u``, beside the tension.

    Parameters
    ----------
    stiffness : float
        Pull for each unit of displacement, 0 (no springs) to 1e9; the tension of a cell without
        them has the stiffness `length_stiffness`.
    relaxation : float
        Rate at which the body follows a difference between the edges' springs: twice the stiffness
        over the drag of the body. 0 is a body that never moves.

    Raises
    ------
    InputError
        For values out of range.
    """

    stiffness: float = 0.0
    relaxation: float = 0.0

    def __post_init__(self) -> None:
        for name in ("stiffness", "relaxation"):
            value = real_number(name, getattr(self, name), 0.0, _STIFFEST)
            object.__setattr__(self, name, value)


FREE = Anchoring()


@checked
def length_stiffness(parameters: Parameters) -> float:
    """Return ``pi G``, the rate of the tension with the length of the cell.

    Each edge stands for half the perimeter of the round cell of radius 1, so that
    ``A_t = closed integral of U ds`` becomes ``pi`` times the rate of the length.
    """
    return math.pi * parameters.tension_rate


@checked
def still_tension(parameters: Parameters, laws: Any = PAPER) -> float:
    """Return the tension at which a straight edge stands still.

    Under the paper's laws ``r log r = v_p`` there.

    Parameters
    ----------
    parameters : Parameters
        The cell.
    laws : Law or str
        The law set; the paper's unless given.

    Raises
    ------
    InputError
        If no edge stands still under the law.
    """
    return rest_state(parameters, as_law(laws), 0.0).tension


def edge_of(parameters: Parameters, laws: Law, nodes: int) -> np.ndarray:
    """Return the local parameters at the nodes, shape (rows of the law, nodes)."""
    return np.repeat(edge_column(parameters, laws), nodes, axis=1)


def checked_cell(parameters: object, anchoring: object = FREE) -> None:
    """Raise `InputError` unless these are `Parameters` and `Anchoring`."""
    if not isinstance(parameters, Parameters):
        raise InputError(f"parameters must be cellcrawl.Parameters, not {shown(parameters)}")
    if not isinstance(anchoring, Anchoring):
        raise InputError(f"anchoring must be one_dimensional.Anchoring, not {shown(anchoring)}")
