"""The two file formats of a finished run, written slice by slice."""

from __future__ import annotations

import contextlib
import json
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any, Final, Protocol

import h5netcdf
import numpy as np
import xarray as xr

from cellcrawl.data import FIELDS, SCHEMA_VERSION, checked_attributes
from cellcrawl.errors import StorageError
from cellcrawl.simulation.checksums import Layout, damaged, digest
from cellcrawl.simulation.lazy import open_lazily

CHECKPOINT: Final = "checkpoint"
OWN: Final = ("time", *FIELDS)
_SEAL: Final = "seal"
_CHUNK_BYTES: Final = 1_000_000
# Bounds of HDF5's own format under which all that describes the data has checksums of HDF5's.
_HDF5: Final = ("v110", "v110")


class Format(Protocol):
    """A way to store a run.

    The group ``checkpoint`` holds the state to go on from, and a digest of that state, of the run's
    attributes and of what variables there are. A copy made by xarray has no such group: it opens,
    and cannot be resumed.
    """

    def open(self, path: Path) -> xr.Dataset:
        """Open lazily, once all but the records is seen to be as it was written."""
        ...

    def write(
        self,
        path: Path,
        records: int,
        slices: Iterable[xr.Dataset],
        attributes: Mapping[str, Any],
        checkpoint: Mapping[str, np.ndarray],
        extras: xr.Dataset,
    ) -> None:
        """Write slices along time, one after another; ``records`` in all.

        ``extras`` are variables and attributes of the user's own.
        """
        ...

    def read_checkpoint(self, path: Path) -> dict[str, np.ndarray]:
        """Read the state to go on from; raises KeyError if there is none."""
        ...

    def is_run(self, path: Path) -> bool:
        """Whether what is there was written as a run."""
        ...


class NetCDF:
    """NetCDF-4 by h5netcdf."""

    def open(self, path: Path) -> xr.Dataset:
        with h5netcdf.File(path, "r") as file:
            if CHECKPOINT in file.groups:
                seal = file.groups[CHECKPOINT].attrs.get(_SEAL)
                _check_seal(path, seal, dict(file.attrs), _layout(file), _arrays(file))
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
                    _create(file, part, records)
                count = part.sizes["time"]
                for name in OWN:
                    file.variables[name][written : written + count] = part[name].values
                written += count
            file.attrs.update(_netcdf_attributes(attributes))
            group = file.create_group(CHECKPOINT)
            for name, array in checkpoint.items():
                dims = tuple(f"{name}_{axis}" for axis in range(array.ndim))
                group.dimensions.update(zip(dims, array.shape, strict=True))
                group.create_variable(name, dims, data=array)
            group.attrs[_SEAL] = np.bytes_(_seal(attributes, _layout(file), checkpoint).encode())
        if extras.variables or extras.attrs:
            extras.to_netcdf(path, mode="a", engine="h5netcdf")

    def read_checkpoint(self, path: Path) -> dict[str, np.ndarray]:
        with h5netcdf.File(path, "r") as file:
            return _arrays(file)

    def is_run(self, path: Path) -> bool:
        try:
            with h5netcdf.File(path, "r") as file:
                return {"schema_version", "cellcrawl_version"} <= set(file.attrs)
        except Exception:  # HDF5 has many; whatever it is, it is no run that can be read
            return False


