"""Where recipes work: runs that all share, and a folder each for its pictures and data."""

from __future__ import annotations

import csv
import json
import os
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import xarray as xr
from matplotlib.figure import Figure

from cellcrawl.errors import StorageError
from cellcrawl.parameters import Parameters
from cellcrawl.reproduction.runs import kept_run

if TYPE_CHECKING:
    from cellcrawl.sweeps import Sweep

_RECORD: Final = "about.json"


class Workspace:
    """A recipe's folder, and what it may ask for; keeps the list of the files it has written.

    Parameters
    ----------
    root : Path
        Folder of all results; shared runs are in ``root/runs``.
    name : str
        The recipe's name and that of its folder.
    quick : bool
        Shorter runs and fewer points.
    formats : sequence of str
        Picture formats.
    dpi : int
        Resolution of a PNG.
    progress : bool
        Show progress bars.
    """

    def __init__(
        self,
        root: Path,
        name: str,
        *,
        quick: bool = False,
        formats: Sequence[str] = ("png",),
        dpi: int = 200,
        progress: bool = False,
    ) -> None:
        self.root, self.name, self.quick = root, name, quick
        self.formats, self.dpi, self.progress = tuple(formats), dpi, progress
        self.folder = root / name
        self._written: list[Path] = []

    @property
    def files(self) -> list[Path]:
        """Everything written or used so far, in order."""
        return list(dict.fromkeys(self._written))

    def run(self, parameters: Parameters, t_end: float, **options: Any) -> xr.Dataset:
        """Return a run from a random start, made or found; see `kept_run`."""
        dataset = kept_run(self.root / "runs", parameters, t_end, **options)
        self._written.append(Path(dataset.encoding["source"]))
        return dataset

    def sweep(self, name: str, axes: Mapping[str, Any], t_end: float) -> Sweep:
        """Return a sweep in the shared folder ``name``: what is there is not made again.

        Raises
        ------
        KeyboardInterrupt
            If Ctrl-C ended it; what was done is kept.
        """
        from cellcrawl.sweeps import sweep

        found = sweep(axes, self.root / name, t_end=t_end, progress=self.progress)
        if found.interrupted:
            raise KeyboardInterrupt
        return found

    def data(self, name: str, dataset: xr.Dataset) -> None:
        """Write what a picture shows as netCDF."""
        self._write(f"{name}.nc", lambda path: dataset.to_netcdf(path, engine="h5netcdf", mode="w"))

    def table(self, name: str, columns: Mapping[str, Any]) -> None:
        """Write what a picture shows as CSV: named columns of one length."""

        def write(path: Path) -> None:
            with path.open("w", newline="", encoding="utf-8") as file:
                rows = csv.writer(file)
                rows.writerow(columns)
                rows.writerows(zip(*columns.values(), strict=True))

        self._write(f"{name}.csv", write)

    def picture(self, figure: Figure, name: str = "") -> None:
        """Write a figure in every format."""
        for suffix in self.formats:

            def write(path: Path, suffix: str = suffix) -> None:
                figure.savefig(path, format=suffix, dpi=self.dpi)

            self._write(f"{name or self.name}.{suffix}", write)

    def movie(self, dataset: xr.Dataset, **options: Any) -> None:
        """Film a run."""
        from cellcrawl.movies import movie

        target = self._target(f"{self.name}.mp4")
        movie(dataset, target, progress=self.progress, **options)
        self._written.append(target)

    def finish(self, record: Mapping[str, Any]) -> Path:
        """Write the record of a finished recipe, with the size of each of its files."""
        sizes = {os.path.relpath(path, self.root): path.stat().st_size for path in self.files}
        text = json.dumps({**record, "files": sizes}, indent=2)
        self._write(_RECORD, lambda path: path.write_text(text + "\n", encoding="utf-8"))
        return self.folder / _RECORD

    def finished(self, identity: str) -> dict[str, Any] | None:
        """Return the record of the finished recipe if it is this one and its files are there."""
        try:
            record: Any = json.loads((self.folder / _RECORD).read_text("utf-8"))
            same = record["identity"] == identity and all(
                (self.root / path).stat().st_size == size for path, size in record["files"].items()
            )
        except (OSError, ValueError, KeyError, TypeError, AttributeError):
            return None
        return record if same else None

    def _target(self, name: str) -> Path:
        try:
            self.folder.mkdir(parents=True, exist_ok=True)
        except OSError as error:
            raise StorageError(
                f"cannot make the folder {self.folder}: {error.strerror or error}"
            ) from None
        return self.folder / name

    def _write(self, name: str, write: Callable[[Path], Any]) -> None:
        """Write a file under another name and rename it when it is complete."""
        target = self._target(name)
        unfinished = target.with_name(f".{target.name}.{os.getpid()}.part")
        try:
            write(unfinished)
            unfinished.replace(target)
        except OSError as error:
            raise StorageError(f"cannot write {target}: {error.strerror or error}") from None
        finally:
            unfinished.unlink(missing_ok=True)
        self._written.append(target)
