"""What a caller may say about a file: columns, frame interval, pixel size, which way y points."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from cellcrawl.errors import InputError
from cellcrawl.microscopy.columns import length_unit, time_unit
from cellcrawl.microscopy.source import Source
from cellcrawl.validation import real_number, shown

_MEASURE = re.compile(r"\s*([-+0-9.eE]+?)\s*([^\d\s.].*)?\s*")


@dataclass(frozen=True)
class Reading:
    """Options of a reader, checked.

    Attributes
    ----------
    columns : str or mapping, optional
        Which column is what; see `cellcrawl.microscopy.columns.chosen`.
    frame_interval : float, optional
        Time between frames, in ``time_units``.
    pixel_size : float, optional
        Size of a pixel, in ``length_units``.
    image_coordinates : bool, optional
        Whether y points down; that of the form unless given.
    """

    columns: str | Mapping[str, str | int] | None = None
    frame_interval: float | None = None
    time_units: str = ""
    pixel_size: float | None = None
    length_units: str = ""
    image_coordinates: bool | None = None

    @classmethod
    def of(
        cls,
        columns: str | Mapping[str, str | int] | None = None,
        frame_interval: Any = None,
        pixel_size: Any = None,
        image_coordinates: bool | None = None,
    ) -> Reading:
        """Return the options, checked; an interval may be 60, "60 s" or "1 min"."""
        interval, time = _measure("frame_interval", frame_interval)
        size, length = _measure("pixel_size", pixel_size)
        return cls(columns, interval, time_unit(time), size, length_unit(length), image_coordinates)

    def scaled(
        self, source: Source, x: np.ndarray, y: np.ndarray
    ) -> tuple[Source, np.ndarray, np.ndarray]:
        """Return positions in units of length, and the source that tells so.

        Raises
        ------
        InputError
            For a pixel size where the file has a unit of length already.
        """
        if self.image_coordinates is not None:
            source = replace(source, y_down=self.image_coordinates)
        if self.pixel_size is None:
            return source, x, y
        if source.length_units not in ("", "pixel"):
            raise InputError(
                f"{source.path} is in {source.length_units} already: leave the pixel size out"
            )
        source = replace(source, length_units=self.length_units)
        return source, self.pixel_size * x, self.pixel_size * y

    def timed(self, source: Source, frames: np.ndarray) -> tuple[Source, np.ndarray]:
        """Return the times of frames, and the source that tells their unit."""
        if self.frame_interval is None:
            return replace(source, time_units="frame"), frames.astype(float)
        return replace(source, time_units=self.time_units), self.frame_interval * frames

    def without_columns(self, path: str) -> None:
        """Refuse a choice of columns for a form that has none."""
        if self.columns is not None:
            raise InputError(f"{path} is no plain table: leave --columns out")


def _measure(name: str, value: Any) -> tuple[float | None, str]:
    if value is None:
        return None, ""
    unit = ""
    if isinstance(value, str):
        found = _MEASURE.fullmatch(value)
        try:
            if found is None:
                raise ValueError
            value, unit = float(found[1]), found[2] or ""
        except ValueError:
            raise InputError(
                f"{name} = {shown(value)} must be a number, with a unit if you like: 60 or '60 s'"
            ) from None
    return real_number(name, value, 0.0, 1e30, open_low=True), unit
