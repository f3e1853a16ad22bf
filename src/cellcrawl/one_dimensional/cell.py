"""The one-dimensional cell: how its numbers follow from those of the two-dimensional one."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from cellcrawl._compile import kernel
from cellcrawl.arguments import checked
from cellcrawl.errors import InputError
from cellcrawl.laws.law import PAPER
from cellcrawl.parameters import Conditions, Parameters
from cellcrawl.physics.slip_bond import balance
from cellcrawl.solvers.base import pointwise
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
def still_tension(parameters: Parameters) -> float:
    """Return the tension at which a straight edge stands still, ``r log r = v_p``."""
    return parameters.sigma_bar * (1.0 + parameters.h)


@kernel
def _log_off_rates(velocity: np.ndarray, out: np.ndarray) -> None:
    for i in range(velocity.size):
        out[i] = balance(np.nan, 0.0, 0.0, velocity[i])


def off_rates_at(velocity: np.ndarray) -> np.ndarray:
    """Return the off-rates at which the retrograde velocity ``r log r`` has values from 0 on."""
    flat = np.ravel(np.asarray(velocity, float))
    y = np.empty(flat.size)
    _log_off_rates(flat, y)
    rates: np.ndarray = np.exp(y).reshape(np.shape(velocity))
    return rates


def velocity_and_friction(
    parameters: Parameters, off_rate: np.ndarray, bound_fraction: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Return the outward velocity and the friction of edges, arrays of any one shape."""
    edge = Conditions(parameters).edge(0.0, 1)[:, 0]
    y = np.log(off_rate)
    _, velocity, friction = pointwise(PAPER, y, bound_fraction, 0.0, 0.0, edge)
    return velocity, friction


def checked_cell(parameters: object, anchoring: object = FREE) -> None:
    """Raise `InputError` unless these are `Parameters` and `Anchoring`."""
    if not isinstance(parameters, Parameters):
        raise InputError(f"parameters must be cellcrawl.Parameters, not {shown(parameters)}")
    if not isinstance(anchoring, Anchoring):
        raise InputError(f"anchoring must be one_dimensional.Anchoring, not {shown(anchoring)}")
