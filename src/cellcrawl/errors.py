"""The errors a user can meet. Each is one line that says what is wrong and how to mend it."""

from __future__ import annotations

import difflib
import errno
from collections.abc import Iterable

_LONGEST_LIST = 400  # characters of names in a message: matplotlib has 180 colour maps


class CellcrawlError(Exception):
    """Anything cellcrawl raises on purpose."""

    def __str__(self) -> str:
        """Return the message as one line: names of files and values may hold line breaks."""
        return super().__str__().replace("\n", "\\n").replace("\r", "\\r")


class InputError(CellcrawlError, ValueError):
    """A value the user gave cannot be used; the message names it and says what is allowed."""


class StorageError(CellcrawlError, OSError):
    """A run could not be written or read; the message says where the data is."""


class MissingExtraError(CellcrawlError, ImportError):
    """An optional dependency is needed; the message says which extra installs it."""


class OutlineChangedWarning(UserWarning):
    """An outline was changed so that the model can hold it; the message says how."""


def what_would_help(error: OSError, reason: str = "") -> str:
    """Return when a write that failed can succeed: "once there is room" only for a full disk.

    ``reason`` is the system's word for it, where ``error`` has no number.
    """
    full = (
        error.errno in (errno.ENOSPC, getattr(errno, "EDQUOT", None))
        or "space" in reason
        or "quota" in reason
    )
    return "once there is room" if full else "once it can be written"


def nearest_name(name: object, known: Iterable[str]) -> str:
    """Return ``did you mean 'x'?`` for a misspelt name, or the list of what exists.

    Case does not count: ``d`` is nearest to ``D``.
    """
    known = sorted(known)
    close = close_name(name, known)
    if close:
        return f"did you mean {close!r}?"
    told = ", ".join(known)
    if len(told) > _LONGEST_LIST:
        few = told[:_LONGEST_LIST].rpartition(", ")[0]
        told = f"{few} and {len(known) - few.count(', ') - 1} more"
    return f"known names: {told}"


def close_name(name: object, known: Iterable[str]) -> str | None:
    """Return the one of ``known`` that a misspelt name is close to, None if there is none."""
    plain = {word.casefold(): word for word in known}
    text = name.casefold() if isinstance(name, str) else ""
    close = difflib.get_close_matches(text[:80], plain, n=1, cutoff=0.5)
    return plain[close[0]] if close else None
