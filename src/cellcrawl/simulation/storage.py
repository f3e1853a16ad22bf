"""Runs on disk: blocks while the run goes, one netCDF file or Zarr store when it ends.

A run at ``run.nc`` keeps its blocks in ``run.nc.part/``. Each block is a complete file, written
under a temporary name and renamed, and holds the state to go on from; a run killed at any instant
therefore opens and resumes. When the run ends the blocks become one file, again by renaming.
"""

from __future__ import annotations

import contextlib
import itertools
import os
import re
import shutil
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import xarray as xr

from cellcrawl.arguments import checked
from cellcrawl.errors import InputError, MissingExtraError, StorageError, what_would_help
from cellcrawl.simulation import blocks, formats
from cellcrawl.simulation.dataset import SCHEMA_VERSION

_SLICE_RECORDS = 256
_FIRST = "first_record"


class Source(NamedTuple):
    """A file of consecutive records; it counts from ``first`` up to where the next one starts."""

    path: Path
    first: int
    records: int


class RunStore:
    """The files of one run.

    Parameters
    ----------
    path : str or Path
        Where the run is or will be; ends in ``.nc`` or ``.zarr``.
    """

    def __init__(self, path: str | Path) -> None:
        self.path = checked_path(path)
        self._format = formats.by_suffix(self.path)
        self.part = self.path.with_name(self.path.name + ".part")
        self._nascent = self.part.with_name(self.part.name + ".new")
        self._merged = self.part / f"merged{self.path.suffix}"
        self._previous = self.part / f"previous{self.path.suffix}"

    def exists(self) -> bool:
        """Whether there is anything of this run, finished or not."""
        return self.path.exists() or self.part.exists()

    def remove(self) -> None:
        """Delete the run."""
        for path in (self.part, self._nascent, self.path):
            _remove(path)

    def write_block(
        self,
        first: int,
        block: xr.Dataset | None,
        checkpoint: Mapping[str, np.ndarray],
        attributes: Mapping[str, Any],
    ) -> None:
        """Write records ``first`` onwards, attributes and checkpoint as one block, all or nothing.

        Raises
        ------
        StorageError
            When the disk is full or cannot be written; earlier blocks stay as they are.
        """
        try:
            # The folder comes into being with its first block in it, so it always opens.
            folder = self.part if self.part.exists() else self._nascent
            if folder is self._nascent:
                _remove(folder)
                folder.mkdir(parents=True)
            number = max((_block_number(path) for path in self._blocks()), default=-1) + 1
            target = folder / f"block-{number:06d}.h5"
            temporary = target.with_suffix(".tmp")
            blocks.write(temporary, block, {**attributes, _FIRST: first}, checkpoint)
            _sync(temporary)
            temporary.replace(target)
            if folder is self._nascent:
                folder.replace(self.part)
        except OSError as error:
            with contextlib.suppress(OSError, UnboundLocalError):
                temporary.unlink(missing_ok=True)
            raise StorageError(
                f"cannot write to {self.part}: {_reason(error)}; what was saved before "
                f"stays readable, and `cellcrawl resume {self.path}` goes on "
                f"{what_would_help(error, _reason(error))}"
            ) from None

    def finish(
        self,
        first: int,
        block: xr.Dataset | None,
        checkpoint: Mapping[str, np.ndarray],
        attributes: Mapping[str, Any],
    ) -> None:
        """Turn what is there and the last records, from ``first`` on, into one file at `path`.

        If that cannot be written, the last records become a block and all is as before.
        """
        try:
            self._merge(first, block, checkpoint, attributes)
        except OSError as error:
            with contextlib.suppress(OSError):
                _remove(self._merged)
            self.write_block(first, block, checkpoint, attributes)
            raise StorageError(
                f"cannot write {self.path}: {_reason(error)}; the run is complete in {self.part} "
                f"and opens as {self.path}"
            ) from None

    def consolidate(self) -> None:
        """Turn the blocks of an ended run that was killed before they became one into it."""
        if self._blocks():
            last = blocks.header(self._blocks()[-1])
            first = int(last.attributes[_FIRST]) + last.records
            self.finish(first, None, last.checkpoint, _without_first(last.attributes))

    def _merge(
        self,
        first: int,
        block: xr.Dataset | None,
        checkpoint: Mapping[str, np.ndarray],
        attributes: Mapping[str, Any],
    ) -> None:
        self.part.mkdir(parents=True, exist_ok=True)
        sources = _up_to(first, self._sources())
        records = sum(source.records for source in sources)
        slices: Iterable[xr.Dataset] = self._slices(sources)
        if block is not None:
            records += block.sizes["time"]
            slices = itertools.chain(slices, [block])
        _remove(self._merged)
        self._format.write(self._merged, records, slices, attributes, checkpoint)
        if self.path.is_dir():
            self.path.replace(self._previous)
        self._merged.replace(self.path)
        _remove(self.part)

    def open(self) -> xr.Dataset:
        """Return the run's Dataset: lazy when finished, from its blocks when not."""
        if not self._blocks():
            dataset = self._open_base()
        else:
            dataset = xr.concat(list(self._slices(self._sources())), "time", combine_attrs="drop")
            with _readable(self.part):
                dataset.attrs = _without_first(blocks.header(self._blocks()[-1]).attributes)
        found = dataset.attrs.get("schema_version")
        if found is None:
            raise InputError(f"{self.path} is not a cellcrawl run: it has no schema_version")
        if int(found) > SCHEMA_VERSION:
            raise StorageError(
                f"{self.path} was written by a newer cellcrawl (schema {found}, this one reads up "
                f"to {SCHEMA_VERSION}): update cellcrawl"
            )
        return dataset

    def checkpoint(self) -> dict[str, np.ndarray]:
        """Return the last saved state to go on from."""
        with _readable(self.path):
            if self._blocks():
                return blocks.header(self._blocks()[-1]).checkpoint
            return self._format.read_checkpoint(self._base())

    def _base(self) -> Path:
        for candidate in (self.path, self._previous):
            if candidate.exists():
                return candidate
        raise StorageError(f"there is no run at {self.path}")

    def _open_base(self) -> xr.Dataset:
        base = self._base()
        with _readable(base):
            return self._format.open(base)

    def _blocks(self) -> list[Path]:
        return sorted(self.part.glob("block-*.h5")) if self.part.is_dir() else []

    def _sources(self) -> list[Source]:
        """Files in order of their records; a later one replaces what it overlaps."""
        sources = []
        with contextlib.suppress(StorageError), self._open_base() as base:
            sources.append(Source(self._base(), 0, base.sizes.get("time", 0)))
        for path in self._blocks():
            with _readable(path):
                header = blocks.header(path)
            first = int(header.attributes[_FIRST])
            sources = _up_to(first, sources)
            if header.records:
                sources.append(Source(path, first, header.records))
        return sources

    def _slices(self, sources: list[Source]) -> Iterator[xr.Dataset]:
        """Yield the records in order, a bounded number at a time."""
        for path, _, records in sources:
            with _readable(path):
                for start in range(0, records, _SLICE_RECORDS):
                    part = slice(start, min(start + _SLICE_RECORDS, records))
                    if path.parent == self.part and path.suffix == ".h5":
                        yield blocks.read(path, part)
                    else:
                        with self._format.open(path) as dataset:
                            yield dataset.isel(time=part).load()


