"""How a field differs between the halves of the edge: front and rear, left and right."""

from __future__ import annotations

import numpy as np
import xarray as xr

from cellcrawl.arguments import checked
from cellcrawl.observables.inputs import edge_field, records_with
from cellcrawl.observables.motion import heading


@checked
def front_rear_asymmetry(dataset: xr.Dataset, field: str = "bound_fraction") -> xr.DataArray:
    """Return how much more of a field the front half of the edge has than the rear half.

    ``(front - rear) / (front + rear)`` of the means over arclength; the line through the centroid
    across the direction of motion divides the halves.

    Parameters
    ----------
    dataset : Dataset
        A run.
    field : str
        A field on the edge; the bound fraction unless given.

    Returns
    -------
    DataArray, dims (time,)
        From -1 to 1 for a field that is not negative. NaN where the cell is at rest.

    Raises
    ------
    InputError
        For an unknown field, or a dataset that is no run or has no records.

    Notes
    -----
    Halves of the edge, not of the area. Front is where the cell moves to, so a cell that turns has
    its "front" lag behind or run ahead of its shape; while the cell is nearly at rest the direction
    is that of its ruffles. Each half is known to within one node.
    """
    return _asymmetry(dataset, field, 0.0, "front-rear", "front_rear_asymmetry")


@checked
def left_right_asymmetry(dataset: xr.Dataset, field: str = "bound_fraction") -> xr.DataArray:
    """Return how much more of a field the left half of the edge has than the right half.

    ``(left - right) / (left + right)`` of the means over arclength; the line through the centroid
    along the direction of motion divides the halves.

    Parameters
    ----------
    dataset : Dataset
        A run.
    field : str
        A field on the edge; the bound fraction unless given.

    Returns
    -------
    DataArray, dims (time,)
        From -1 to 1 for a field that is not negative. NaN where the cell is at rest.

    Raises
    ------
    InputError
        For an unknown field, or a dataset that is no run or has no records.

    Notes
    -----
    As of `front_rear_asymmetry`. A cell turns towards the side with more bound linkers (paper,
    Fig. 5), but the direction of motion turns as well, so the two do not peak together.
    """
    return _asymmetry(dataset, field, 0.5 * np.pi, "left-right", "left_right_asymmetry")


def _asymmetry(
    dataset: xr.Dataset, field: str, angle: float, words: str, name: str
) -> xr.DataArray:
    run = records_with(dataset, edge_field(field), "x", "y", "centroid_x", "centroid_y")
    towards = heading(run).values + angle
    ahead = (run["x"] - run["centroid_x"]).values * np.cos(towards)[:, None] + (
        run["y"] - run["centroid_y"]
    ).values * np.sin(towards)[:, None]
    values = np.asarray(run[field].values, dtype=float)
    one = _mean_where(values, ahead > 0.0)
    other = _mean_where(values, ahead < 0.0)
    with np.errstate(invalid="ignore", divide="ignore"):
        asymmetry = (one - other) / (one + other)
    return xr.DataArray(
        np.where(np.isfinite(towards), asymmetry, np.nan),
        {"time": run["time"]},
        ("time",),
        name,
        {
            "long_name": f"{words} asymmetry of {run[field].attrs.get('long_name', field)}",
            "units": "1",
        },
    )


def _mean_where(values: np.ndarray, chosen: np.ndarray) -> np.ndarray:
    count = np.maximum(chosen.sum(axis=1), 1)
    mean: np.ndarray = np.where(chosen, values, 0.0).sum(axis=1) / count
    return mean
