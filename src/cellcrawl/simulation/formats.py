"""The two file formats of a finished run, written slice by slice."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any, Final, Protocol

import h5netcdf
import numpy as np
import xarray as xr

_CHECKPOINT = "checkpoint"
_CHUNK_BYTES = 1_000_000


class Format(Protocol):
    """A way to store a run."""

    def open(self, path: Path) -> xr.Dataset:
        """Open lazily."""
        ...

    def write(
        self,
        path: Path,
        records: int,
        slices: Iterable[xr.Dataset],
        attributes: Mapping[str, Any],
        checkpoint: Mapping[str, np.ndarray],
    ) -> None:
        """Write slices along time, one after another; ``records`` in all."""
        ...

    def read_checkpoint(self, path: Path) -> dict[str, np.ndarray]:
        """Read the state to go on from."""
        ...


class NetCDF:
    """NetCDF-4 by h5netcdf."""

    def open(self, path: Path) -> xr.Dataset:
        return xr.open_dataset(path, engine="h5netcdf", decode_times=False)

    def write(
        self,
        path: Path,
        records: int,
        slices: Iterable[xr.Dataset],
        attributes: Mapping[str, Any],
        checkpoint: Mapping[str, np.ndarray],
    ) -> None:
        with h5netcdf.File(path, "w") as file:
            written = 0
            for part in slices:
                if written == 0:
                    _create(file, part, records)
                count = part.sizes["time"]
                for name, variable in part.variables.items():
                    file.variables[name][written : written + count] = variable.values
                written += count
            file.attrs.update(_netcdf_attributes(attributes))
            group = file.create_group(_CHECKPOINT)
            for name, array in checkpoint.items():
                dims = tuple(f"{name}_{axis}" for axis in range(array.ndim))
                group.dimensions.update(zip(dims, array.shape, strict=True))
                group.create_variable(name, dims, data=array)

    def read_checkpoint(self, path: Path) -> dict[str, np.ndarray]:
        with xr.open_dataset(path, engine="h5netcdf", group=_CHECKPOINT) as saved:
            return {str(name): np.array(array.values) for name, array in saved.items()}


class Zarr:
    """A Zarr store, by the zarr package."""

    def open(self, path: Path) -> xr.Dataset:
        dataset: xr.Dataset = xr.open_zarr(
            path, consolidated=False, decode_times=False, chunks=None
        )
        return dataset

    def write(
        self,
        path: Path,
        records: int,
        slices: Iterable[xr.Dataset],
        attributes: Mapping[str, Any],
        checkpoint: Mapping[str, np.ndarray],
    ) -> None:
        for number, part in enumerate(slices):
            part.attrs = dict(attributes)
            for variable in part.variables.values():
                variable.encoding = {} if number else {"chunks": _chunks(variable, records)}
            where: dict[str, Any] = {"append_dim": "time"} if number else {"mode": "w"}
            part.to_zarr(path, consolidated=False, **where)
        _checkpoint_dataset(checkpoint).to_zarr(
            path, group=_CHECKPOINT, mode="a", consolidated=False
        )

    def read_checkpoint(self, path: Path) -> dict[str, np.ndarray]:
        with xr.open_zarr(path, group=_CHECKPOINT, consolidated=False, chunks=None) as saved:
            return {str(name): np.array(array.values) for name, array in saved.items()}


NETCDF: Final = NetCDF()
BY_SUFFIX: Final[dict[str, Format]] = {".nc": NETCDF, ".zarr": Zarr()}


def by_suffix(path: Path) -> Format:
    """Return the format a path's suffix asks for."""
    return BY_SUFFIX[path.suffix]


def _create(file: h5netcdf.File, first: xr.Dataset, total: int) -> None:
    file.dimensions = {"time": total, "node": first.sizes["node"]}
    for name, variable in first.variables.items():
        chunks = _chunks(variable, total)
        created = file.create_variable(name, variable.dims, "f8", chunks=chunks)
        created.attrs.update(variable.attrs)


def _chunks(variable: xr.Variable, records: int) -> tuple[int, ...]:
    """Chunks of about a megabyte that hold whole edges, no longer than the run."""
    across = variable.sizes.get("node", 1)
    chunks = -(-8 * across * records // _CHUNK_BYTES)
    along = -(-records // max(chunks, 1))  # the last chunk as full as the others
    return tuple(along if dim == "time" else across for dim in variable.dims)


def _netcdf_attributes(attributes: Mapping[str, Any]) -> dict[str, Any]:
    return {
        name: np.bytes_(value.encode()) if isinstance(value, str) and not value.isascii() else value
        for name, value in attributes.items()
    }


def _checkpoint_dataset(checkpoint: Mapping[str, np.ndarray]) -> xr.Dataset:
    return xr.Dataset(
        {
            name: (tuple(f"{name}_{axis}" for axis in range(array.ndim)), array)
            for name, array in checkpoint.items()
        }
    )
