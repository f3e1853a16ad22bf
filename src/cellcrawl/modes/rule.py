"""The rule on turns: the words of the paper made quantitative.

Each condition is a threshold on a measure with a width: it holds fully at the threshold plus the
width, not at all at the threshold minus the width, and half at the threshold. A mode fits as well
as its worst condition.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from cellcrawl.modes.result import Measures


class Condition(NamedTuple):
    """A threshold on a measure."""

    words: str
    fit: float


def stationary(found: Measures, cell_radius: float | None = None) -> list[Condition]:
    """Return the conditions of a cell at rest, of which any one is enough.

    Of two positions at rest, the mean square distance is twice the variance of one along each
    axis; a cell that moves comes far less far from one record to the next than in all.
    """
    conditions = [
        _above("its positions scatter without order", found.disorder, 1.0, 0.4),
        _below("it stopped where it came to", found.late_extent, 0.02, 0.01),
    ]
    if cell_radius is not None:
        moved = found.extent / cell_radius
        conditions.append(_below("it moves less than its size", moved, 0.05, 0.03))
    return conditions


def gliding(found: Measures) -> list[Condition]:
    """Return the conditions of "moves in a straight line with no turns"."""
    return [
        _below("the heading wanders", found.wander, _rad(30.0), _rad(12.0)),
        _below("it turns in all", abs(found.turned), _rad(60.0), _rad(30.0)),
    ]


def rotational(found: Measures, cell_radius: float | None = None) -> list[Condition]:
    """Return the conditions of "turns only towards one direction".

    Where the size of the cell is known, its centroid must go round a circle wider than the cell: a
    cell that spins within its own outline goes nowhere.
    """
    spins = []
    if cell_radius is not None:
        spins = [
            _above("it circles wider than itself", found.circling_radius / cell_radius, 1.0, 0.25)
        ]
    return [
        *spins,
        _above("it turns in all", abs(found.turned), _rad(60.0), _rad(30.0)),
        _below("it turns back", found.counter_turn, _rad(45.0), _rad(20.0)),
        _above("it turns throughout", found.evenness, 0.3, 0.25),
    ]


def zigzag(found: Measures) -> list[Condition]:
    """Return the conditions of "turns alternatively between left and right"."""
    return [
        _above("swings", found.swings, 3.0, 1.5),
        _above("size of a swing", found.swing, _rad(24.0), _rad(8.0)),
        _below("widest swing", found.widest_swing, math.pi, _rad(20.0)),
        _below("one-sidedness", found.one_sidedness, 0.4, 0.15),
        _below("swings differ in size", found.angle_spread, 0.4, 0.15),
        _below("swings differ in time", found.interval_spread, 0.4, 0.15),
    ]


def _above(words: str, value: float, threshold: float, width: float) -> Condition:
    fit = 0.5 + 0.5 * (value - threshold) / width
    return Condition(words, min(1.0, max(0.0, fit)))


def _below(words: str, value: float, threshold: float, width: float) -> Condition:
    return Condition(words, _above(words, -value, -threshold, width).fit)


_rad = math.radians
