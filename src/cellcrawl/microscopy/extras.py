"""Readers of others that are used where they are installed."""

from __future__ import annotations

import importlib
from typing import Any

from cellcrawl.errors import MissingExtraError


def reader(module: str, form: str) -> Any:
    """Return a module of the extra "microscopy", or say which command installs it.

    Parameters
    ----------
    module : str
        Its name.
    form : str
        What it reads, for the message.
    """
    try:
        return importlib.import_module(module)
    except ImportError:
        raise MissingExtraError(
            f"{form} need the package {module}: pip install 'cellcrawl[microscopy]'"
        ) from None
