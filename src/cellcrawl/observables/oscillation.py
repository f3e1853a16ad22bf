"""Period and amplitude of what goes up and down: the tension, and the way from side to side."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
import xarray as xr

from cellcrawl.arguments import checked
from cellcrawl.observables.inputs import records_with
from cellcrawl.observables.smoothing import smooth
from cellcrawl.observables.track import Track, as_track
from cellcrawl.observables.turns import Swings, crossing_times, swings_of
from cellcrawl.records import EqualWithNaN
from cellcrawl.validation import real_array, real_number, without_masked

_TRANSIENT = 0.25  # part of the time left out at the beginning unless said otherwise
_HYSTERESIS = 0.3  # of the range: smaller ups and downs are ripples
_FEWEST = 8


@dataclass(frozen=True, eq=False)
class Oscillation(EqualWithNaN):
    """Period and amplitude of a signal that goes up and down.

    Attributes
    ----------
    period : float
        Mean time from one rise to the next and from one fall to the next; NaN with fewer than two
        of either.
    amplitude : float
        Half the mean difference between successive highs and lows; 0 without any.
    irregularity : float
        Standard deviation over mean of the periods; 0 for a clockwork, NaN with fewer than two.
    cycles : float
        How many periods the signal shows.
    """

    period: float
    amplitude: float
    irregularity: float
    cycles: float


@checked
def oscillation(t: Any, values: Any, *, after: float | None = None) -> Oscillation:
    """Return period and amplitude of a signal.

    Parameters
    ----------
    t, values : array_like, shape (record,)
        Times, which must rise, and the signal.
    after : float, optional
        Time from which on to look; the first quarter is left out unless given.

    Returns
    -------
    Oscillation

    Raises
    ------
    InputError
        For values that are not finite or not as many as the times, times that do not rise, or
        fewer than 8 records.

    Notes
    -----
    A straight trend is taken off. Ups and downs count if they exceed 0.3 of the range (between the
    5th and 95th percentiles), so that ripples on a slow wave do not; of two waves of like size the
    faster one is found. Any signal has ups and downs, noise too: trust the period only where the
    irregularity is well below 0.3 and there are several cycles.
    """
    t, values = without_masked(t, values)
    signal = as_track(
        t, values, np.zeros_like(real_array("values", values, (None,))), at_least=_FEWEST
    )
    first = int(np.searchsorted(signal.t, _start(signal, after)))
    times, series = signal.t[first:], signal.x[first:]
    if times.size < _FEWEST:
        return Oscillation(math.nan, 0.0, math.nan, 0.0)
    when = times - times.mean()
    series = series - series.mean() - when * float(when @ series) / float(when @ when)
    low, high = np.percentile(series, [5.0, 95.0])
    if high - low <= 1e-9 * float(np.abs(signal.x).max()):
        return Oscillation(math.nan, 0.0, math.nan, 0.0)
    swings = swings_of(series, _HYSTERESIS * float(high - low))
    whole = swings if swings.angle.size < 4 else swings.part(slice(1, -1))
    return _periods(times, series, whole)


@checked
def tension_oscillation(dataset: xr.Dataset, *, after: float | None = None) -> Oscillation:
    """Return period and amplitude of the membrane tension.

    Parameters
    ----------
    dataset : Dataset
        A run of at least 8 records.
    after : float, optional
        Time from which on to look; the first quarter is left out unless given.

    Returns
    -------
    Oscillation

    Raises
    ------
    InputError
        If the dataset is no run, or has too few records.

    Notes
    -----
    The tension rises at every turn, to whichever side: in a zigzag its period is half that of the
    way from left to right and back. See `oscillation` for what the method takes for a cycle.
    """
    run = records_with(dataset, "tension", at_least=_FEWEST)
    return oscillation(run["time"].values, run["tension"].values, after=after)


@checked
def lateral_oscillation(
    run: Any, x: Any = None, y: Any = None, *, after: float | None = None
) -> Oscillation:
    """Return period and amplitude of the motion from side to side, across the way ahead.

    Parameters
    ----------
    run : Dataset or array_like, shape (record,)
        A run, or the times of a track.
    x, y : array_like, shape (record,), optional
        Positions at these times; left out with a run.
    after : float, optional
        Time from which on to look; the first quarter is left out unless given.

    Returns
    -------
    Oscillation
        The amplitude is half the swing from left to right, a length.

    Raises
    ------
    InputError
        For a dataset that is no run, or a track that is bad or has fewer than 8 records.

    Notes
    -----
    The way ahead turns evenly in time, along the straight line through the heading, so that a
    zigzag on an arc is measured across the arc. For a cell that circles, or turns at random, there
    is no way ahead and the result means nothing: ask the classifier first.
    """
    track = as_track(run, x, y, at_least=_FEWEST)
    smoothed = smooth(track)
    first = int(np.searchsorted(smoothed.t, _start(track, after)))
    times, speed, heading = (
        part[first:] for part in (smoothed.t, smoothed.speed, smoothed.heading)
    )
    if times.size < _FEWEST:
        return Oscillation(math.nan, 0.0, math.nan, 0.0)
    when = times - times.mean()
    slope = float(when @ heading) / float(when @ when)
    across = speed * np.sin(heading - heading.mean() - slope * when)
    steps = 0.5 * (across[1:] + across[:-1]) * smoothed.step
    return oscillation(times, np.concatenate([[0.0], np.cumsum(steps)]), after=float(times[0]))


def _start(track: Track, after: float | None) -> float:
    if after is None:
        return float(track.t[0]) + _TRANSIENT * track.duration
    return real_number("after", after, -math.inf, math.inf)


def _periods(times: np.ndarray, series: np.ndarray, swings: Swings) -> Oscillation:
    """Measure the time between every second crossing: from rise to rise and from fall to fall."""
    crossings = crossing_times(times, series, swings)
    amplitude = 0.5 * float(np.abs(swings.angle).mean()) if swings.angle.size else 0.0
    periods = crossings[2:] - crossings[:-2]
    if periods.size == 0:
        return Oscillation(math.nan, amplitude, math.nan, 0.0)
    period = float(periods.mean())
    spread = float(periods.std(ddof=1)) / period if periods.size > 1 else math.nan
    return Oscillation(period, amplitude, spread, float(times[-1] - times[0]) / period)