def _up_to(first: int, sources: list[Source]) -> list[Source]:
    """Sources of the records before ``first``."""
    return [
        Source(path, start, min(records, first - start))
        for path, start, records in sources
        if start < first
    ]


def _without_first(attributes: Mapping[str, Any]) -> dict[str, Any]:
    return {name: value for name, value in attributes.items() if name != _FIRST}


@checked
def open_run(path: str | Path) -> xr.Dataset:
    """Open a saved run, finished or not.

    Parameters
    ----------
    path : str or Path
        The file or store given to `simulate` as ``output``.

    Returns
    -------
    Dataset
        Read lazily from a finished run. A run that was killed is put together from its blocks; its
        status is "running".

    Raises
    ------
    InputError
        If there is no run at ``path``, or it is none of ours.
    StorageError
        If the file is damaged or was written by a newer version.
    """
    store = RunStore(path)
    if not store.exists():
        raise InputError(f"there is no run at {store.path}")
    return store.open()


def checked_path(path: Any) -> Path:
    """Return ``path`` as a Path with a suffix we write, or raise `InputError`."""
    if not isinstance(path, (str, os.PathLike)):
        raise InputError(f"output must be a path, not {type(path).__name__}")
    checked = Path(path)
    if checked.suffix not in formats.BY_SUFFIX:
        raise InputError(f"{checked} must end in .nc (netCDF) or .zarr")
    if checked.suffix == ".zarr":
        try:
            import zarr  # noqa: F401
        except ImportError:
            raise MissingExtraError(
                "a .zarr output needs zarr: pip install 'cellcrawl[zarr]', or give a .nc output"
            ) from None
    return checked


@contextlib.contextmanager
def _readable(path: Path) -> Iterator[None]:
    try:
        yield
    except (OSError, ValueError, KeyError) as error:
        if isinstance(error, (StorageError, InputError)):
            raise
        reason = str(error).splitlines()[0] if str(error) else type(error).__name__
        raise StorageError(f"cannot read {path}: {reason}") from None


def _reason(error: OSError) -> str:
    """The system's word for what went wrong; HDF5 buries it in a long message."""
    text = str(error.strerror or error).splitlines()[0]
    buried = re.search(r"error message = '([^']+)'", str(error))
    return buried.group(1) if buried else text


def _block_number(path: Path) -> int:
    return int(path.stem.removeprefix("block-"))


def _remove(path: Path) -> None:
    if path.is_dir():
        shutil.rmtree(path)
    else:
        path.unlink(missing_ok=True)


def _sync(path: Path) -> None:
    descriptor = os.open(path, os.O_RDONLY)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)
