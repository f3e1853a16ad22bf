"""Turns of a track: stretches over which the heading swings one way."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True, eq=False)
class Swings:
    """Swings of the heading, each to the other side than the one before.

    Attributes
    ----------
    start, end : ndarray of int, shape (swing,)
        Records between which the heading swings.
    angle : ndarray, shape (swing,)
        By how much, in rad, positive to the left.
    """

    start: np.ndarray
    end: np.ndarray
    angle: np.ndarray


def swings_of(heading: np.ndarray, smallest: float) -> Swings:
    """Split a heading into swings of at least ``smallest`` rad, one way and the other in turn.

    Backward movements smaller than that are part of the swing around them (turning points with
    hysteresis, as in rainflow counting).
    """
    places = _turning_points(heading, smallest)
    start, end = places[:-1], places[1:]
    return Swings(start, end, heading[end] - heading[start])


def _turning_points(heading: np.ndarray, smallest: float) -> np.ndarray:
    """Return the records of alternating extremes that differ by at least ``smallest``."""
    slope = np.sign(np.diff(heading))
    moving = np.flatnonzero(slope)
    if moving.size == 0:
        return np.zeros(0, dtype=int)
    changes = np.flatnonzero(np.diff(slope[moving])) + 1
    inner = moving[changes]
    candidates = np.concatenate([[0], inner, [heading.size - 1]])
    values = heading[candidates].tolist()
    points: list[int] = []
    low = high = direction = 0
    for i, value in enumerate(values):
        if value > values[high]:
            high = i
        if value < values[low]:
            low = i
        if direction >= 0 and values[high] - value >= smallest:
            points.append(high)
            direction, low = -1, i
        elif direction <= 0 and value - values[low] >= smallest:
            points.append(low)
            direction, high = 1, i
    if direction:
        points.append(high if direction > 0 else low)
    found: np.ndarray = candidates[np.asarray(points, dtype=int)]
    return found
