"""The data contract: names, dimensions, units and attributes of a run's Dataset."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from importlib.metadata import version
from typing import Any, Final, NamedTuple

import numpy as np
import xarray as xr

from cellcrawl.errors import InputError
from cellcrawl.solvers import Frame

SCHEMA_VERSION: Final = 1


class Field(NamedTuple):
    """A variable of the Dataset."""

    dims: tuple[str, ...]
    long_name: str
    units: str


_EDGE = ("time", "node")
FIELDS: Final[dict[str, Field]] = {
    "x": Field(_EDGE, "position of the edge, x", "R_0"),
    "y": Field(_EDGE, "position of the edge, y", "R_0"),
    "theta": Field(_EDGE, "tangent angle", "rad"),
    "curvature": Field(_EDGE, "curvature of the edge", "1/R_0"),
    "bound_fraction": Field(_EDGE, "fraction of bound linkers", "1"),
    "off_rate": Field(_EDGE, "off-rate of linkers", "k_off0"),
    "normal_velocity": Field(_EDGE, "outward normal velocity of the edge", "R_0 k_off0"),
    "friction": Field(_EDGE, "friction (traction) on the edge", "zeta_0 v_beta"),
    "tension": Field(("time",), "membrane tension", "zeta_0 v_beta / 2"),
    "length": Field(("time",), "length of the edge", "R_0"),
    "area": Field(("time",), "enclosed area, from the shape", "R_0^2"),
    "centroid_x": Field(("time",), "centroid of the area, x", "R_0"),
    "centroid_y": Field(("time",), "centroid of the area, y", "R_0"),
}
TIME: Final = Field(("time",), "time", "1/k_off0")


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


def encode_attributes(attributes: Mapping[str, Any]) -> dict[str, Any]:
    """Return attributes as netCDF can hold them: tables and lists become JSON text."""
    return {
        name: json.dumps(value) if isinstance(value, (dict, list)) else value
        for name, value in attributes.items()
    }


def decode_attribute(dataset: xr.Dataset, name: str) -> Any:
    """Return an attribute that is stored as JSON text; raises `InputError` if there is none."""
    try:
        return json.loads(dataset.attrs[name])
    except KeyError:
        raise InputError(
            f"this dataset has no attribute {name!r}: is it a cellcrawl run?"
        ) from None
    except (TypeError, ValueError):
        raise InputError(f"the attribute {name!r} of this dataset is not valid JSON") from None


def package_version() -> str:
    """Return the version of the installed package."""
    return version("cellcrawl")


def check_run(dataset: xr.Dataset) -> xr.Dataset:
    """Return ``dataset`` if it keeps the contract, or raise `InputError` naming what is missing."""
    if not isinstance(dataset, xr.Dataset):
        raise InputError(f"a run is an xarray Dataset, not {type(dataset).__name__}")
    for name, field in {"time": TIME, **FIELDS}.items():
        if name not in dataset.variables:
            raise InputError(f"this dataset has no {name!r}: is it a cellcrawl run?")
        if dataset[name].dims != field.dims:
            raise InputError(
                f"{name!r} has dimensions {dataset[name].dims}: a run has {field.dims}"
            )
    return dataset
