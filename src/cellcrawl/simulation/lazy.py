"""Files opened lazily, whose damage is told in one line whenever it is met."""

from __future__ import annotations

import contextlib
import os
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr
from xarray.backends import BackendArray, BackendEntrypoint
from xarray.core import indexing

from cellcrawl.data import FIELDS, TIME
from cellcrawl.errors import CellcrawlError, StorageError
from cellcrawl.simulation.checksums import damaged


@contextlib.contextmanager
def readable(path: Path) -> Iterator[None]:
    """Turn whatever a reader raises inside into one line that names the file.

    Damaged files make HDF5, h5netcdf, Zarr and xarray raise errors of many kinds.
    """
    try:
        yield
    except CellcrawlError:
        raise
    except MemoryError as error:
        raise StorageError(f"cannot read {path}: {error or 'there is not enough memory'}") from None
    except Exception as error:
        number = getattr(error, "errno", None)  # some libraries put words there
        if isinstance(number, int) and number > 0 and not path.is_dir():
            raise StorageError(f"cannot read {path}: {os.strerror(number)}") from None
        raise damaged(path, _told(path, str(error).lower())) from None


def _told(path: Path, words: str) -> str:
    """Return in our words what HDF5, h5netcdf, Zarr and xarray make of a damaged file."""
    if "checksum" in words or "fletcher32" in words:
        return "its content is not what its checksum says"
    if path.suffix == ".nc" and (path.is_dir() or "signature" in words):
        return "it is no netCDF-4 file"
    if "truncated" in words or "eof" in words:
        return "it is cut short"
    if path.suffix == ".zarr" and "no group" in words:
        return "it is no Zarr store"
    return "it cannot be read"


def open_lazily(path: Path, engine: str, **options: Any) -> xr.Dataset:
    """Open a file by one of xarray's engines; errors of later reads name it."""
    return xr.open_dataset(
        path,
        engine=_NamedFile,
        decode_times=False,
        backend_kwargs={"with_engine": engine, "options": options},
    )


class _NamedFile(BackendEntrypoint):
    """Another engine's Dataset, whose variables know the name of their file."""

    open_dataset_parameters = ("filename_or_obj", "drop_variables", "with_engine", "options")

    def open_dataset(
        self,
        filename_or_obj: Any,
        *,
        drop_variables: Any = None,
        with_engine: str = "h5netcdf",
        options: Any = None,
        decode_times: bool = False,
        **decoding: Any,
    ) -> xr.Dataset:
        path = Path(filename_or_obj)
        inner = xr.open_dataset(
            path,
            engine=with_engine,
            decode_times=False,
            cache=False,
            drop_variables=drop_variables,
            **(options or {}),
        )
        named = {
            name: xr.Variable(
                variable.dims,
                indexing.LazilyIndexedArray(_NamedArray(variable, path)),
                variable.attrs,
                variable.encoding,
            )
            for name, variable in inner.variables.items()
            if name not in inner.indexes
        }
        for name, known in {"time": TIME, **FIELDS}.items():
            if name in inner.variables and inner[name].dims != known.dims:
                raise damaged(path, f"{name!r} has dimensions {inner[name].dims}")
        coords = {name: named.pop(name) for name in list(named) if name in inner.coords}
        dataset = inner.assign(named).assign_coords(coords)
        dataset.set_close(inner.close)
        return dataset


class _NamedArray(BackendArray):
    """A variable of a file, read when it is indexed."""

    def __init__(self, variable: xr.Variable, path: Path) -> None:
        self._variable = variable
        self._path = path
        self.shape = variable.shape
        self.dtype = variable.dtype

    def __getitem__(self, key: indexing.ExplicitIndexer) -> Any:
        return indexing.explicit_indexing_adapter(
            key, self.shape, indexing.IndexingSupport.OUTER, self._read
        )

    def _read(self, key: tuple[Any, ...]) -> np.ndarray:
        with readable(self._path):
            values: np.ndarray = self._variable[key].values
        return values
