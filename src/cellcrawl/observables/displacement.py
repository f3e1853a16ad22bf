"""How far a cell gets in a time: its mean squared displacement."""

from __future__ import annotations

from typing import Any

import numpy as np
import xarray as xr

from cellcrawl.arguments import checked
from cellcrawl.errors import InputError
from cellcrawl.observables.track import Track, as_track
from cellcrawl.validation import real_number

_EVEN = 1e-6  # of the interval: times that differ by no more from even ones are even


@checked
def mean_squared_displacement(
    run: Any, x: Any = None, y: Any = None, *, longest: float | None = None
) -> xr.DataArray:
    """Return the mean squared displacement against the time lag, over overlapping windows.

    Parameters
    ----------
    run : Dataset or array_like, shape (record,)
        A run, or the times of a track.
    x, y : array_like, shape (record,), optional
        Positions at these times; left out with a run.
    longest : float, optional
        Longest lag; a quarter of the duration unless given.

    Returns
    -------
    DataArray, dims (lag,)
        With coordinates ``lag``, ``windows`` (how many pairs of records were averaged) and
        ``relative_error`` (the standard deviation of the value over the value that Brownian motion
        would give: Qian, Sheetz & Elson, Biophys. J. 60, 910, 1991).

    Raises
    ------
    InputError
        For a dataset that is no run, a bad track, or a ``longest`` shorter than the interval or
        longer than the track.

    Notes
    -----
    Windows overlap, so neighbouring values share most of their data: the curve looks far smoother
    than it is known, and a bend at long lags may mean nothing. The error falls with the number of
    *independent* windows, duration over lag, not with ``windows``; at a quarter of the duration it
    is about 45 percent for Brownian motion, which is why longer lags are left out.
    Localisation error ``s`` along each axis adds ``4 s**2`` at every lag and hides slow motion at
    short ones. At uneven times pairs are sorted into bins one median interval wide and the lag is
    their mean; no position is interpolated.
    """
    track = as_track(run, x, y, at_least=3)
    intervals = np.diff(track.t)
    interval = float(np.median(intervals))
    limit = max(interval, 0.25 * track.duration)
    if longest is not None:
        limit = real_number("longest", longest, 0.0, track.duration * (1.0 + 1e-9), open_low=True)
        if limit < interval * (1.0 - 1e-9):
            raise InputError(
                f"longest = {longest:g} is below the interval between records, {interval:g}"
            )
    even = bool(np.ptp(intervals) <= _EVEN * interval)
    lags, squares, windows = (_even_lags if even else _uneven_lags)(track, interval, limit)
    number = np.maximum(1, np.round(lags / interval).astype(int))
    return xr.DataArray(
        squares,
        {
            "lag": ("lag", lags, {"long_name": "time lag", "units": track.time_units}),
            "windows": ("lag", windows, {"long_name": "pairs of records"}),
            "relative_error": (
                "lag",
                _brownian_error(number, track.t.size - 1),
                {"long_name": "relative error if the motion were Brownian", "units": "1"},
            ),
        },
        ("lag",),
        "mean_squared_displacement",
        {
            "long_name": "mean squared displacement",
            "units": f"{track.length_units}^2" if track.length_units else "",
        },
    )


def _even_lags(
    track: Track, interval: float, longest: float
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    number = np.arange(1, min(track.t.size - 1, int(longest / interval + 1e-6)) + 1)
    squares = np.array(
        [
            np.mean((track.x[k:] - track.x[:-k]) ** 2 + (track.y[k:] - track.y[:-k]) ** 2)
            for k in number.tolist()
        ]
    )
    return number * interval, squares, track.t.size - number


def _uneven_lags(
    track: Track, interval: float, longest: float
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    bins = int(longest / interval + 0.5) + 1
    counts, times, squares = np.zeros(bins), np.zeros(bins), np.zeros(bins)
    for k in range(1, track.t.size):
        apart = track.t[k:] - track.t[:-k]
        if apart.min() > longest + 0.5 * interval:
            break
        square = (track.x[k:] - track.x[:-k]) ** 2 + (track.y[k:] - track.y[:-k]) ** 2
        place = np.round(apart / interval).astype(int)
        inside = (place > 0) & (place < bins)
        place = place[inside]
        counts += np.bincount(place, minlength=bins)
        times += np.bincount(place, apart[inside], bins)
        squares += np.bincount(place, square[inside], bins)
    found = counts > 0
    return (
        times[found] / counts[found],
        squares[found] / counts[found],
        counts[found].astype(int),
    )


def _brownian_error(n: np.ndarray, steps: int) -> np.ndarray:
    """Return the relative error of lags of ``n`` steps, in the plane (Qian et al., 1991)."""
    k = np.maximum(steps - n + 1, 1).astype(float)
    n = n.astype(float)
    few = 1.0 + (k**3 - 4.0 * n * k**2 + 4.0 * n - k) / (6.0 * n**2 * k)
    many = (4.0 * n**2 * k + 2.0 * k + n - n**3) / (6.0 * n * k**2)
    error: np.ndarray = np.sqrt(np.where(n > k, few, many))
    return error
