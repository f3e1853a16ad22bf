"""Tracks and outlines that people bring: read, written, and made from runs.

Needs NumPy, xarray and PyArrow; neither a solver nor a compiler.
"""

from cellcrawl.microscopy.outlines import Outline, Outlines
from cellcrawl.microscopy.read import read_outlines, read_tracks
from cellcrawl.microscopy.source import LeftOut, Source
from cellcrawl.microscopy.track import Track, Tracks

__all__ = [
    "LeftOut",
    "Outline",
    "Outlines",
    "Source",
    "Track",
    "Tracks",
    "read_outlines",
    "read_tracks",
]
