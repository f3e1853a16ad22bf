"""Outlines of cells: what every reader of shapes returns, and their dataset by track and frame."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import overload

import numpy as np
import xarray as xr

from cellcrawl.errors import InputError
from cellcrawl.microscopy.grouping import tracks_of_records
from cellcrawl.microscopy.polygons import area_of, centroid_of, equally_spaced
from cellcrawl.microscopy.source import UNTOLD, LeftOut, Source, listed
from cellcrawl.microscopy.track import Tracks

NODES = 128


@dataclass(frozen=True, eq=False)
class Outline:
    """The outline of one cell at one time.

    Attributes
    ----------
    xy : ndarray, shape (points, 2)
        Vertices in order, the first not repeated, in the coordinates of the file.
    track : str
        Id of the cell; outlines of one cell over time share it.
    frame : int
        Number of the frame.
    t : float
        Its time; the frame's number where nobody gave a frame interval.
    length_units, time_units : str
        Names of the units, "" where nobody said.
    y_down : bool
        Whether y points down, as in an image.
    changes : tuple of str
        What was done to make one simple polygon of it (pieces dropped, holes filled).
    source : Source
        The file and how it was understood.
    """

    xy: np.ndarray
    track: str = ""
    frame: int = 0
    t: float = 0.0
    length_units: str = ""
    time_units: str = ""
    y_down: bool = False
    changes: tuple[str, ...] = ()
    source: Source = UNTOLD

    @property
    def area(self) -> float:
        """Area enclosed, positive."""
        return abs(area_of(self.xy))

    @property
    def centroid(self) -> np.ndarray:
        """Centroid of the area, shape (2,)."""
        return centroid_of(self.xy)

    def __array__(self, dtype: object = None, copy: bool | None = None) -> np.ndarray:
        return np.array(self.xy, dtype=dtype or float)  # type: ignore[call-overload, no-any-return]

    def __repr__(self) -> str:
        return f"<Outline of {self.track!r} at frame {self.frame}: {len(self.xy)} points>"


class Outlines(Sequence[Outline]):
    """Outlines of cells over time: a sequence of `Outline`, in the order of track and frame.

    Parameters
    ----------
    outlines : sequence of Outline
    source : Source
        How the file was understood.
    left_out : tuple of LeftOut
        What was not taken, with the reason.
    """

    def __init__(
        self,
        outlines: Sequence[Outline],
        source: Source = UNTOLD,
        left_out: tuple[LeftOut, ...] = (),
    ) -> None:
        self._outlines = tuple(outlines)
        self.source = source
        self.left_out = left_out

    @overload
    def __getitem__(self, which: int) -> Outline: ...
    @overload
    def __getitem__(self, which: slice) -> Outlines: ...
    def __getitem__(self, which: int | slice) -> Outline | Outlines:
        if isinstance(which, slice):
            return Outlines(self._outlines[which], self.source, self.left_out)
        return self._outlines[which]

    def __len__(self) -> int:
        return len(self._outlines)

    def __iter__(self) -> Iterator[Outline]:
        return iter(self._outlines)

    def __repr__(self) -> str:
        return f"<Outlines: {len(self)} of {len(self.track_ids)} tracks, {self.source.format}>"

    @cached_property
    def track_ids(self) -> tuple[str, ...]:
        """Ids of the cells, in the order of their first outline."""
        return tuple(dict.fromkeys(outline.track for outline in self))

    def of_track(self, track: str) -> Outlines:
        """Return the outlines of one cell, in the order of frames."""
        chosen = [outline for outline in self if outline.track == track]
        if not chosen:
            raise InputError(f"there is no track {track!r} among these {len(self.track_ids)}")
        return Outlines(sorted(chosen, key=lambda outline: outline.frame), self.source)

    @cached_property
    def tracks(self) -> Tracks:
        """The paths of the centroids, as `read_tracks` returns them.

        Raises
        ------
        InputError
            If no cell has outlines in two frames or more.
        """
        places = {track: place for place, track in enumerate(self.track_ids)}
        codes = np.array([places[outline.track] for outline in self], np.int64)
        t = np.array([outline.t for outline in self], float)
        x, y = np.array([outline.centroid for outline in self]).reshape(-1, 2).T
        return tracks_of_records(codes, self.track_ids, t, x, y, self.source, self.left_out)

    @cached_property
    def dataset(self) -> xr.Dataset:
        """The whole by track and frame, with `NODES` nodes an outline; see `to_dataset`."""
        return self.to_dataset()

    def to_dataset(self, nodes: int = NODES) -> xr.Dataset:
        """Return the outlines as one Dataset by track, frame and node.

        Parameters
        ----------
        nodes : int
            Points along each outline.

        Returns
        -------
        Dataset
            Dimensions ``track``, ``frame``, ``node``. Coordinates ``track`` (ids), ``frame``
            (numbers) and ``time`` (track, frame). Variables ``x``, ``y`` (track, frame, node):
            points equally spaced in arclength, turning from x towards y (a positive area in the
            file's coordinates); ``area``, ``length``, ``centroid_x``, ``centroid_y`` (track,
            frame), of the polygon as it was read. NaN where a cell has no outline. Attributes
            ``length_units``, ``time_units``, ``y_down`` (0 or 1), ``source`` and ``path``.
        """
        places = {track: place for place, track in enumerate(self.track_ids)}
        frames = sorted({outline.frame for outline in self})
        columns = {frame: place for place, frame in enumerate(frames)}
        shape = (len(places), len(frames))
        edge = np.full((*shape, nodes, 2), math.nan)
        whole = {name: np.full(shape, math.nan) for name in (*_WHOLE, "time")}
        for outline in self:
            at = places[outline.track], columns[outline.frame]
            edge[at] = equally_spaced(outline.xy, nodes)
            sides = np.roll(outline.xy, -1, axis=0) - outline.xy
            whole["time"][at] = outline.t
            whole["area"][at] = outline.area
            whole["length"][at] = float(np.hypot(*sides.T).sum())
            whole["centroid_x"][at], whole["centroid_y"][at] = outline.centroid
        length, time = self.source.length_units, self.source.time_units
        by_node, by_frame = ("track", "frame", "node"), ("track", "frame")
        variables = {
            "x": (by_node, edge[..., 0], {"long_name": "edge x", "units": length}),
            "y": (by_node, edge[..., 1], {"long_name": "edge y", "units": length}),
        } | {
            name: (by_frame, whole[name], {"long_name": told, "units": length + power})
            for name, (told, power) in _WHOLE.items()
        }
        coordinates = {
            "track": np.array(self.track_ids, dtype=object),
            "frame": np.array(frames, dtype=np.int64),
            "time": (by_frame, whole["time"], {"long_name": "time", "units": time}),
        }
        attributes = {
            "kind": "outlines",
            "length_units": length,
            "time_units": time,
            "y_down": int(self.source.y_down),
            "source": self.source.format,
            "path": self.source.path,
        }
        return xr.Dataset(variables, coordinates, attributes)

    def lines(self) -> list[str]:
        """Return what was read and what was left out and why, in a few lines."""
        frames = len({outline.frame for outline in self})
        count = f"{len(self)} outlines, {len(self.track_ids)} cells, {frames} frames"
        changed = [outline for outline in self if outline.changes]
        told = [f"{changed[0]!r}: {', '.join(changed[0].changes)}"] if changed else []
        if len(changed) > 1:
            told = [f"{len(changed)} outlines were changed; the first, {told[0]}"]
        return [*self.source.lines(), count, *told, *listed(self.left_out)]

    def summary(self) -> str:
        """Return `lines` as one text."""
        return "\n".join(self.lines())


_WHOLE = {
    "area": ("area", "^2"),
    "length": ("length of the outline", ""),
    "centroid_x": ("centroid x", ""),
    "centroid_y": ("centroid y", ""),
}
