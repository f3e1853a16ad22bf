"""Locks on files and folders: of several processes one writes, and a dead one holds nothing."""

from __future__ import annotations

import contextlib
import errno
import time
import warnings
from collections.abc import Iterator
from pathlib import Path

from filelock import FileLock, Timeout

from cellcrawl.errors import InputError, StorageError

_TRIES = 3  # a holder that lets go removes its file: look again before calling it held
_PAUSE = 0.02
_NO_LOCKS = (errno.ENOLCK, errno.ENOSYS, errno.EOPNOTSUPP)


@contextlib.contextmanager
def locked(path: Path, target: Path, *, remove: bool = False) -> Iterator[None]:
    """Hold the lock file ``path``; its folder is made if it is missing.

    Parameters
    ----------
    path : Path
        The lock file.
    target : Path
        What it keeps others from, for the message.
    remove : bool
        Delete the lock file at the end, so that nothing but the results is left.

    Raises
    ------
    InputError
        If another process, or another thread of this one, holds it.
    StorageError
        If it cannot be written.
    """
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        lock = _taken(path)
    except OSError as error:
        if error.errno not in _NO_LOCKS:
            raise StorageError(
                f"cannot write in {path.parent}: {error.strerror or error}"
            ) from None
        warnings.warn(
            f"the file system of {path.parent} has no locks: see to it that no other process "
            f"writes {target}",
            stacklevel=3,
        )
        yield
        return
    if lock is None:
        raise InputError(
            f"another process is at work on {target} ({path.name} is held): wait for it, or give "
            "another output"
        )
    try:
        yield
    finally:
        if remove:
            # Held still, so that whoever opened the file meanwhile notices that it is gone.
            with contextlib.suppress(OSError):
                path.unlink(missing_ok=True)
        lock.release()


def is_locked(path: Path) -> bool:
    """Whether a process holds the lock file ``path``."""
    if not path.exists():
        return False
    try:
        lock = _taken(path)
    except OSError:  # not ours to write: look only
        return False
    if lock is None:
        return True
    lock.release()
    return False


def _taken(path: Path) -> FileLock | None:
    """Return the lock, held, or None if another has it."""
    for attempt in range(_TRIES):
        if attempt:
            time.sleep(_PAUSE)
        lock = FileLock(path, timeout=0, thread_local=False)
        with contextlib.suppress(Timeout):
            lock.acquire()
            return lock
    if not path.exists():
        path.touch()  # nobody holds it: says why it cannot be there
    return None
