"""A field of the edge over arclength and time, from a material point or from the front."""

from __future__ import annotations

import numpy as np
import xarray as xr

from cellcrawl.arguments import checked
from cellcrawl.errors import InputError
from cellcrawl.observables.front import front_position
from cellcrawl.observables.inputs import edge_field, records_with
from cellcrawl.validation import one_of

ORIGINS = ("front", "material")


@checked
def kymograph(
    dataset: xr.Dataset, field: str = "bound_fraction", origin: str = "front"
) -> xr.DataArray:
    """Return a field of the edge over time and normalised arclength.

    Parameters
    ----------
    dataset : Dataset
        A run.
    field : str
        A field on the edge: "bound_fraction", "off_rate", "friction", "curvature", ...
    origin : {"front", "material"}
        "front": the front (see `front_position`) is in the middle, at arclength 0, and the
        coordinate runs counter-clockwise from -0.5 to 0.5: the cell's left is at positive, its
        right at negative arclength, and the rear is near both ends. Values between nodes come from
        a cubic through the four nearest.
        "material": node 0, which is a material point, is at 0 and the coordinate runs to 1; the
        values as they are stored.

    Returns
    -------
    DataArray, dims (time, arclength)
        ``arclength`` is s/L.

    Raises
    ------
    InputError
        For an unknown field or origin, or a dataset that is no run or has no records.

    Notes
    -----
    Only node 0 is a material point: the others keep equal spacing and slide along the edge, so
    even with ``origin="material"`` a material point elsewhere drifts in arclength. With
    ``origin="front"`` a cell that turns shows its pattern moving although it may be at rest on the
    substrate; before the cell moves the front is that of its ruffles and wanders. A cell that
    never moves has no front and is refused.
    """
    one_of("kymograph origin", origin, ORIGINS)
    values = records_with(dataset, edge_field(field))[field]
    nodes = dataset.sizes["node"]
    stored = np.asarray(values.values, dtype=float)
    arclength = np.arange(nodes) / nodes
    label = "arclength from node 0, s/L"
    if origin == "front":
        front = front_position(dataset).values
        if not np.isfinite(front).all():
            raise InputError('this cell never moves, so it has no front: use origin="material"')
        arclength = (np.arange(nodes) - nodes // 2) / nodes
        stored = _from(stored, front * nodes - nodes // 2, 2.0 * np.pi * (field == "theta"))
        label = "arclength from the front, s/L"
    along = xr.DataArray(arclength, dims="arclength", attrs={"long_name": label, "units": "1"})
    return xr.DataArray(
        stored,
        {"time": dataset["time"], "arclength": along},
        ("time", "arclength"),
        field,
        {**values.attrs, "origin": origin},
    )


def _from(values: np.ndarray, shift: np.ndarray, gain: float) -> np.ndarray:
    """Return ``values`` (time, node) read from ``shift`` (time,) nodes on; once round adds gain."""
    nodes = values.shape[1]
    whole = np.floor(shift).astype(int)
    u = (shift - whole)[:, None]
    index = np.arange(nodes) + whole[:, None]
    # Lagrange's cubic through the nodes at -1, 0, 1, 2: exact at u = 0.
    weights = (
        -u * (u - 1.0) * (u - 2.0) / 6.0,
        (u + 1.0) * (u - 1.0) * (u - 2.0) / 2.0,
        -(u + 1.0) * u * (u - 2.0) / 2.0,
        (u + 1.0) * u * (u - 1.0) / 6.0,
    )
    read = np.zeros_like(values)
    for offset, weight in zip((-1, 0, 1, 2), weights, strict=True):
        turns, node = np.divmod(index + offset, nodes)
        read += weight * (np.take_along_axis(values, node, axis=1) + gain * turns)
    return read