class Zarr:
    """A Zarr store, by the zarr package."""

    def open(self, path: Path) -> xr.Dataset:
        if (path / CHECKPOINT).is_dir():
            attributes = _described(path).get("attributes", {})
            seal = _described(path / CHECKPOINT).get("attributes", {}).get(_SEAL)
            layout = self._layout(path)
            _check_seal(path, seal, attributes, layout, self.read_checkpoint(path))
            if seal is not None:
                self._check_chunks(path)
        return open_lazily(path, "zarr", consolidated=False)

    def write(
        self,
        path: Path,
        records: int,
        slices: Iterable[xr.Dataset],
        attributes: Mapping[str, Any],
        checkpoint: Mapping[str, np.ndarray],
        extras: xr.Dataset,
    ) -> None:
        from zarr.codecs import BloscCodec, Crc32cCodec

        squeezed = BloscCodec(cname="zstd", clevel=1, shuffle="shuffle", typesize=8)
        for number, part in enumerate(slices):
            own = part[list(FIELDS)]
            own.attrs = dict(attributes)
            for variable in own.variables.values():
                variable.encoding = {}
                if number == 0:
                    variable.encoding = {
                        "chunks": _chunks(variable, records),
                        "compressors": (squeezed, Crc32cCodec()),
                    }
            where: dict[str, Any] = {"append_dim": "time"} if number else {"mode": "w"}
            # Chunks of nothing but zeros are written too: a chunk that is not there is missing.
            own.to_zarr(path, consolidated=False, write_empty_chunks=True, **where)
        if extras.variables or extras.attrs:
            extras = extras.assign_attrs(attributes)  # xarray replaces them all
            extras.to_zarr(path, mode="a", consolidated=False)
        state = _checkpoint_dataset(checkpoint)
        state.attrs = {_SEAL: _seal(attributes, self._layout(path), checkpoint)}
        state.to_zarr(path, group=CHECKPOINT, mode="a", consolidated=False)

    def read_checkpoint(self, path: Path) -> dict[str, np.ndarray]:
        if not (path / CHECKPOINT).is_dir():
            raise KeyError(CHECKPOINT)
        with xr.open_zarr(path, group=CHECKPOINT, consolidated=False, chunks=None) as saved:
            return {str(name): np.array(array.values) for name, array in saved.items()}

    def is_run(self, path: Path) -> bool:
        with contextlib.suppress(OSError, ValueError, AttributeError, TypeError):
            return {"schema_version", "cellcrawl_version"} <= set(_described(path)["attributes"])
        return False

    def _layout(self, path: Path) -> Layout:
        """All that is said of our arrays, chunks and codecs too."""
        return {
            name: (
                tuple(found.get("dimension_names") or ()),
                tuple(found.get("shape") or ()),
                {"all": json.dumps(found, sort_keys=True)},
            )
            for name in OWN
            if (path / name).is_dir()
            for found in [_described(path / name)]
        }

    def _check_chunks(self, path: Path) -> None:
        import zarr

        group = zarr.open_group(path, mode="r")
        for name in OWN:
            array: Any = group[name]
            if array.nchunks_initialized != array.nchunks:
                raise damaged(path, f"files of {name!r} are missing")


NETCDF: Final = NetCDF()
BY_SUFFIX: Final[dict[str, Format]] = {".nc": NETCDF, ".zarr": Zarr()}


def by_suffix(path: Path) -> Format:
    """Return the format a path's suffix asks for."""
    return BY_SUFFIX[path.suffix]


def _seal(
    attributes: Mapping[str, Any], layout: Layout, checkpoint: Mapping[str, np.ndarray]
) -> str:
    names = sorted(attributes)
    return json.dumps({"attributes": names, "digest": digest(attributes, layout, checkpoint)})


def _check_seal(
    path: Path,
    seal: Any,
    attributes: Mapping[str, Any],
    layout: Layout,
    checkpoint: Mapping[str, np.ndarray],
) -> None:
    """Refuse a file that is not as it was written; what the user has added does not count."""
    if seal is None:
        checked_attributes(attributes, path)
        if attributes["schema_version"] < SCHEMA_VERSION:
            return  # written by 0.1.0
    try:
        found = json.loads(seal)
        own = {name: attributes[name] for name in found["attributes"]}
        held = found["digest"] == digest(own, layout, checkpoint)
    except (KeyError, TypeError, ValueError):
        held = False
    if not held:
        checked_attributes(attributes, path)  # says more, if it is one of these
        raise damaged(path, "its attributes, variables or state were changed since")


def _layout(file: h5netcdf.File) -> Layout:
    return {
        name: (
            tuple(variable.dimensions),
            tuple(variable.shape),
            {key: str(variable.attrs.get(key)) for key in ("long_name", "units")},
        )
        for name in OWN
        if name in file.variables
        for variable in [file.variables[name]]
    }


def _arrays(file: h5netcdf.File) -> dict[str, np.ndarray]:
    group = file.groups[CHECKPOINT]
    return {name: np.asarray(variable[...]) for name, variable in group.variables.items()}


def _described(path: Path) -> dict[str, Any]:
    found = json.loads((path / "zarr.json").read_text("utf-8"))
    if not isinstance(found, dict):
        raise StorageError(f"cannot read {path}: its zarr.json is no table")
    return found


def _create(file: h5netcdf.File, first: xr.Dataset, total: int) -> None:
    file.dimensions = {"time": total, "node": first.sizes["node"]}
    for name in OWN:
        variable = first[name].variable
        chunks = _chunks(variable, total)
        created = file.create_variable(name, variable.dims, "f8", chunks=chunks, fletcher32=True)
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
