"""What the ways to store a run cost: size, time to write, time to read."""

from __future__ import annotations

import tempfile
import time
from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path
from typing import Final, NamedTuple

import xarray as xr

from cellcrawl.bench.cases import check_start
from cellcrawl.parameters import Parameters
from cellcrawl.simulation import simulate
from cellcrawl.simulation.dataset import decode_attribute
from cellcrawl.simulation.formats import Format
from cellcrawl.simulation.netcdf import NetCDF
from cellcrawl.simulation.zarr_store import Zarr

_GZIP: Final = {"compression": "gzip", "compression_opts": 1, "shuffle": True}
WAYS: Final[tuple[tuple[str, str, Format], ...]] = (
    ("run.nc", "as written: checksums", NetCDF()),
    ("gzip.nc", "with shuffle and gzip 1", NetCDF(_GZIP)),
    ("run.zarr", "as written: shuffle, zstd 1, checksums", Zarr()),
    ("plain.zarr", "checksums only", Zarr(squeezed=False)),
)


class Stored(NamedTuple):
    """A run in one format: what is asked of it, its size and the times it takes."""

    file: str
    how: str
    megabytes: float
    write_s: float
    read_s: float
    compute_s: float
    """Time the run itself took, to compare with."""


def measure(quick: bool) -> Iterator[Stored]:
    """Store a run of 256 nodes every 0.1 time units, to t = 100 (20 if quick), best of several."""
    p = Parameters(r_on=26, zeta_1=600)
    simulate(p, 0.1)
    run = simulate(p, 20.0 if quick else 100.0, start=check_start(p))
    compute = float(decode_attribute(run, "diagnostics")["wall_time"])
    repeats = 2 if quick else 5
    with tempfile.TemporaryDirectory() as folder:
        for name, how, form in WAYS:
            path = Path(folder) / name
            wrote = min(_seconds(partial(_write, form, path, run)) for _ in range(repeats))
            read = min(_seconds(partial(_read, form, path)) for _ in range(repeats))
            yield Stored(name, how, round(_size(path) / 1e6, 2), wrote, read, compute)


def _write(form: Format, path: Path, run: xr.Dataset) -> None:
    form.write(path, run.sizes["time"], [run], run.attrs, {}, xr.Dataset())


def _read(form: Format, path: Path) -> None:
    with form.open(path) as run:
        run.load()


def _seconds(work: Callable[[], object]) -> float:
    began = time.perf_counter()
    work()
    return round(time.perf_counter() - began, 3)


def _size(path: Path) -> int:
    files = [path] if path.is_file() else [file for file in path.rglob("*") if file.is_file()]
    return sum(file.stat().st_size for file in files)
