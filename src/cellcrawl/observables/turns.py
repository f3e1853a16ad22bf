"""Turns of a track: stretches over which the heading swings one way."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
import xarray as xr

from cellcrawl.arguments import checked
from cellcrawl.observables.smoothing import smooth
from cellcrawl.observables.track import as_track
from cellcrawl.validation import real_number

SMALLEST_TURN = math.radians(20.0)
"""Changes of heading smaller than this are no turns, unless said otherwise."""
_FEWEST = 8
_AT_REST = 0.05  # of the median of the higher speeds
_TURNING = 0.5  # a cell turns while it turns faster than this fraction of its root mean square


@checked
def turning_events(
    run: Any, x: Any = None, y: Any = None, *, smallest: float = SMALLEST_TURN
) -> xr.Dataset:
    """Return the turns of a track, one by one.

    A turn is a stretch in which the heading turns one way faster than half the root mean square of
    the turning rate, and by ``smallest`` or more in all.

    Parameters
    ----------
    run : Dataset or array_like, shape (record,)
        A run, or the times of a track.
    x, y : array_like, shape (record,), optional
        Positions at these times; left out with a run.
    smallest : float
        Smallest angle that counts, in rad; 20 degrees unless given.

    Returns
    -------
    Dataset, dims (turn,)
        ``time`` (when half the angle is turned), ``start``, ``end``, ``angle`` (rad, positive to
        the left) and ``sign`` (+1 left, -1 right). Without turns it has length 0.

    Raises
    ------
    InputError
        For a dataset that is no run, a track that is bad or has fewer than 8 records, or a
        ``smallest`` that is not above 0.

    Notes
    -----
    The yardstick is the track's own turning rate, so turns need not be sharp in any absolute sense;
    a cell on a circle makes one turn that lasts as long as the track. A cell that rests at the
    beginning or at the end (slower than a twentieth of its usual speed) has no
    heading then and makes no turn; while it begins to crawl its heading is that of its ruffles:
    leave the transient out. Noisy tracks are smoothed as little as
    their noise asks for, so that turns shorter than the smoothing are lost, and a reversal (the
    heading jumps by pi) counts as a turn to a side that chance decides.
    """
    real_number("smallest", smallest, 0.0, math.inf, open_low=True)
    track = as_track(run, x, y, at_least=_FEWEST)
    smoothed = smooth(track)
    crawls = _crawling(smoothed.speed)
    heading, times = smoothed.heading[crawls], smoothed.t[crawls]
    change = np.diff(heading)
    way = np.sign(change) * (np.abs(change) > _TURNING * math.sqrt(float(np.mean(change**2))))
    bounds = np.flatnonzero(np.diff(way)) + 1
    start = np.concatenate([[0], bounds])
    end = np.concatenate([bounds, [change.size]])
    turned = heading[end] - heading[start]
    kept = (way[start] != 0.0) & (np.abs(turned) >= smallest)
    start, end, turned = start[kept], end[kept], turned[kept]
    half = crossing_times(times, heading, Swings(start, end, turned))
    unit = {"units": track.time_units}
    return xr.Dataset(
        {
            "time": ("turn", half, {"long_name": "when half the angle is turned", **unit}),
            "start": ("turn", times[start], {"long_name": "start of the turn", **unit}),
            "end": ("turn", times[end], {"long_name": "end of the turn", **unit}),
            "angle": ("turn", turned, {"long_name": "angle, positive to the left", "units": "rad"}),
            "sign": ("turn", np.sign(turned).astype(int), {"long_name": "+1 left, -1 right"}),
        }
    )


def _crawling(speed: np.ndarray) -> slice:
    """Return the records between a rest at the beginning and one at the end."""
    fast = speed >= 0.5 * float(speed.max())
    moves = np.flatnonzero(speed >= _AT_REST * float(np.median(speed[fast])))
    if moves[-1] - moves[0] < 1:
        return slice(None)
    return slice(int(moves[0]), int(moves[-1]) + 1)


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

    def part(self, which: slice) -> Swings:
        """Return some of the swings."""
        return Swings(self.start[which], self.end[which], self.angle[which])


def swings_of(heading: np.ndarray, smallest: float) -> Swings:
    """Split a signal into swings of at least ``smallest``, one way and the other in turn.

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


def crossing_times(times: np.ndarray, heading: np.ndarray, swings: Swings) -> np.ndarray:
    """Return when the heading is halfway through each swing."""
    found = np.empty(swings.angle.size)
    for i, (start, end, angle) in enumerate(
        zip(swings.start.tolist(), swings.end.tolist(), swings.angle.tolist(), strict=True)
    ):
        part = (heading[start : end + 1] - heading[start]) / angle
        k = max(int(np.argmax(part >= 0.5)), 1)
        before, after = part[k - 1], part[k]
        share = (0.5 - before) / (after - before)
        found[i] = times[start + k - 1] + share * (times[start + k] - times[start + k - 1])
    return found
