"""The folder of a sweep as its driver sees it: whose it is, what is done, what was under way."""

from __future__ import annotations

import contextlib
import hashlib
import json
import os
import uuid
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from cellcrawl.arguments import file_path
from cellcrawl.errors import InputError, StorageError
from cellcrawl.locks import is_locked, locked
from cellcrawl.sweeps.grid import Grid
from cellcrawl.sweeps.identity import code_version
from cellcrawl.sweeps.journal import read_journal
from cellcrawl.sweeps.layout import Layout
from cellcrawl.sweeps.parts import (
    NOT_RUN,
    SUFFIX,
    cannot_write,
    find_part,
    merge_parts,
    read_part,
    write_part,
)

if TYPE_CHECKING:
    import pyarrow as pa

MANIFEST_SCHEMA: Final = 2  # 1, of version 0.1.0, has no checksum
_MANY_PARTS = 8
KEEP: Final = ("rows", "tracks", "fields")


class SweepStore:
    """The files of one sweep.

    Parameters
    ----------
    folder : str or Path
        Where the sweep is or will be.
    """

    def __init__(self, folder: str | Path) -> None:
        self._given = file_path("output", folder)  # as messages name it
        self.folder = self._given.absolute()  # the program may change its folder
        self.layout = Layout(self.folder)

    def exists(self) -> bool:
        """Whether there is a sweep."""
        return self.layout.manifest.exists()

    def manifest(self) -> dict[str, Any]:
        """Return what the folder says of itself.

        Raises
        ------
        InputError
            If there is no sweep.
        StorageError
            If the manifest is damaged, or written by a newer version.
        """
        path, schema = self.layout.manifest, 0
        if not path.exists():
            raise InputError(f"there is no sweep in {self._given}: it has no {path.name}")
        try:
            found = json.loads(path.read_text("utf-8"))
            schema = int(found["schema"])
            told = found.pop("checksum", None)
            known = {"grid", "digest", "keep", "code", "runs"} <= set(found)
            whole = known and (checksum(found) == told if schema > 1 else told is None)
            reason = "its content is not what its checksum says"
        except (OSError, ValueError, KeyError, TypeError) as error:
            whole, reason = False, type(error).__name__
        if not whole and not schema > MANIFEST_SCHEMA:
            raise StorageError(f"{path} is damaged ({reason}): restore it, or give another output")
        if schema > MANIFEST_SCHEMA:
            raise StorageError(
                f"{path} was written by a newer cellcrawl (schema {schema}, this one reads up to "
                f"{MANIFEST_SCHEMA}): update cellcrawl"
            )
        return dict(found)

    def take(self, grid: Grid, keep: str, *, extend: bool) -> None:
        """Make the folder that of ``grid``, or see that it is; nothing there is overwritten.

        Raises
        ------
        InputError
            If the folder is that of another grid, another version or no sweep.
        """
        manifest = {
            "schema": MANIFEST_SCHEMA,
            "code": code_version(),
            "keep": keep,
            "digest": grid.digest,
            "runs": len(grid),
            "grid": grid.describe(),
        }
        if self.exists():
            found = self.manifest()
            if not self._is_the_same(manifest, found, extend):
                self._write_manifest({**found, "grids": [*grids_of(found), grid.describe()]})
            return
        if self.folder.exists() and (not self.folder.is_dir() or any(self.folder.iterdir())):
            raise InputError(f"{self._given} exists and holds no sweep: give another output")
        self._write_manifest(manifest)

    def _is_the_same(self, asked: dict[str, Any], found: dict[str, Any], extend: bool) -> bool:
        if found["code"] != asked["code"]:
            raise InputError(
                f"{self._given} was made by another version of cellcrawl ({found['code']}, this is "
                f"{asked['code']}), whose rows may differ: give another output"
            )
        if found["keep"] != asked["keep"]:
            raise InputError(
                f"{self._given} keeps {found['keep']}, not {asked['keep']}: give another output, "
                f"or keep = {found['keep']!r}"
            )
        same = asked["digest"] == found["digest"] or asked["grid"] in grids_of(found)[1:]
        if not same and not extend:
            raise InputError(
                f"{self._given} holds another grid, of {found['runs']} runs: give another output, "
                "or ask to extend it by this one"
            )
        return same

    def _write_manifest(self, manifest: dict[str, Any]) -> None:
        path = self.layout.manifest
        temporary = path.with_name(f".{path.name}.{os.getpid()}.tmp")
        try:
            path.parent.mkdir(parents=True, exist_ok=True)
            self.layout.work.mkdir(exist_ok=True)
            sealed = {**manifest, "checksum": checksum(manifest)}
            temporary.write_text(json.dumps(sealed, indent=1) + "\n", "utf-8")
            temporary.replace(path)
        except OSError as error:
            with contextlib.suppress(OSError):
                temporary.unlink(missing_ok=True)
            raise cannot_write(path, error) from None

    def note_refinement(self, axes: Sequence[str], levels: int) -> None:
        """Say in the manifest that rows between the grid's points belong here too."""
        manifest = self.manifest()
        noted = {"refined": list(axes), "levels": levels}
        if {name: manifest.get(name) for name in noted} != noted:
            self._write_manifest({**manifest, **noted})

    def parts(self) -> list[Path]:
        """Return the files of rows, in order of name."""
        rows = self.layout.rows
        if not rows.is_dir():
            return []
        return sorted(path for path in rows.glob(f"*{SUFFIX}") if not path.name.startswith("."))

    def tables(self, columns: Sequence[str] | None = None) -> Iterator[pa.Table]:
        """Yield the rows file by file; those merged meanwhile are read where they are then."""
        read: set[str] = set()
        while unread := [path for path in self.parts() if path.name not in read]:
            for path in unread:
                with contextlib.suppress(FileNotFoundError):
                    yield read_part(path, columns)
                read.add(path.name)

    def finished(self, *, retry: bool = False) -> set[str]:
        """Return the keys of the runs that have a row; with ``retry``, of those with a result."""
        keys: set[str] = set()
        for table in self.tables(("key", "status") if retry else ("key",)):
            found = table["key"].to_pylist()
            if retry:
                statuses = table["status"].to_pylist()
                found = [
                    key
                    for key, status in zip(found, statuses, strict=True)
                    if status not in NOT_RUN
                ]
            keys.update(found)
        return keys

    def merge(self, name: str) -> None:
        """Make one file of many; killed in between, it leaves rows twice, which readers notice."""
        parts = self.parts()
        if len(parts) > _MANY_PARTS:
            merge_parts(self.layout.part(name), parts)
            for path in parts:
                path.unlink(missing_ok=True)

    def recover(self, name: str, *, rows_count: bool) -> tuple[int, dict[str, int]]:
        """Turn what a dead worker's journal holds into a part.

        Returns the number of rows, and the keys begun and not finished with how often. Without
        ``rows_count`` the rows are dropped: what they keep went with the worker.
        """
        path = self.layout.journal(name)
        entries = read_journal(path)
        rows = entries.rows if rows_count else []
        if rows and find_part(self.layout.part(name)) is None:
            write_part(self.layout.part(name), rows)
        path.unlink(missing_ok=True)
        return len(rows), dict(entries.unfinished)

    def recover_all(self, own: str, *, rows_count: bool) -> None:
        """Take up what killed drivers and workers left, but for drivers still at work.

        ``own`` is the lock this driver holds.
        """
        for path in sorted(self.layout.work.glob("*.jsonl")):
            driver = path.stem.rpartition("-")[0]
            if driver == own or not is_locked(self.layout.lock(driver)):
                self.recover(path.stem, rows_count=rows_count)
        for path in self.layout.work.glob(f"halt-{own}-*"):
            path.unlink(missing_ok=True)

    def locked(self, name: str) -> contextlib.AbstractContextManager[None]:
        """Hold the lock of a driver; the system lets go of it when the process dies.

        Raises
        ------
        InputError
            If another process holds it.
        """
        return locked(self.layout.lock(name), self.folder)

    def is_locked(self) -> bool:
        """Whether a driver is at work on the folder."""
        return any(is_locked(path) for path in self.layout.work.glob("*.lock"))


def grids_of(manifest: dict[str, Any]) -> list[dict[str, Any]]:
    """Return the grids of a folder, described: the first, and those it was extended by."""
    return list(manifest.get("grids", [manifest["grid"]]))


def new_name(driver: str) -> str:
    """Return a name for files that no other driver gives."""
    return f"{driver}-{uuid.uuid4().hex[:12]}"


def checksum(manifest: dict[str, Any]) -> str:
    """Return a hash of what a folder says of itself."""
    content = json.dumps(manifest, sort_keys=True).encode()
    return hashlib.blake2b(content, digest_size=16).hexdigest()
