"""Blocks: the files a run is written in while it goes.

A block is an HDF5 file with some records, the run's attributes and the solver's state after the
last record, behind a checksum of the whole. Plain, because one is written every second and has to
be cheap. Version 0.1.0 wrote the HDF5 file alone.
"""

from __future__ import annotations

import io
from collections.abc import Mapping
from pathlib import Path
from typing import Any, Final, NamedTuple

import h5py
import numpy as np
import xarray as xr

from cellcrawl.data import FIELDS
from cellcrawl.simulation.checksums import sealed, unsealed
from cellcrawl.simulation.dataset import arrays_to_dataset

_RECORDS = "records"
_CHECKPOINT = "checkpoint"
SUFFIX: Final = ".block"
OLD_SUFFIX: Final = ".h5"


class Header(NamedTuple):
    """What a block holds, without its records."""

    attributes: dict[str, Any]
    records: int
    checkpoint: dict[str, np.ndarray]


def write(
    path: Path,
    block: xr.Dataset | None,
    attributes: Mapping[str, Any],
    checkpoint: Mapping[str, np.ndarray],
) -> None:
    """Write a block; ``block`` None: no records."""
    with h5py.File(path.name, "w", driver="core", backing_store=False) as file:
        file.attrs.update(attributes)
        for name, array in checkpoint.items():
            file[f"{_CHECKPOINT}/{name}"] = array
        if block is not None:
            for key, variable in block.variables.items():
                file[f"{_RECORDS}/{key}"] = variable.values
        file.flush()
        image = file.id.get_file_image()
    path.write_bytes(sealed(image))


def header(path: Path) -> Header:
    """Return what a block holds, without its records."""
    with _opened(path) as file:
        attributes = {
            name: value.item() if isinstance(value, np.generic) else value
            for name, value in file.attrs.items()
        }
        records = file[f"{_RECORDS}/time"].size if _RECORDS in file else 0
        checkpoint = {name: saved[()] for name, saved in file[_CHECKPOINT].items()}
    return Header(attributes, records, {k: np.asarray(v) for k, v in checkpoint.items()})


def read(path: Path, records: slice) -> xr.Dataset:
    """Return some of a block's records."""
    with _opened(path) as file:
        saved = file[_RECORDS]
        arrays = {name: np.asarray(saved[name][records]) for name in ("time", *FIELDS)}
    return arrays_to_dataset(arrays, {})


def _opened(path: Path) -> h5py.File:
    if path.suffix == OLD_SUFFIX:
        return h5py.File(path, "r")
    return h5py.File(io.BytesIO(unsealed(path.read_bytes(), path)), "r")
