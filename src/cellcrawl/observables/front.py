"""Where on the edge the front of the cell is."""

from __future__ import annotations

import numpy as np
import xarray as xr

from cellcrawl.arguments import checked
from cellcrawl.observables.inputs import records_with
from cellcrawl.observables.motion import centroid_velocity, heading


@checked
def front_position(dataset: xr.Dataset) -> xr.DataArray:
    """Return where the ray from the centroid along its velocity leaves the cell.

    Parameters
    ----------
    dataset : Dataset
        A run.

    Returns
    -------
    DataArray, dims (time,)
        Arclength from node 0 over the length, in [0, 1). Of several crossings the farthest from
        the centroid counts. Records without a front (the cell is at rest, or the ray misses a
        cell bent around its centroid) take the last one before, or at the beginning of the run
        the first one after. NaN if the cell never moves.

    Raises
    ------
    InputError
        If the dataset is no run or has no records.

    Notes
    -----
    It follows the motion, not the shape: while a cell turns, the front leads or lags the broad
    protruding edge, and before the cell crawls it is where the ruffles carry the centroid.
    """
    run = records_with(dataset, "x", "y", "centroid_x", "centroid_y")
    velocity = centroid_velocity(run).values
    moving = np.isfinite(heading(run).values)
    arms = np.stack(
        [run[axis].values - run[f"centroid_{axis}"].values[:, None] for axis in ("x", "y")]
    )
    position = np.full(moving.shape, np.nan)
    position[moving] = _farthest_crossing(arms[:, moving], velocity[moving])
    attributes = {"long_name": "position of the front, s/L from node 0", "units": "1"}
    return xr.DataArray(
        _filled(position), {"time": run["time"]}, ("time",), "front_position", attributes
    )


def _farthest_crossing(arms: np.ndarray, velocity: np.ndarray) -> np.ndarray:
    """Return s/L where rays meet edges: ``arms`` (2, time, node) from centroids, rays (time, 2)."""
    unit = velocity / np.hypot(velocity[:, 0], velocity[:, 1])[:, None]
    along = arms[0] * unit[:, :1] + arms[1] * unit[:, 1:]
    across = arms[1] * unit[:, :1] - arms[0] * unit[:, 1:]
    next_along, next_across = np.roll(along, -1, axis=1), np.roll(across, -1, axis=1)
    crosses = (across < 0.0) != (next_across < 0.0)
    fraction = across / np.where(crosses, across - next_across, 1.0)
    distance = np.where(crosses, along + fraction * (next_along - along), -np.inf)
    node = np.argmax(distance, axis=1)
    rows = np.arange(node.size)
    position = (node + fraction[rows, node]) / arms.shape[2] % 1.0
    return np.where(distance[rows, node] > 0.0, position, np.nan)


def _filled(position: np.ndarray) -> np.ndarray:
    """Carry the last defined value on, and the first one back to the beginning."""
    defined = np.flatnonzero(np.isfinite(position))
    if defined.size == 0:
        return position
    last = np.searchsorted(defined, np.arange(position.size), side="right") - 1
    filled: np.ndarray = position[defined[np.maximum(last, 0)]]
    return filled
