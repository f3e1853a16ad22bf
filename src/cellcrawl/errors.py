"""The errors a user can meet. Each is one line that says what is wrong and how to mend it."""

from __future__ import annotations

import difflib
from collections.abc import Iterable


class CellcrawlError(Exception):
    """Anything cellcrawl raises on purpose."""


class InputError(CellcrawlError, ValueError):
    """A value the user gave cannot be used; the message names it and says what is allowed."""


class StorageError(CellcrawlError, OSError):
    """A run could not be written or read; the message says where the data is."""


class MissingExtraError(CellcrawlError, ImportError):
    """An optional dependency is needed; the message says which extra installs it."""


class OutlineChangedWarning(UserWarning):
    """An outline was changed so that the model can hold it; the message says how."""


def nearest_name(name: object, known: Iterable[str]) -> str:
    """Return ``did you mean 'x'?`` for a misspelt name, or the list of what exists.

    Case does not count: ``d`` is nearest to ``D``.
    """
    known = sorted(known)
    plain = {word.casefold(): word for word in known}
    text = name.casefold() if isinstance(name, str) else ""
    close = [plain[word] for word in difflib.get_close_matches(text[:80], plain, n=1, cutoff=0.5)]
    if close:
        return f"did you mean {close[0]!r}?"
    return f"known names: {', '.join(known)}"
