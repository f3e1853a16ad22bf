"""How the centroid moves: velocity, speed, heading, turning rate."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import xarray as xr

from cellcrawl.arguments import checked
from cellcrawl.data.units import units_of
from cellcrawl.observables.inputs import records_with
from cellcrawl.observables.track import Track, as_track

AT_REST = 1e-6
"""A cell slower than this fraction of the run's highest speed has no heading."""
_ROUNDING = 1e-12


@checked
def centroid_velocity(run: Any, x: Any = None, y: Any = None) -> xr.DataArray:
    """Return the velocity of the centroid.

    Of outlines (`edge_series`) and of a track: differences in time, central where there are
    neighbours. Of a run: that of the area centroid, from the edge of each record alone,
    ``dc/dt = (1/A) * integral of (x - c) U ds`` with the outward normal velocity ``U``: exact, no
    difference in time is taken.

    Parameters
    ----------
    run : Dataset or array_like, shape (record,)
        A run, or the times of a track.
    x, y : array_like, shape (record,), optional
        Positions at these times; left out with a run.

    Returns
    -------
    DataArray, dims (time, component)
        Components "x" and "y"; of a run in R_0 k_off0, or in SI if the run is.

    Raises
    ------
    InputError
        If the dataset is no run or has no records, or the track is bad.

    Notes
    -----
    It is the velocity of the shape. Membrane or cortex may slide along the edge unseen. At the
    start of a run the centroid moves because the edge ruffles, long before the cell crawls. On a
    track, localisation error over the interval adds to every velocity, and sharp turns are rounded.
    """
    if x is not None or not isinstance(run, xr.Dataset):
        return _velocity_of_track(as_track(run, x, y))
    if run.attrs.get("kind") == "outlines":
        return _velocity_of_track(as_track(run))
    records_with(run, "x", "y", "normal_velocity", "area", "length", "centroid_x", "centroid_y")
    outward = run["normal_velocity"].values
    per_area = (run["length"] / run["area"]).values
    velocity = np.stack(
        [
            np.mean((run[axis] - run[f"centroid_{axis}"]).values * outward, axis=1) * per_area
            for axis in ("x", "y")
        ],
        axis=1,
    )
    return xr.DataArray(
        velocity,
        {"time": run["time"], "component": ["x", "y"]},
        ("time", "component"),
        "centroid_velocity",
        {"long_name": "velocity of the centroid", "units": units_of(run).label("velocity")},
    )


@checked
def speed(run: Any, x: Any = None, y: Any = None) -> xr.DataArray:
    """Return the speed of the area centroid.

    Parameters
    ----------
    run : Dataset or array_like, shape (record,)
        A run, or the times of a track.
    x, y : array_like, shape (record,), optional
        Positions at these times; left out with a run.

    Returns
    -------
    DataArray, dims (time,)
        Of a run in R_0 k_off0, or in SI if the run is.

    Raises
    ------
    InputError
        If the dataset is no run or has no records, or the track is bad.

    Notes
    -----
    The instantaneous speed. Net displacement over time is smaller for every cell that turns, and
    speeds from microscopy, taken over long frame intervals, lie in between.
    """
    velocity = centroid_velocity(run, x, y)
    attributes = {"long_name": "speed of the centroid", "units": velocity.attrs["units"]}
    return xr.DataArray(
        _size(velocity.values), {"time": velocity["time"]}, ("time",), "speed", attributes
    )


@checked
def heading(run: Any, x: Any = None, y: Any = None) -> xr.DataArray:
    """Return the direction in which the centroid moves, as a continuous angle.

    Parameters
    ----------
    run : Dataset or array_like, shape (record,)
        A run, or the times of a track.
    x, y : array_like, shape (record,), optional
        Positions at these times; left out with a run.

    Returns
    -------
    DataArray, dims (time,)
        Angle from the x axis, counter-clockwise, in rad; unwrapped, so a full turn adds 2 pi. NaN
        where the cell is at rest (slower than 1e-6 of its highest speed).

    Raises
    ------
    InputError
        If the dataset is no run or has no records, or the track is bad.

    Notes
    -----
    Unwrapping takes the shorter way round between records: save often enough that a cell turns
    less than pi from one to the next. While a cell is nearly at rest the heading is that of its
    ruffles, and it jumps by pi when a cell stops and backs up. It is the direction of motion, not
    the axis of the shape.
    """
    measured = centroid_velocity(run, x, y)
    velocity = measured.values
    moving = _is_moving(_size(velocity), _rounding(run))
    angle = np.full(moving.shape, np.nan)
    angle[moving] = np.unwrap(np.arctan2(velocity[moving, 1], velocity[moving, 0]))
    attributes = {"long_name": "heading of the centroid", "units": "rad"}
    return xr.DataArray(angle, {"time": measured["time"]}, ("time",), "heading", attributes)


@checked
def turning_rate(run: Any, x: Any = None, y: Any = None) -> xr.DataArray:
    """Return how fast the heading turns, positive counter-clockwise (to the left).

    Parameters
    ----------
    run : Dataset or array_like, shape (record,)
        A run of two records or more, or the times of a track.
    x, y : array_like, shape (record,), optional
        Positions at these times; left out with a run.

    Returns
    -------
    DataArray, dims (time,)
        Of a run in rad k_off0, or in SI if the run is; central differences in time, one-sided at
        the ends. NaN next to records without a heading.

    Raises
    ------
    InputError
        If the dataset is no run or has fewer than two records, or the track is bad.

    Notes
    -----
    Turns shorter than two records are smoothed away. While the cell is slow the rate is large and
    means little: weigh it by the speed, or leave the transient out.
    """
    if isinstance(run, xr.Dataset):
        records_with(run, at_least=2)
    angle = heading(run, x, y)
    rate = np.gradient(angle.values, angle["time"].values)
    units = units_of(run).label("angular_velocity") if isinstance(run, xr.Dataset) else ""
    return (
        angle.copy(data=rate)
        .rename("turning_rate")
        .assign_attrs(long_name="turning rate of the centroid", units=units)
    )


def _velocity_of_track(track: Track) -> xr.DataArray:
    velocity = np.stack([np.gradient(values, track.t) for values in (track.x, track.y)], axis=1)
    return xr.DataArray(
        velocity,
        {"time": track.t, "component": ["x", "y"]},
        ("time", "component"),
        "centroid_velocity",
        {"long_name": "velocity of the centroid", "units": _over(track)},
    )


def _over(track: Track) -> str:
    both = track.length_units and track.time_units
    return f"{track.length_units}/{track.time_units}" if both else ""


def _size(velocity: np.ndarray) -> np.ndarray:
    """Length of vectors, shape (time, 2)."""
    size: np.ndarray = np.hypot(velocity[:, 0], velocity[:, 1])
    return size


def _rounding(run: Any) -> float:
    """Return the speed below which a run's velocity is rounding, in the units of the run."""
    if not isinstance(run, xr.Dataset):
        return _ROUNDING
    one = units_of(run).one("velocity")
    return _ROUNDING * one if math.isfinite(one) else 0.0


def _is_moving(speeds: np.ndarray, rounding: float) -> np.ndarray:
    """Whether each speed, shape (time,), is enough to have a direction."""
    moving: np.ndarray = speeds > max(AT_REST * float(np.max(speeds)), rounding)
    return moving
