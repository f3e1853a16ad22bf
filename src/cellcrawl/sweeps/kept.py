"""Trajectories and fields of the runs of a chunk: one netCDF file, a group a run."""

from __future__ import annotations

import contextlib
import io
import os
from pathlib import Path
from types import TracebackType
from typing import Any, BinaryIO, Final, Self

import h5py
import numpy as np
import xarray as xr

from cellcrawl.data import SCHEMA_VERSION
from cellcrawl.simulation.checksums import damaged, digest
from cellcrawl.simulation.lazy import readable

_CHECKSUM: Final = "cellcrawl_checksum"


class KeptRuns:
    """A file that takes runs one by one and gets its name when all are in."""

    def __init__(self, path: Path) -> None:
        self._path = path
        self._temporary = path.with_name(f".{path.name}.tmp")
        self._file: Any = None

    def __enter__(self) -> Self:
        return self

    def add(self, key: str, dataset: xr.Dataset) -> None:
        """Write a run's Dataset as the group ``key``."""
        import h5netcdf

        if self._file is None:
            self._path.parent.mkdir(parents=True, exist_ok=True)
            self._bytes = _Patient(self._temporary.open("w+b", buffering=0))
            self._file = h5netcdf.File(self._bytes, "w")
        group = self._file.create_group(key)
        group.dimensions = dict(dataset.sizes)
        for name, variable in dataset.variables.items():
            written = group.create_variable(name, variable.dims, data=variable.values)
            written.attrs.update(variable.attrs)
        group.attrs.update({**dataset.attrs, _CHECKSUM: _checksum(dataset)})
        self._bytes.failed()

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        if self._file is None:
            return
        try:
            self._file.close()
            self._bytes.finish()
            if error is None:
                self._temporary.replace(self._path)
        finally:
            with contextlib.suppress(OSError):
                self._temporary.unlink(missing_ok=True)


class _Patient(io.RawIOBase):
    """A file that hides a failed write until `finish`: HDF5 may crash when a write fails."""

    def __init__(self, file: BinaryIO) -> None:
        self._file = file
        self._failed: OSError | None = None

    def readable(self) -> bool:
        return True

    def writable(self) -> bool:
        return True

    def seekable(self) -> bool:
        return True

    def readinto(self, buffer: Any) -> int:
        data = self._file.read(len(buffer))
        buffer[: len(data)] = data
        return len(data)

    def write(self, data: Any) -> int:
        if self._failed is None:
            try:
                return self._file.write(data)
            except OSError as error:
                self._failed = error
        return len(data)

    def seek(self, offset: int, whence: int = os.SEEK_SET) -> int:
        return self._file.seek(offset, whence)

    def tell(self) -> int:
        return self._file.tell()

    def truncate(self, size: int | None = None) -> int:
        if self._failed is None:
            try:
                return self._file.truncate(size)
            except OSError as error:
                self._failed = error
        return 0

    def flush(self) -> None:
        return

    def failed(self) -> None:
        """Raise the error of the first failed write, if there was one."""
        if self._failed is not None:
            raise self._failed

    def finish(self) -> None:
        """Close, with all data on the disk or an error raised."""
        with self._file:
            self.failed()
            os.fsync(self._file.fileno())


def read_kept(path: Path, key: str) -> xr.Dataset:
    """Return what was kept of a run, read into memory.

    Raises
    ------
    StorageError
        If the file is missing or damaged.
    """
    with readable(path):
        with h5py.File(path, "r") as file:  # h5netcdf complains twice of what fails here
            dict(file.attrs)
        with xr.open_dataset(path, engine="h5netcdf", group=key, decode_times=False) as found:
            run = found.load()
    told = run.attrs.pop(_CHECKSUM, None)
    old = _is_old(run.attrs.get("schema_version"))
    if told != _checksum(run) and not (told is None and old):
        raise damaged(path)
    return run


def _checksum(dataset: xr.Dataset) -> str:
    """Return a hash of all that a Dataset holds."""
    layout = {
        str(name): (
            tuple(str(dim) for dim in variable.dims),
            variable.shape,
            {str(key): str(value) for key, value in variable.attrs.items()},
        )
        for name, variable in dataset.variables.items()
    }
    attributes = {str(name): value for name, value in dataset.attrs.items()}
    values = {str(name): variable.values for name, variable in dataset.variables.items()}
    return digest(attributes, layout, values)


def _is_old(schema: Any) -> bool:
    """Whether a run was written before there were checksums."""
    return isinstance(schema, (int, np.integer)) and int(schema) < SCHEMA_VERSION
