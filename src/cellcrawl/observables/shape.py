"""Measures of the cell's shape."""

from __future__ import annotations

import numpy as np
import xarray as xr

from cellcrawl.observables.inputs import records_with


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
