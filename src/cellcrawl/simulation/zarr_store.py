"""A finished run as a Zarr store, by the zarr package."""

from __future__ import annotations

import contextlib
import json
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from cellcrawl.data import FIELDS, VARIABLES
from cellcrawl.errors import StorageError
from cellcrawl.simulation.checksums import (
    CHECKPOINT,
    SEAL,
    Layout,
    check_seal,
    damaged,
    seal,
)
from cellcrawl.simulation.lazy import open_lazily
from cellcrawl.simulation.netcdf import chunk_shape


@dataclass(frozen=True)
class Zarr:
    """A Zarr store, by the zarr package.

    Parameters
    ----------
    squeezed : bool
        Compress: Blosc does it in next to no time (`cellcrawl bench storage`).
    """

    squeezed: bool = True

    def open(self, path: Path) -> xr.Dataset:
        if (path / CHECKPOINT).is_dir():
            attributes = _described(path).get("attributes", {})
            told = _described(path / CHECKPOINT).get("attributes", {}).get(SEAL)
            layout = self._layout(path)
            check_seal(path, told, attributes, layout, self.read_checkpoint(path))
            if told is not None:
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

        blosc = BloscCodec(cname="zstd", clevel=1, shuffle="shuffle", typesize=8)
        codecs = (blosc, Crc32cCodec()) if self.squeezed else (Crc32cCodec(),)
        for number, part in enumerate(slices):
            own = part[list(FIELDS)]
            own.attrs = dict(attributes)
            for variable in own.variables.values():
                variable.encoding = {}
                if number == 0:
                    variable.encoding = {
                        "chunks": chunk_shape(variable, records),
                        "compressors": codecs,
                    }
            where: dict[str, Any] = {"append_dim": "time"} if number else {"mode": "w"}
            # Chunks of nothing but zeros are written too: a chunk that is not there is missing.
            own.to_zarr(path, consolidated=False, write_empty_chunks=True, **where)
        if extras.variables or extras.attrs:
            extras = extras.assign_attrs(attributes)  # xarray replaces them all
            extras.to_zarr(path, mode="a", consolidated=False)
        state = _checkpoint_dataset(checkpoint)
        state.attrs = {SEAL: seal(attributes, self._layout(path), checkpoint)}
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
            for name in VARIABLES
            if (path / name).is_dir()
            for found in [_described(path / name)]
        }

    def _check_chunks(self, path: Path) -> None:
        import zarr

        group = zarr.open_group(path, mode="r")
        for name in VARIABLES:
            array: Any = group[name]
            if array.nchunks_initialized != array.nchunks:
                raise damaged(path, f"files of {name!r} are missing")


def _described(path: Path) -> dict[str, Any]:
    found = json.loads((path / "zarr.json").read_text("utf-8"))
    if not isinstance(found, dict):
        raise StorageError(f"cannot read {path}: its zarr.json is no table")
    return found


def _checkpoint_dataset(checkpoint: Mapping[str, np.ndarray]) -> xr.Dataset:
    return xr.Dataset(
        {
            name: (tuple(f"{name}_{axis}" for axis in range(array.ndim)), array)
            for name, array in checkpoint.items()
        }
    )
