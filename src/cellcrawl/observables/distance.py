"""How far a track leads: straightness, and the mean distance from its start."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from cellcrawl.arguments import checked
from cellcrawl.errors import InputError
from cellcrawl.observables.track import Track, as_track
from cellcrawl.validation import real_number


@checked
def straightness(run: Any, x: Any = None, y: Any = None) -> float:
    """Return net distance over path length: 1 for a straight line, 0 for a closed path.

    Parameters
    ----------
    run : Dataset or array_like, shape (record,)
        A run, or the times of a track.
    x, y : array_like, shape (record,), optional
        Positions at these times; left out with a run.

    Returns
    -------
    float
        NaN for a cell that does not move at all.

    Raises
    ------
    InputError
        For a dataset that is no run, or a bad track.

    Notes
    -----
    It falls with the length of the track for everything but a straight line: compare tracks of
    one duration. Localisation error lengthens the path, the more the shorter the interval between
    records; long intervals cut corners and shorten it.
    """
    track = as_track(run, x, y)
    path = float(np.sum(np.hypot(np.diff(track.x), np.diff(track.y))))
    net = math.hypot(track.x[-1] - track.x[0], track.y[-1] - track.y[0])
    return net / path if path > 0.0 else math.nan


@checked
def mean_distance(run: Any, x: Any = None, y: Any = None, *, after: float | None = None) -> float:
    """Return x_c: the time mean of the distance from the first position.

    Parameters
    ----------
    run : Dataset or array_like, shape (record,)
        A run, or the times of a track.
    x, y : array_like, shape (record,), optional
        Positions at these times; left out with a run.
    after : float, optional
        Time from which on the mean is taken (5 in the paper's phase diagrams); the whole track
        unless given. The distance is from the first record all the same.

    Returns
    -------
    float
        In the units of the run or track: R_0 for a run without dimension.

    Raises
    ------
    InputError
        For a dataset that is no run, a bad track, or an ``after`` that leaves fewer than two
        records.

    Notes
    -----
    Section 8 of the model's page, Fig. 7C of the paper. The mean is over time (trapezium rule), so
    uneven records do not weigh in. It grows with the duration, linearly for a cell that glides:
    compare runs of one length only.
    """
    track = as_track(run, x, y)
    distance = np.hypot(track.x - track.x[0], track.y - track.y[0])
    chosen = slice(None)
    if after is not None:
        chosen = _records_after(track, after)
    times, distance = track.t[chosen], distance[chosen]
    return float(np.trapezoid(distance, times) / (times[-1] - times[0]))


def _records_after(track: Track, after: float) -> slice:
    """Return the records at and after a time, at least two, or raise `InputError`."""
    first = int(np.searchsorted(track.t, real_number("after", after, -math.inf, math.inf)))
    if track.t.size - first < 2:
        raise InputError(f"after = {after:g} leaves fewer than two records: take an earlier time")
    return slice(first, None)
