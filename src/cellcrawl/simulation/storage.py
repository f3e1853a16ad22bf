"""Runs on disk: blocks while the run goes, one netCDF file or Zarr store when it ends.

A run at ``run.nc`` keeps its blocks in ``run.nc.part/``. Each block is a complete file, written
under a temporary name and renamed, and holds the state to go on from; a run killed at any instant
therefore opens and resumes. When the run ends the blocks become one file, again by renaming. Who
writes holds the lock ``run.nc.lock``; who reads looks again when the files changed meanwhile.
"""

from __future__ import annotations

import contextlib
import itertools
import os
import re
import shutil
import time
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import xarray as xr

from cellcrawl.arguments import checked, file_path
from cellcrawl.data import VARIABLES, checked_attributes
from cellcrawl.errors import InputError, MissingExtraError, StorageError, what_would_help
from cellcrawl.locks import locked
from cellcrawl.simulation import blocks, formats
from cellcrawl.simulation.checksums import damaged
from cellcrawl.simulation.lazy import readable

_SLICE_RECORDS = 256
_FIRST = "first_record"
_LOOKS = 50  # at files that change while they are read, before giving up
_PAUSE = 0.02


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
        given = checked_path(path)
        # The file that a link leads to: its lock and its blocks are those of every name it has.
        self.path = given.resolve() if given.is_symlink() else given
        self._format = formats.by_suffix(self.path)
        self.part = self._beside(".part")
        self._nascent = self._beside(".part.new")
        self._spent = self._beside(".part.old")
        self._lock = self._beside(".lock")
        self._merged = self.part / f"merged{self.path.suffix}"
        self._previous = self.part / f"previous{self.path.suffix}"
        self._has_written = False

    def _beside(self, ending: str) -> Path:
        return self.path.with_name(self.path.name + ending)

    def exists(self) -> bool:
        """Whether there is anything of this run, finished or not."""
        return self.path.exists() or self.part.exists()

    def writing(self) -> contextlib.AbstractContextManager[None]:
        """Hold the run against other writers.

        Raises
        ------
        InputError
            If another process writes it.
        """
        return locked(self._lock, self.path, remove=True)

    def refuse_what_is_no_run(self) -> None:
        """Raise `InputError` if what stands at `path` is not surely a run of ours."""
        foreign = None
        if self.path.exists() and not self._format.is_run(self.path):
            foreign = self.path
        elif self.part.exists() and not self._is_part():
            foreign = self.part
        if foreign is not None:
            raise InputError(
                f"{foreign} is no cellcrawl run that can be read, so it is not overwritten: delete "
                "it yourself, or give another output"
            )

    def _is_part(self) -> bool:
        names = r"block-\d{6}\.(block|h5|tmp)|(merged|previous)\.(nc|zarr)"
        return self.part.is_dir() and all(
            re.fullmatch(names, path.name) for path in self.part.iterdir()
        )

    def remove(self) -> None:
        """Delete whatever stands where the run has its files."""
        for path in (self.part, self._nascent, self._spent, self.path):
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
            When the disk is full or cannot be written; earlier blocks stay as they are. When the
            blocks written before have gone.
        """
        if self._has_written and not self.part.exists():
            raise self._lost(0, first)
        try:
            # The folder comes into being with its first block in it, so it always opens.
            folder = self.part if self.part.exists() else self._nascent
            if folder is self._nascent:
                _remove(folder)
                folder.mkdir(parents=True)
            number = max((_block_number(path) for path in self._blocks()), default=-1) + 1
            target = folder / f"block-{number:06d}{blocks.SUFFIX}"
            temporary = target.with_suffix(".tmp")
            blocks.write(temporary, block, {**attributes, _FIRST: first}, checkpoint)
            _sync(temporary)
            temporary.replace(target)
            if folder is self._nascent:
                folder.replace(self.part)
            self._has_written = True
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
            sources = _up_to(first, self._sources())
            held = sum(source.records for source in sources)
            if held < first:
                raise self._lost(held, first)
            self._merge(sources, block, checkpoint, attributes)
        except OSError as error:
            with contextlib.suppress(OSError):
                _remove(self._merged)
            self.write_block(first, block, checkpoint, attributes)
            if isinstance(error, StorageError):
                raise
            raise StorageError(
                f"cannot write {self.path}: {_reason(error)}; the run is complete in {self.part} "
                f"and opens as {self.path}"
            ) from None

    def consolidate(self) -> None:
        """Turn the blocks of an ended run that was killed before they became one into it."""
        if self._blocks():
            last = self._last_header()
            first = int(last.attributes[_FIRST]) + last.records
            self.finish(first, None, last.checkpoint, _without_first(last.attributes))

    def _merge(
        self,
        sources: list[Source],
        block: xr.Dataset | None,
        checkpoint: Mapping[str, np.ndarray],
        attributes: Mapping[str, Any],
    ) -> None:
        self.part.mkdir(parents=True, exist_ok=True)
        records = sum(source.records for source in sources)
        slices: Iterable[xr.Dataset] = self._slices(sources)
        if block is not None:
            records += block.sizes["time"]
            slices = itertools.chain(slices, [block])
        extras = self._extras(records, attributes)
        _remove(self._merged)
        self._format.write(self._merged, records, slices, attributes, checkpoint, extras)
        if self._merged.is_file():
            _sync(self._merged)
        if self.path.is_dir():
            self.path.replace(self._previous)
        self._merged.replace(self.path)
        # At once, so that nobody meets the run with a part of its blocks.
        _remove(self._spent)
        self.part.replace(self._spent)
        _remove(self._spent)

    def _extras(self, records: int, attributes: Mapping[str, Any]) -> xr.Dataset:
        """Return variables and attributes that the user has added; NaN in records they lack."""
        if not any(base.exists() for base in (self.path, self._previous)):
            return xr.Dataset()
        with self._open_base() as base:
            extras = base.drop_vars([name for name in VARIABLES if name in base.variables]).load()
            extras.attrs = {n: v for n, v in base.attrs.items() if n not in attributes}
        for variable in extras.variables.values():
            variable.encoding = {}
        if "time" not in extras.dims:
            return extras
        missing = {"time": (0, records - extras.sizes["time"])}
        if missing["time"][1] < 0:
            return extras.isel(time=slice(records))
        words = [n for n, v in extras.variables.items() if v.dtype.kind in "OUS"]
        padded = extras.drop_vars(words).pad(missing)
        for name in words:
            empty: Any = ""
            padded[name] = extras[name].pad(missing, constant_values=empty)
        return padded

    def open(self) -> xr.Dataset:
        """Return the run's Dataset: lazy when finished, from its blocks when not."""
        for _ in range(_LOOKS):
            before = self._seen()
            try:
                dataset = self._open_as_it_is()
            except (StorageError, InputError):
                if self._seen() == before:
                    raise
            else:
                if self._seen() == before:
                    checked_attributes(dataset.attrs, self.path)
                    return dataset
                dataset.close()
            time.sleep(_PAUSE)
        raise StorageError(f"{self.path} changes faster than it can be read: try again")

    def _seen(self) -> tuple[Any, ...]:
        """What tells whether a writer changed something between two looks."""
        marks: list[Any] = []
        for path in (self.path, self.path / "zarr.json"):
            with contextlib.suppress(OSError):
                found = path.stat()
                marks.append((found.st_ino, found.st_mtime_ns))
        return (*marks, *self._blocks())

    def _open_as_it_is(self) -> xr.Dataset:
        if not self._blocks():
            return self._open_base()
        with readable(self.part):
            parts = [part[list(VARIABLES)] for part in self._slices(self._sources())]
            attributes = _without_first(self._last_header().attributes)
            dataset: xr.Dataset = xr.concat(parts, "time", combine_attrs="drop")
            dataset.attrs = attributes
        extras = self._extras(dataset.sizes["time"], attributes)
        mine = dataset.assign(extras.data_vars).assign_coords(extras.coords)
        return mine.assign_attrs(extras.attrs)

    def checkpoint(self) -> dict[str, np.ndarray]:
        """Return the last saved state to go on from.

        Raises
        ------
        StorageError
            If there is none, as in a copy that xarray saved.
        """
        if self._blocks():
            return self._last_header().checkpoint
        try:
            return self._format.read_checkpoint(self._base())
        except KeyError:
            raise StorageError(
                f"{self.path} holds records but no state to go on from (was it saved by xarray?): "
                "resume the original file, or start a new run from its last record with FromRun"
            ) from None
        except Exception:
            raise damaged(self.path, "its saved state cannot be read") from None

    def check_records(self) -> None:
        """Read all records; raise `StorageError` if one is damaged or not finite."""
        for part in self._slices(self._sources()):
            for name in VARIABLES:
                if not np.isfinite(part[name].values).all():
                    raise damaged(self.path, f"{name!r} holds values that are not finite")

    def _base(self) -> Path:
        for candidate in (self.path, self._previous):
            if candidate.exists():
                return candidate
        raise StorageError(f"there is no run at {self.path}")

    def _open_base(self) -> xr.Dataset:
        base = self._base()
        with readable(base):
            return self._format.open(base)

    def _blocks(self) -> list[Path]:
        if not self.part.is_dir():
            return []
        endings = (blocks.SUFFIX, blocks.OLD_SUFFIX)
        found = [path for path in self.part.glob("block-*") if path.suffix in endings]
        return sorted(found, key=_block_number)

    def _last_header(self) -> blocks.Header:
        path = self._blocks()[-1]
        with readable(path):
            return blocks.header(path)

    def _sources(self) -> list[Source]:
        """Files in order of their records; a later one replaces what it overlaps."""
        sources = []
        if any(base.exists() for base in (self.path, self._previous)):
            with self._open_base() as base:
                sources.append(Source(self._base(), 0, base.sizes.get("time", 0)))
        for path in self._blocks():
            with readable(path):
                header = blocks.header(path)
                first = int(header.attributes[_FIRST])
            sources = _up_to(first, sources)
            held = sum(source.records for source in sources)
            if held < first:
                raise self._lost(held, first)
            if header.records:
                sources.append(Source(path, first, header.records))
        return sources

    def _slices(self, sources: list[Source]) -> Iterator[xr.Dataset]:
        """Yield the records in order, a bounded number at a time."""
        for path, _, records in sources:
            with readable(path):
                if path.parent == self.part and path.suffix in (blocks.SUFFIX, blocks.OLD_SUFFIX):
                    yield blocks.read(path, slice(records))
                    continue
                with self._format.open(path) as dataset:
                    for start in range(0, records, _SLICE_RECORDS):
                        part = slice(start, min(start + _SLICE_RECORDS, records))
                        yield dataset[list(VARIABLES)].isel(time=part).load()

    def _lost(self, held: int, first: int) -> StorageError:
        return StorageError(
            f"records {held} to {first - 1} of {self.path} have gone: something else removed files "
            f"of {self.part} or {self.path.name}; put them back, or make the run again"
        )


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
        If the file is damaged or edited, lacks records, or was written by a newer version. The
        records of a finished run are checked when they are read.
    """
    store = RunStore(path)
    if not store.exists():
        raise InputError(f"there is no run at {store.path}")
    return store.open()


def checked_path(path: Any) -> Path:
    """Return ``path`` as a Path with a suffix we write, or raise `InputError`."""
    checked = file_path("output", path)
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


def _reason(error: OSError) -> str:
    """The system's word for what went wrong; HDF5 buries it in a long message."""
    text = str(error.strerror or error).splitlines()[0]
    buried = re.search(r"error message = '([^']+)'", str(error))
    return buried.group(1) if buried else text


def _block_number(path: Path) -> int:
    return int(path.stem.removeprefix("block-"))


def _remove(path: Path) -> None:
    if path.is_dir() and not path.is_symlink():
        shutil.rmtree(path)
    else:
        path.unlink(missing_ok=True)


def _sync(path: Path) -> None:
    with path.open("r+b") as file:  # Windows syncs only what is open for writing
        os.fsync(file.fileno())
