"""Measures of the cell's shape."""

from __future__ import annotations

import numpy as np
import xarray as xr

from cellcrawl.arguments import checked
from cellcrawl.observables.inputs import records_with


@checked
def circularity(dataset: xr.Dataset) -> xr.DataArray:
    """Return ``4 pi A / L**2`` at each record: 1 for a circle, less for anything else.

    Parameters
    ----------
    dataset : Dataset
        A run.

    Returns
    -------
    DataArray, dims (time,)

    Raises
    ------
    InputError
        If the dataset is no run or has no records.

    Notes
    -----
    It says how far from round, not in which way: an ellipse of aspect ratio 2 and a cell with
    sharp rear corners can have the same value. The length of a rough edge grows with the number
    of nodes, and the circularity falls with it: compare cells at like resolution.
    """
    run = records_with(dataset, "area", "length")
    measured = 4.0 * np.pi * run["area"] / run["length"] ** 2
    return measured.rename("circularity").assign_attrs(long_name="circularity", units="1")


@checked
def aspect_ratio(dataset: xr.Dataset) -> xr.DataArray:
    """Return length over width of the ellipse with the same second moments of area.

    Parameters
    ----------
    dataset : Dataset
        A run.

    Returns
    -------
    DataArray, dims (time,)
        1 for a circle (and for a square), above 1 for anything longer than wide.

    Raises
    ------
    InputError
        If the dataset is no run or has no records.

    Notes
    -----
    Moments of the enclosed area about its centroid, as line integrals along the edge: a few
    filopodia or a rough edge hardly count. It does not say along what the cell is long: a
    keratocyte is longest across its way, a triangular cell may be so along it. An aspect ratio
    from the bounding box or from the calliper diameters is another number.
    """
    run = records_with(dataset, "x", "y", "theta", "length", "area", "centroid_x", "centroid_y")
    x, y = (run[axis].values - run[f"centroid_{axis}"].values[:, None] for axis in ("x", "y"))
    step = (run["length"] / run.sizes["node"]).values[:, None]
    along_x, along_y = np.cos(run["theta"].values) * step, np.sin(run["theta"].values) * step
    # Green's theorem: the integral over the area of x**2 is that of x**3/3 dy along the edge.
    xx = np.sum(x**3 * along_y, axis=1) / 3.0
    yy = -np.sum(y**3 * along_x, axis=1) / 3.0
    xy = np.sum(x**2 * y * along_y, axis=1) / 2.0
    middle, apart = 0.5 * (xx + yy), np.hypot(0.5 * (xx - yy), xy)
    return xr.DataArray(
        np.sqrt((middle + apart) / (middle - apart)),
        {"time": run["time"]},
        ("time",),
        "aspect_ratio",
        {"long_name": "aspect ratio", "units": "1"},
    )
