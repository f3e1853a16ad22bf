"""Where the files of a sweep are."""

from __future__ import annotations

from pathlib import Path
from typing import NamedTuple


class Layout(NamedTuple):
    """The folder of a sweep.

    ``sweep.json`` says which grid it is; ``rows/*.parquet`` has one row a run; ``runs/*.nc`` what
    was kept of the runs; ``work`` what workers have under way.
    """

    folder: Path

    @property
    def manifest(self) -> Path:
        """The grid and the version that made it."""
        return self.folder / "sweep.json"

    @property
    def rows(self) -> Path:
        """The folder of rows."""
        return self.folder / "rows"

    @property
    def work(self) -> Path:
        """The folder of journals and locks."""
        return self.folder / "work"

    def part(self, name: str) -> Path:
        """The rows of a chunk, before their checksum is known; see `cellcrawl.sweeps.parts`."""
        return self.rows / f"{name}.parquet"

    def kept(self, name: str) -> Path:
        """What is kept of the runs of a chunk."""
        return self.folder / "runs" / f"{name}.nc"

    def journal(self, name: str) -> Path:
        """The journal of a chunk at work."""
        return self.work / f"{name}.jsonl"

    def halt(self, name: str) -> Path:
        """The file that asks the workers of a driver to stop."""
        return self.work / f"halt-{name}"

    def lock(self, name: str) -> Path:
        """The lock that a driver holds."""
        return self.work / f"{name}.lock"
