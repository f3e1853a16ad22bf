"""What the observables ask of a Dataset, refused in one line where it is not kept."""

from __future__ import annotations

import xarray as xr

from cellcrawl.errors import InputError, nearest_name
from cellcrawl.simulation.dataset import FIELDS, TIME
from cellcrawl.simulation.units import units_of

EDGE_FIELDS = tuple(name for name, field in FIELDS.items() if "node" in field.dims)
"""The fields that live on the edge, one value a node."""


def records_with(dataset: xr.Dataset, *names: str, at_least: int = 1) -> xr.Dataset:
    """Return ``dataset`` if it has these variables and enough records, or raise `InputError`."""
    if not isinstance(dataset, xr.Dataset):
        raise InputError(f"a run is an xarray Dataset, not {type(dataset).__name__}")
    for name in ("time", *names):
        wanted = TIME.dims if name == "time" else FIELDS[name].dims
        if name not in dataset.variables:
            raise InputError(f"this dataset has no {name!r}: is it a cellcrawl run?")
        if dataset[name].dims != wanted:
            raise InputError(
                f"{name!r} has dimensions {dataset[name].dims}, not {wanted}: "
                "select single records as a list, .isel(time=[0])"
            )
    records = dataset.sizes["time"]
    if records < at_least:
        wanted_records = "1 record" if at_least == 1 else f"{at_least} records"
        raise InputError(
            f"this run has {records} records in time: at least {wanted_records} needed"
        )
    units_of(dataset)
    return dataset


def edge_field(name: str) -> str:
    """Return ``name`` if it is a field on the edge, or raise `InputError`."""
    if name not in EDGE_FIELDS:
        raise InputError(
            f"there is no field {name!r} on the edge: {nearest_name(name, EDGE_FIELDS)}"
        )
    return name
