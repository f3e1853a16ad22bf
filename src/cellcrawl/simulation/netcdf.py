"""A finished run as netCDF-4, by h5netcdf."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Final

import h5netcdf
import h5py
import numpy as np
import xarray as xr

from cellcrawl.data import VARIABLES
from cellcrawl.simulation.checksums import CHECKPOINT, SEAL, Layout, check_seal, seal
from cellcrawl.simulation.lazy import open_lazily

_CHUNK_BYTES: Final = 1_000_000
# Bounds of HDF5's own format under which all that describes the data has checksums of HDF5's.
_HDF5: Final = ("v110", "v110")


@dataclass(frozen=True)
class NetCDF:
    """NetCDF-4 by h5netcdf.

    Parameters
    ----------
    filters : mapping
        HDF5's filters besides the checksum. None by default: to squeeze a run takes longer than to
        compute it (`cellcrawl bench storage`).
    """

    filters: Mapping[str, Any] = field(default_factory=dict)

    def open(self, path: Path) -> xr.Dataset:
        with h5py.File(path, "r") as file:
            attributes = _attributes(file)
            if CHECKPOINT in file:
                told = file[CHECKPOINT].attrs.get(SEAL)
                check_seal(path, told, attributes, _layout(file), _arrays(file))
        return open_lazily(path, "h5netcdf")

    def write(
        self,
        path: Path,
        records: int,
        slices: Iterable[xr.Dataset],
        attributes: Mapping[str, Any],
        checkpoint: Mapping[str, np.ndarray],
        extras: xr.Dataset,
    ) -> None:
        with h5netcdf.File(path, "w", libver=_HDF5) as file:
            written = 0
            for part in slices:
                if written == 0:
                    _create(file, part, records, self.filters)
                count = part.sizes["time"]
                for name in VARIABLES:
                    file.variables[name][written : written + count] = part[name].values
                written += count
            file.attrs.update(_netcdf_attributes(attributes))
            group = file.create_group(CHECKPOINT)
            for name, array in checkpoint.items():
                dims = tuple(f"{name}_{axis}" for axis in range(array.ndim))
                group.dimensions.update(zip(dims, array.shape, strict=True))
                group.create_variable(name, dims, data=array)
        with h5py.File(path, "a") as file:
            told = seal(attributes, _layout(file), checkpoint)
            file[CHECKPOINT].attrs[SEAL] = np.bytes_(told.encode())
        if extras.variables or extras.attrs:
            extras.to_netcdf(path, mode="a", engine="h5netcdf")

    def read_checkpoint(self, path: Path) -> dict[str, np.ndarray]:
        with h5py.File(path, "r") as file:
            return _arrays(file)

    def is_run(self, path: Path) -> bool:
        try:
            with h5py.File(path, "r") as file:
                return {"schema_version", "cellcrawl_version"} <= set(file.attrs)
        except Exception:  # HDF5 has many; whatever it is, it is no run that can be read
            return False


def chunk_shape(variable: xr.Variable, records: int) -> tuple[int, ...]:
    """Chunks of about a megabyte that hold whole edges, no longer than the run."""
    across = variable.sizes.get("node", 1)
    chunks = -(-8 * across * records // _CHUNK_BYTES)
    along = -(-records // max(chunks, 1))  # the last chunk as full as the others
    return tuple(along if dim == "time" else across for dim in variable.dims)


def _attributes(file: h5py.File) -> dict[str, Any]:
    """Return attributes as plain values: netCDF keeps numbers as arrays of one."""
    found = {}
    for name, value in file.attrs.items():
        if isinstance(value, np.ndarray) and value.size == 1:
            value = value.item()
        found[name] = value.decode() if isinstance(value, bytes) else value
    return found


def _layout(file: h5py.File) -> Layout:
    return {
        name: (
            (),  # xarray reads them, and the lazy Dataset is held to the contract
            tuple(file[name].shape),
            {key: str(file[name].attrs.get(key)) for key in ("long_name", "units")},
        )
        for name in VARIABLES
        if name in file
    }


def _arrays(file: h5py.File) -> dict[str, np.ndarray]:
    return {
        name: np.asarray(saved[()])
        for name, saved in file[CHECKPOINT].items()
        if "CLASS" not in saved.attrs  # a dimension is a dataset too
    }


def _create(file: h5netcdf.File, first: xr.Dataset, total: int, filters: Mapping[str, Any]) -> None:
    file.dimensions = {"time": total, "node": first.sizes["node"]}
    for name in VARIABLES:
        variable = first[name].variable
        chunks = chunk_shape(variable, total)
        created = file.create_variable(
            name, variable.dims, "f8", chunks=chunks, fletcher32=True, **filters
        )
        created.attrs.update(variable.attrs)


def _netcdf_attributes(attributes: Mapping[str, Any]) -> dict[str, Any]:
    return {
        name: np.bytes_(value.encode()) if isinstance(value, str) and not value.isascii() else value
        for name, value in attributes.items()
    }
