"""Fourier amplitudes of the edge about the resting circle."""

from __future__ import annotations

from typing import Any

import numpy as np
import xarray as xr

from cellcrawl.arguments import checked
from cellcrawl.errors import InputError
from cellcrawl.observables.inputs import EDGE_FIELDS, records_with
from cellcrawl.validation import one_of, real_array

_OF_THE_ANGLE = (*(name for name in EDGE_FIELDS if name not in ("x", "y", "theta")), "radius")


@checked
def fourier_amplitude(dataset: xr.Dataset, field: str, k: Any) -> xr.DataArray:
    """Return Fourier amplitudes of a field over the polar angle about the origin.

    ``f(phi) = f_0 + sum over k of Re(A_k exp(i k phi))``, so ``A_k = a_k - i b_k`` with the cosine
    and sine amplitudes of `PerturbedCircle`.

    Parameters
    ----------
    dataset : Dataset
        A run near the resting circle, where linear theory lives.
    field : str
        "radius", or a field on the edge.
    k : int or sequence of int
        Wavenumbers, 1 or more and below half the nodes.

    Returns
    -------
    DataArray of complex, dims (time, k)
        In the units of the field.

    Raises
    ------
    InputError
        For an unknown field, wavenumbers that are out of range, a cell that is no longer around the
        origin, or a dataset that is no run.

    Notes
    -----
    The origin is that of the run, not the centroid: a cell that has moved by ``d`` has an amplitude
    ``d`` of the radius at k = 1. Nodes carry the integral over the angle exactly for a circle, and
    the better the nearer the cell is to one.
    """
    field = one_of("field", field, _OF_THE_ANGLE)
    names = ["x", "y", "theta", "length"] + ([] if field == "radius" else [field])
    run = records_with(dataset, *names)
    wavenumbers = np.atleast_1d(real_array("k", k, None))
    if wavenumbers.ndim > 1 or not wavenumbers.size:
        raise InputError("k must be one whole number or a list of them")
    highest = run.sizes["node"] // 2
    if np.any(
        (wavenumbers != np.round(wavenumbers)) | (wavenumbers < 1) | (wavenumbers >= highest)
    ):
        raise InputError(f"k must be whole numbers from 1 to {highest - 1}")
    x, y, theta = (run[name].values for name in ("x", "y", "theta"))
    angle = np.unwrap(np.arctan2(y, x), axis=1)
    # d(phi)/ds = (x t_y - y t_x) / (x^2 + y^2); nodes are at equal steps of s
    turn = (x * np.sin(theta) - y * np.cos(theta)) / (x**2 + y**2)
    if np.any(turn <= 0.0):
        raise InputError(
            "the edge is no function of the angle about the origin: amplitudes are for cells that "
            "are still near the resting circle"
        )
    values = np.hypot(x, y) if field == "radius" else run[field].values
    weights = values * turn * (run["length"].values / (np.pi * run.sizes["node"]))[:, None]
    amplitudes = np.stack(
        [np.sum(weights * np.exp(-1j * wave * angle), axis=1) for wave in wavenumbers], axis=1
    )
    unit = (run["x"] if field == "radius" else run[field]).attrs.get("units", "")
    return xr.DataArray(
        amplitudes,
        {"time": run["time"], "k": wavenumbers.astype(int)},
        ("time", "k"),
        f"{field}_amplitude",
        {"long_name": f"Fourier amplitude of {field}", "units": unit},
    )
