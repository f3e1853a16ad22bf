"""The one door for tracks: whatever the file is, recognised by its content."""

from __future__ import annotations

from collections.abc import Mapping
from os import PathLike
from pathlib import Path
from typing import Any

from cellcrawl.errors import InputError
from cellcrawl.microscopy.options import Reading
from cellcrawl.microscopy.table_tracks import read_table_tracks
from cellcrawl.microscopy.track import Tracks


def read_tracks(
    path: str | PathLike[str],
    *,
    columns: str | Mapping[str, str | int] | None = None,
    frame_interval: Any = None,
    pixel_size: Any = None,
    image_coordinates: bool | None = None,
) -> Tracks:
    """Read tracks from a file."""
    reading = Reading.of(columns, frame_interval, pixel_size, image_coordinates)
    file = Path(path)
    if not file.exists():
        raise InputError(f"there is no file {file}")
    return read_table_tracks(file, reading)
