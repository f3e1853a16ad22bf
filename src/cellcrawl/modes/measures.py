"""What the rule on turns looks at, measured on the heading after the transient."""

from __future__ import annotations

import math

import numpy as np

from cellcrawl.modes.result import Measures
from cellcrawl.observables.short_arrays import (
    mean,
    median,
    peak_to_peak,
    row_means,
    standard_deviation,
)
from cellcrawl.observables.smoothing import SmoothTrack
from cellcrawl.observables.track import Track
from cellcrawl.observables.turns import Swings, crossing_times, swings_of

SMALLEST_SWING = math.radians(20.0)
"""Swings of the heading smaller than this are not turns."""
_NOISE_RANGE = 6.0  # peak to peak of a heading that only has noise, over its standard deviation
_FIRST_MOVES = 0.25  # of the time: a cell may come to rest, or move into place, meanwhile
_ENOUGH = 30  # records for order to be seen in; of fewer the first quarter counts too
_ROUNDING = 1e-9
_ONSET = 0.5  # the cell has begun to crawl at this fraction of its later median speed


def onset(track: SmoothTrack) -> int:
    """Return the first record at which the cell crawls at half its later median speed."""
    later = median(track.speed[track.speed.size // 2 :])
    return max(int(np.argmax(track.speed >= _ONSET * later)), track.unsure)


def measure_rest(track: Track, noise: float) -> Measures:
    """Measure whether a cell moves at all, after the first quarter of the time.

    Of a short track all records count for the order of its positions.
    """
    after = int(np.searchsorted(track.t, track.t[0] + _FIRST_MOVES * track.duration))
    places = np.array([track.x, track.y])
    settled = after if track.t.size - after >= _ENOUGH else 0
    around = places[:, settled:] - row_means(places[:, settled:])
    whole, extent = _extent(places), _extent(places[:, after:])
    # Positions far from the origin carry their rounding.
    moves = extent > _ROUNDING * float(np.abs(places).max())
    steps = around[:, 1:] - around[:, :-1]
    return Measures(
        start=float(track.t[0]),
        speed=0.0,
        extent=extent,
        late_extent=extent / whole if moves else 0.0,
        disorder=float(np.mean(steps**2) / np.mean(around**2)) if moves else 2.0,
        noise=noise,
    )


def _extent(places: np.ndarray) -> float:
    """Return the largest distance of positions (2, record) from their mean, twice."""
    around = places - row_means(places)
    return 2.0 * math.sqrt(float((around[0] ** 2 + around[1] ** 2).max()))


def measure(track: SmoothTrack, first: int) -> Measures:
    """Measure turns from record ``first`` on, up to where the end makes the heading unsure."""
    used = slice(first, track.t.size - track.unsure)
    times, heading, x, y = (part[used] for part in (track.t, track.heading, track.x, track.y))
    smallest = max(SMALLEST_SWING, _NOISE_RANGE * min(track.heading_error, 1.0))
    swings = swings_of(heading, smallest)
    inner = _complete(swings)
    sizes = np.abs(inner.angle)
    crossings = crossing_times(times, heading, inner)
    intervals = crossings[1:] - crossings[:-1]
    left, right = (_mean(sizes[inner.angle * sign > 0.0]) for sign in (1.0, -1.0))
    turned = float(heading[-1] - heading[0])
    against = np.abs(swings.angle[swings.angle * turned < 0.0])
    wander = _wander(times, heading)
    path = float(np.add.reduce(np.hypot(x[1:] - x[:-1], y[1:] - y[:-1])))
    net = math.hypot(x[-1] - x[0], y[-1] - y[0])
    return Measures(
        start=float(times[0]),
        turned=turned,
        swings=int(swings.angle.size),
        swing=_mean(sizes),
        widest_swing=max(left, right),
        one_sidedness=abs(left - right) / (left + right) if left + right > 0.0 else 0.0,
        counter_turn=float(against.max()) if against.size else 0.0,
        angle_spread=_spread(sizes),
        interval_spread=_spread(intervals),
        wander=wander,
        unevenness=wander / abs(turned) if turned else math.inf,
        turning_rate=turned / float(times[-1] - times[0]),
        circling_radius=path / abs(turned) if turned else math.inf,
        period=2.0 * _mean(intervals) if intervals.size else math.nan,
        speed=median(track.speed[used]),
        straightness=net / path if path > 0.0 else 0.0,
        noise=track.noise,
        heading_error=track.heading_error,
    )


def _complete(swings: Swings) -> Swings:
    """Leave out the first and the last swing if the ends of the track cut them off: if smaller."""
    sizes = np.abs(swings.angle)
    if sizes.size < 4:
        return swings
    inner = sizes[1:-1].mean()
    return swings.part(slice(int(sizes[0] < inner), sizes.size - int(sizes[-1] < inner)))


def _mean(values: np.ndarray) -> float:
    return mean(values) if values.size else 0.0


def _spread(values: np.ndarray) -> float:
    if values.size < 2:
        return 0.0
    usual = mean(values)
    return standard_deviation(values) / usual if usual > 0.0 else math.inf


def _wander(times: np.ndarray, heading: np.ndarray) -> float:
    """Return the range of the heading around its least-squares line."""
    when = times - mean(times)
    slope = float(when @ heading) / float(when @ when)
    return peak_to_peak(heading - slope * when)
