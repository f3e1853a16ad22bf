"""Trajectories and fields of the runs of a chunk: one netCDF file, a group a run."""

from __future__ import annotations

import contextlib
import os
from pathlib import Path
from types import TracebackType
from typing import Any, Self

import xarray as xr

from cellcrawl.errors import StorageError


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
            self._file = h5netcdf.File(self._temporary, "w")
        group = self._file.create_group(key)
        group.dimensions = dict(dataset.sizes)
        for name, variable in dataset.variables.items():
            written = group.create_variable(name, variable.dims, data=variable.values)
            written.attrs.update(variable.attrs)
        group.attrs.update(dataset.attrs)

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
            if error is None:
                with self._temporary.open("rb") as written:
                    os.fsync(written.fileno())
                self._temporary.replace(self._path)
        finally:
            with contextlib.suppress(OSError):
                self._temporary.unlink(missing_ok=True)


def read_kept(path: Path, key: str) -> xr.Dataset:
    """Return what was kept of a run, read into memory."""
    try:
        with xr.open_dataset(path, engine="h5netcdf", group=key, decode_times=False) as found:
            return found.load()
    except (OSError, KeyError, ValueError) as error:
        reason = " ".join(str(error).split())[:150]
        raise StorageError(f"cannot read run {key} in {path}: {reason}") from None
