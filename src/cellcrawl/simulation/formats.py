"""The file formats of a finished run."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any, Final, Protocol

import numpy as np
import xarray as xr

from cellcrawl.simulation.netcdf import NetCDF
from cellcrawl.simulation.zarr_store import Zarr


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


BY_SUFFIX: Final[dict[str, Format]] = {".nc": NetCDF(), ".zarr": Zarr()}


def by_suffix(path: Path) -> Format:
    """Return the format a path's suffix asks for."""
    return BY_SUFFIX[path.suffix]
