"""A centroid track, from a run or from plain arrays: what microscopes and the model share."""

from __future__ import annotations

from typing import Any

import numpy as np
import xarray as xr

from cellcrawl.data.units import units_of
from cellcrawl.errors import InputError
from cellcrawl.microscopy.track import Track
from cellcrawl.observables.inputs import records_with
from cellcrawl.validation import real_array, without_masked

__all__ = ["Track", "as_track", "track_of_checked"]


def as_track(run: Any, x: Any = None, y: Any = None, *, at_least: int = 2) -> Track:
    """Return the centroid track of a run, or of plain arrays.

    Parameters
    ----------
    run : Dataset, Track or array_like, shape (record,)
        A run, or the times of a track; times must rise and need not be even.
    x, y : array_like, shape (record,), optional
        Positions at these times; left out with a run. Records that are masked in any of the three
        (NumPy masked arrays) are left out.
    at_least : int
        The fewest records that will do.

    Returns
    -------
    Track

    Raises
    ------
    InputError
        For a dataset that is no run, positions that are missing, not finite or not as many as
        the times, times that do not rise, or too few records.
    """
    if isinstance(run, (Track, xr.Dataset)):
        if x is not None or y is not None:
            raise InputError("give a run alone, or times with x and y")
        track = run if isinstance(run, Track) else _track_of(run, at_least)
    else:
        if x is None or y is None:
            raise InputError("a run is a Dataset; a track needs times, x and y, arrays of one size")
        run, x, y = without_masked(run, x, y)
        times = real_array("t", run, (None,))
        track = Track(times, _positions("x", x, times.size), _positions("y", y, times.size))
    if track.t.size < at_least:
        raise InputError(
            f"this track has {track.t.size} records in time: at least {at_least} needed"
        )
    _must_rise(track.t)
    return track


def _track_of(run: xr.Dataset, at_least: int) -> Track:
    records_with(run, "centroid_x", "centroid_y", at_least=at_least)
    return track_of_checked(run)


def track_of_checked(run: xr.Dataset) -> Track:
    """Return the centroid track of a run whose time and centroid have been checked."""
    names = ("time", "centroid_x", "centroid_y")
    t, x, y = (np.array(run.variables[name].values, dtype=float) for name in names)
    units = units_of(run)
    return Track(t, x, y, length_units=units.label("length"), time_units=units.label("time"))


def _positions(name: str, values: Any, size: int) -> np.ndarray:
    positions = real_array(name, values, (None,))
    if positions.size != size:
        raise InputError(f"{name} has {positions.size} values and t has {size}: give as many")
    return positions


def _must_rise(times: np.ndarray) -> None:
    falls = np.flatnonzero(np.diff(times) <= 0.0)
    if falls.size:
        at = int(falls[0]) + 1
        raise InputError(
            f"t must rise: t[{at}] = {times[at]:g} follows {times[at - 1]:g}; "
            "sort the records and drop repeated times"
        )
