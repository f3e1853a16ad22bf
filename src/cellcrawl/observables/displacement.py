"""How far a cell gets in a time: its mean squared displacement."""

from __future__ import annotations

from typing import Any

import numpy as np
import xarray as xr

from cellcrawl.arguments import checked
from cellcrawl.errors import InputError
from cellcrawl.observables.track import Track, as_track
from cellcrawl.validation import real_number

_ON_GRID = 0.02  # of the interval: times no farther from its multiples are frames, some dropped
_FINEST = 24  # frames in the shortest step between records; beyond that times are uneven
_MOST_FRAMES = 20  # per record
_LEAST_POWER = 0.1  # flatter or falling curves have no power law within a bin


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
    short ones. Dropped frames change nothing: each lag is a number of frames, all pairs of records
    so far apart count, and lags that never occur are left out. At truly uneven times pairs are
    sorted into bins one median interval wide; the lag of a bin is the power mean of the lags in it,
    for the power with which the curve grows there, so that a power law comes out as it is. No
    position is interpolated.
    """
    track = as_track(run, x, y, at_least=3)
    frames, interval = _frames(track.t)
    if frames is None:
        interval = float(np.median(np.diff(track.t)))
    limit = max(interval, 0.25 * track.duration)
    if longest is not None:
        limit = real_number("longest", longest, 0.0, track.duration * (1.0 + 1e-9), open_low=True)
        if limit < interval * (1.0 - 1e-9):
            raise InputError(
                f"longest = {longest:g} is below the interval between records, {interval:g}"
            )
    if frames is None:
        lags, squares, windows = _uneven_lags(track, interval, limit)
    else:
        lags, squares, windows = _frame_lags(track, frames, interval, limit)
    number = np.maximum(1, np.round(lags / interval).astype(int))
    return xr.DataArray(
        squares,
        {
            "lag": ("lag", lags, {"long_name": "time lag", "units": track.time_units}),
            "windows": ("lag", windows, {"long_name": "pairs of records"}),
            "relative_error": (
                "lag",
                _brownian_error(number, round(track.duration / interval)),
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


def _frames(times: np.ndarray) -> tuple[np.ndarray | None, float]:
    """Return the frame number of each record and the time between frames; None if uneven."""
    steps = np.diff(times)
    shortest = float(steps.min())
    tolerance = _ON_GRID * shortest
    interval = shortest
    for step in np.unique(np.round(steps / tolerance)) * tolerance:
        interval = _common(interval, float(step), 2.0 * tolerance)
        if interval * _FINEST < shortest:
            return None, 0.0
    for _ in range(2):
        number = np.round((times - times[0]) / interval)
        interval = float(times[-1] - times[0]) / float(number[-1])
    off = np.abs(times - times[0] - number * interval)
    if float(off.max()) > _ON_GRID * interval or number[-1] > _MOST_FRAMES * times.size:
        return None, 0.0
    return number.astype(int), interval


def _common(a: float, b: float, tolerance: float) -> float:
    """Return the greatest common divisor of two times, by Euclid's algorithm."""
    while b > tolerance:
        left = a % b
        a, b = b, left if left < b - tolerance else 0.0
    return a


def _frame_lags(
    track: Track, frames: np.ndarray, interval: float, longest: float
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Average over all pairs of records that are as many frames apart, lag by lag."""
    size = int(frames[-1]) + 1
    seen = np.zeros(size, dtype=bool)
    seen[frames] = True
    t, x, y = (np.zeros(size) for _ in range(3))
    t[frames], x[frames], y[frames] = track.t, track.x, track.y
    last = min(size - 1, int(longest / interval + 1e-6))
    rows = []
    for k in range(1, last + 1):
        both = seen[k:] & seen[:-k]
        pairs = int(np.count_nonzero(both))
        if pairs == 0:
            continue
        square = (x[k:] - x[:-k]) ** 2 + (y[k:] - y[:-k]) ** 2
        rows.append(
            (float((t[k:] - t[:-k]) @ both) / pairs, float(square @ both) / pairs, float(pairs))
        )
    lags, squares, windows = np.array(rows).reshape(-1, 3).T
    return lags, squares, windows.astype(int)


def _uneven_lags(
    track: Track, interval: float, longest: float
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    bins = int(longest / interval + 0.5) + 1
    found = []
    for k in range(1, track.t.size):
        apart = track.t[k:] - track.t[:-k]
        if apart.min() > longest + 0.5 * interval:
            break
        square = (track.x[k:] - track.x[:-k]) ** 2 + (track.y[k:] - track.y[:-k]) ** 2
        place = np.round(apart / interval).astype(int)
        inside = (place > 0) & (place < bins)
        found.append(np.stack([place[inside], apart[inside], square[inside]]))
    place, apart, square = np.concatenate(found, axis=1)
    place = place.astype(int)
    counts = np.bincount(place, minlength=bins)
    held = counts > 0
    counts = counts[held]
    squares = np.bincount(place, square, bins)[held] / counts
    lags = np.bincount(place, apart, bins)[held] / counts
    if lags.size > 1:
        power = np.full(bins, np.nan)
        with np.errstate(divide="ignore", invalid="ignore"):
            power[held] = np.gradient(np.log(squares), np.log(lags))
        power[~((power >= _LEAST_POWER) & (power <= 2.0))] = np.nan
        relative = apart / (place * interval)
        raised = _known(power[place])
        means = np.bincount(place, relative**raised, bins)[held] / counts
        lags = np.flatnonzero(held) * interval * means ** (1.0 / _known(power[held]))
    return lags, squares, counts


def _known(power: np.ndarray) -> np.ndarray:
    return np.where(np.isnan(power), 1.0, power)


def _brownian_error(n: np.ndarray, steps: int) -> np.ndarray:
    """Return the relative error of lags of ``n`` steps, in the plane (Qian et al., 1991)."""
    k = np.maximum(steps - n + 1, 1).astype(float)
    n = n.astype(float)
    few = 1.0 + (k**3 - 4.0 * n * k**2 + 4.0 * n - k) / (6.0 * n**2 * k)
    many = (4.0 * n**2 * k + 2.0 * k + n - n**3) / (6.0 * n * k**2)
    error: np.ndarray = np.sqrt(np.where(n > k, few, many))
    return error
