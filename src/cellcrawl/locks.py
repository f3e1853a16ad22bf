"""Locks on folders: of several processes one works there, and a dead one holds nothing."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from cellcrawl.errors import InputError, StorageError


def try_lock(file: Any) -> bool:
    """Lock an open file until it is closed or the process dies; False if another one holds it."""
    try:
        import fcntl
    except ImportError:  # no such locks on this system: trust the user
        return True
    try:
        fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        return False
    except OSError:  # a file system without locks
        return True
    return True


@contextmanager
def locked_folder(folder: Path, name: str) -> Iterator[None]:
    """Hold the lock ``folder/name``; the folder is made if it is missing.

    Raises
    ------
    InputError
        If another process holds it.
    StorageError
        If the folder cannot be made or written.
    """
    try:
        folder.mkdir(parents=True, exist_ok=True)
        file = (folder / name).open("a")
    except OSError as error:
        raise StorageError(f"cannot write in {folder}: {error.strerror or error}") from None
    with file:
        if not try_lock(file):
            raise InputError(
                f"another process is at work on {folder} ({name} is held): wait for it, or give "
                "another output"
            )
        yield
