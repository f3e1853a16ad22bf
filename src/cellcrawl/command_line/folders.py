"""What a path given on the command line holds: a run, the folder of a run, or a sweep."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from cellcrawl.arguments import file_path
from cellcrawl.errors import InputError

if TYPE_CHECKING:
    from cellcrawl.sweeps import Sweep

_USUAL = ("run.nc", "run.zarr")
_SUFFIXES = (".nc", ".zarr")


def run_in(path: Path) -> Path:
    """Return the run that ``path`` is, or the one that the folder ``path`` holds.

    Raises
    ------
    InputError
        For a folder without a run, or with several of which none is ``run.nc``.
    """
    file_path("FILE", path)
    if not path.suffix and not path.exists():
        raise InputError(f"there is no file or folder {path}")
    if not path.is_dir() or path.suffix in (*_SUFFIXES, ".part"):
        return path
    names = {
        entry.name.removesuffix(".part")
        for entry in path.iterdir()
        if entry.name.removesuffix(".part").endswith(_SUFFIXES) and entry.name[0] != "."
    }
    usual = [name for name in _USUAL if name in names]
    if usual or len(names) == 1:
        return path / (usual or list(names))[0]
    if names:
        listed = ", ".join(sorted(names)[:5]) + (", ..." if len(names) > 5 else "")
        raise InputError(f"{path} holds {len(names)} runs: give one of {listed}")
    raise InputError(f"{path} holds no run: a run is a .nc file or a .zarr folder")


def sweep_in(path: Path) -> Sweep | None:
    """Return the sweep in the folder ``path``, or None if it is no folder of one."""
    from cellcrawl.sweeps import open_sweep
    from cellcrawl.sweeps.layout import Layout

    file_path("FILE", path)
    return open_sweep(path) if Layout(path).manifest.is_file() else None
