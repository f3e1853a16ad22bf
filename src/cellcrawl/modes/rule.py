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


def stationary(found: Measures) -> list[Condition]:
    """Return the conditions of a cell at rest, of which any one is enough.

    Of positions without order, the mean square distance of successive ones is twice their variance;
    on a path they are much nearer to each other than that.
    """
    return [
        _above("its positions scatter without order", found.disorder, 1.3, 0.35),
        _below("it came to rest", found.late_extent, 0.02, 0.01),
    ]


def against_size(found: Measures, cell_radius: float) -> tuple[Condition, Condition]:
    """Return the conditions of a cell that stays in place, and of one that goes round a circle.

    The centroid of a rotating cell must go round a circle wider than the cell: one that spins
    within its own outline goes nowhere.
    """
    moved = found.extent / cell_radius
    circle = found.circling_radius / cell_radius
    return (
        _below("it moves by less than its size", moved, 0.05, 0.03),
        _above("it spins within its own outline", circle, 1.0, 0.25),
    )


def gliding(found: Measures) -> list[Condition]:
    """Return the conditions of "moves in a straight line with no turns"."""
    return [
        _below("its heading wanders", found.wander, _rad(30.0), _rad(12.0)),
        _below("it turns too far in all", abs(found.turned), _rad(60.0), _rad(30.0)),
    ]


def rotational(found: Measures) -> list[Condition]:
    """Return the conditions of "turns only towards one direction"."""
    return [
        _above("it turns too little in all", abs(found.turned), _rad(60.0), _rad(30.0)),
        _below("it turns back at times", found.counter_turn, _rad(45.0), _rad(20.0)),
        _below("it turns by fits and starts", found.unevenness, 0.4, 0.24),
    ]


def zigzag(found: Measures) -> list[Condition]:
    """Return the conditions of "turns alternatively between left and right".

    A swing of the heading by more than half a turn is no oscillation across a way ahead, but a
    loop.
    """
    return [
        _above("it swings too few times", found.swings, 3.0, 4.0),
        _above("its swings are too small", found.swing, _rad(24.0), _rad(8.0)),
        _below("its swings are loops", found.widest_swing, math.pi, _rad(20.0)),
        _below("it swings more to one side", found.one_sidedness, 0.4, 0.15),
        _below("its swings differ in size", found.angle_spread, 0.4, 0.25),
        _below("its swings differ in time", found.interval_spread, 0.4, 0.25),
    ]


def _above(words: str, value: float, threshold: float, width: float) -> Condition:
    fit = 0.5 + 0.5 * (value - threshold) / width
    return Condition(words, min(1.0, max(0.0, float(fit))))


def _below(words: str, value: float, threshold: float, width: float) -> Condition:
    return Condition(words, _above(words, -value, -threshold, width).fit)


_rad = math.radians
