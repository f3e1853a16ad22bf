"""Tracks and outlines that people bring: read, written, and made from runs.

Needs NumPy, xarray and PyArrow; neither a solver nor a compiler.
"""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING, Any

from cellcrawl.microscopy.source import LeftOut, Source
from cellcrawl.microscopy.track import Track, Tracks

if TYPE_CHECKING:
    from cellcrawl.microscopy.observation import Observation as Observation
    from cellcrawl.microscopy.observation import observe as observe
    from cellcrawl.microscopy.outlines import Outline as Outline
    from cellcrawl.microscopy.outlines import Outlines as Outlines
    from cellcrawl.microscopy.read import read_outlines as read_outlines
    from cellcrawl.microscopy.read import read_tracks as read_tracks
    from cellcrawl.microscopy.writing_outlines import OUTLINE_FORMS as OUTLINE_FORMS
    from cellcrawl.microscopy.writing_outlines import write_outlines as write_outlines
    from cellcrawl.microscopy.writing_tracks import TRACK_FORMS as TRACK_FORMS
    from cellcrawl.microscopy.writing_tracks import write_tracks as write_tracks

# Readers lean on PyArrow, which takes a while to load: only when they are asked for.
_HOMES = {
    "OUTLINE_FORMS": "writing_outlines",
    "Observation": "observation",
    "Outline": "outlines",
    "Outlines": "outlines",
    "TRACK_FORMS": "writing_tracks",
    "observe": "observation",
    "read_outlines": "read",
    "read_tracks": "read",
    "write_outlines": "writing_outlines",
    "write_tracks": "writing_tracks",
}

__all__ = [*_HOMES, "LeftOut", "Source", "Track", "Tracks"]


def __getattr__(name: str) -> Any:
    if name not in _HOMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    module = importlib.import_module(f"cellcrawl.microscopy.{_HOMES[name]}")
    value = globals()[name] = getattr(module, name)
    return value
