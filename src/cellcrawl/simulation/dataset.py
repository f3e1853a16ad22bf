"""Frames of a solver as a run's Dataset, by the data contract of `cellcrawl.data`."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import cache
from importlib.metadata import version
from typing import Any

import numpy as np
import xarray as xr

from cellcrawl.data import (
    FIELDS,
    SCHEMA_VERSION,
    TIME,
    check_run,
    decode_attribute,
    encode_attributes,
)
from cellcrawl.solvers import Frame

__all__ = [
    "FIELDS",
    "SCHEMA_VERSION",
    "TIME",
    "arrays_to_dataset",
    "check_run",
    "decode_attribute",
    "encode_attributes",
    "frames_to_dataset",
    "package_version",
]


def frames_to_dataset(frames: Sequence[Frame], attributes: Mapping[str, Any]) -> xr.Dataset:
    """Return frames, all with the same number of nodes, as a Dataset of the schema."""
    names = ("time", *FIELDS)
    arrays = {name: np.array([getattr(frame, name) for frame in frames]) for name in names}
    return arrays_to_dataset(arrays, attributes)


def arrays_to_dataset(
    arrays: Mapping[str, np.ndarray], attributes: Mapping[str, Any]
) -> xr.Dataset:
    """Return arrays, named as in the schema and with time, as a Dataset."""
    variables = {
        name: (field.dims, arrays[name], {"long_name": field.long_name, "units": field.units})
        for name, field in FIELDS.items()
    }
    described = {"long_name": TIME.long_name, "units": TIME.units}
    return xr.Dataset(
        variables, coords={"time": ("time", arrays["time"], described)}, attrs=dict(attributes)
    )


@cache
def package_version() -> str:
    """Return the version of the installed package."""
    return version("cellcrawl")
