"""How long a cell keeps its direction."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
import xarray as xr

from cellcrawl.arguments import checked
from cellcrawl.observables.smoothing import smooth
from cellcrawl.observables.track import as_track
from cellcrawl.records import EqualWithNaN
from cellcrawl.validation import one_of

KINDS = ("direction", "velocity")
_FEWEST = 8
_FORGOTTEN = math.exp(-1.0)


@dataclass(frozen=True, eq=False)
class Persistence(EqualWithNaN):
    """How long a cell keeps its direction.

    Attributes
    ----------
    time : float
        Lag at which the correlation has fallen to 1/e; infinite if it never does.
    length : float
        Path the cell covers meanwhile, at its mean speed.
    speed : float
        Mean speed.
    """

    time: float
    length: float
    speed: float


@checked
def persistence(run: Any, x: Any = None, y: Any = None, *, kind: str = "direction") -> Persistence:
    """Return persistence time and length, from the correlation of the motion with itself later.

    Parameters
    ----------
    run : Dataset or array_like, shape (record,)
        A run, or the times of a track.
    x, y : array_like, shape (record,), optional
        Positions at these times; left out with a run.
    kind : {"direction", "velocity"}
        What is correlated; see `velocity_correlation`.

    Returns
    -------
    Persistence

    Raises
    ------
    InputError
        For a dataset that is no run, a track that is bad or has fewer than 8 records, or an
        unknown kind.

    Notes
    -----
    For a persistent random walk, whose correlation is ``exp(-lag/P)``, the time is ``P``. For
    motion that is not random it is something else: a cell on a circle "forgets" its direction after
    arccos(1/e) = 1.19 over its turning rate and takes it up again a turn later, and a zigzag whose
    swings are narrow never forgets. Look at the correlation itself. From one track of duration T
    the relative error is about sqrt(2 P / T), and P comes out too short when T is not much longer.
    """
    correlation = velocity_correlation(run, x, y, kind=kind)
    values, lags = correlation.values, correlation["lag"].values
    below = np.flatnonzero(values < _FORGOTTEN)
    time = math.inf
    if below.size:
        last = int(below[0])
        high, low = values[last - 1], values[last]
        share = (high - _FORGOTTEN) / (high - low)
        time = float(lags[last - 1] + share * (lags[last] - lags[last - 1]))
    speed = float(correlation.attrs["mean_speed"])
    return Persistence(time, time * speed if speed > 0.0 else 0.0, speed)


@checked
def velocity_correlation(
    run: Any, x: Any = None, y: Any = None, *, kind: str = "direction"
) -> xr.DataArray:
    """Return the correlation of the velocity, or of its direction, with itself a lag later.

    ``<u(t + lag) . u(t)>`` over all windows, which overlap: of unit vectors along the velocity
    ("direction") or of velocities over their mean square ("velocity"); 1 at lag 0.

    Parameters
    ----------
    run : Dataset or array_like, shape (record,)
        A run, or the times of a track.
    x, y : array_like, shape (record,), optional
        Positions at these times; left out with a run.
    kind : {"direction", "velocity"}
        What is correlated.

    Returns
    -------
    DataArray, dims (lag,)
        Lags up to half the duration; ``attrs["mean_speed"]`` is the mean speed.

    Raises
    ------
    InputError
        For a dataset that is no run, a track that is bad or has fewer than 8 records, or an
        unknown kind.

    Notes
    -----
    Localisation error makes successive displacements point against each other and would end the
    correlation at the first lag; so the track is smoothed first, as little as its noise asks for,
    and lags shorter than that smoothing say nothing. No mean velocity is taken off: a drift keeps
    the correlation from falling to 0. "direction" counts a pause as much as a dash; "velocity"
    counts fast stretches more. Uneven times are interpolated linearly.
    """
    one_of("kind", kind, KINDS)
    track = as_track(run, x, y, at_least=_FEWEST)
    smoothed = smooth(track)
    size = smoothed.t.size
    moves = np.stack([np.cos(smoothed.heading), np.sin(smoothed.heading)])
    if kind == "velocity":
        moves = moves * smoothed.speed
    even = np.linspace(smoothed.t[0], smoothed.t[-1], size)
    moves = np.stack([np.interp(even, smoothed.t, values) for values in moves])
    lags = size // 2
    spectrum = np.fft.rfft(moves, 2 * size, axis=1)
    products = np.fft.irfft(np.abs(spectrum) ** 2, 2 * size, axis=1)[:, :lags].sum(axis=0)
    products /= size - np.arange(lags)
    if products[0] > 0.0:
        products /= products[0]
    step = float(even[1] - even[0])
    return xr.DataArray(
        products,
        {
            "lag": (
                "lag",
                step * np.arange(lags),
                {"long_name": "time lag", "units": track.time_units},
            )
        },
        ("lag",),
        "velocity_correlation",
        {
            "long_name": f"correlation of {kind}",
            "units": "1",
            "mean_speed": float(smoothed.speed.mean()),
        },
    )
