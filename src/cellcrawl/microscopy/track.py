"""Tracks of cells: what every reader of positions returns."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Any, overload

import numpy as np

from cellcrawl.errors import InputError
from cellcrawl.microscopy.source import UNTOLD, LeftOut, Source, listed
from cellcrawl.validation import shown


@dataclass(frozen=True, eq=False)
class Track:
    """Positions of one cell over time; the units are those of whoever measured them.

    Attributes
    ----------
    t : ndarray, shape (record,)
        Times, strictly rising, finite; they need not be even.
    x, y : ndarray, shape (record,)
        Position of the cell at these times, finite, in the coordinates of the file.
    length_units, time_units : str
        Names of the units, "" where nobody said.
    id : str
        The track's name in its file; "" for the only track of a file without ids.
    parent : str
        Id of the track this one split from, "" if none is known.
    y_down : bool
        Whether y points down, as in an image: then a track that turns from x towards y, which has
        a positive turning rate, is seen on the screen to turn right.
    source : Source
        The file and how it was understood.
    """

    t: np.ndarray
    x: np.ndarray
    y: np.ndarray
    length_units: str = ""
    time_units: str = ""
    id: str = ""
    parent: str = ""
    y_down: bool = False
    source: Source = UNTOLD

    @property
    def duration(self) -> float:
        """Time from the first record to the last."""
        return float(self.t[-1] - self.t[0])

    def at(self, t: np.ndarray, x: np.ndarray, y: np.ndarray) -> Track:
        """Return the same cell at other times and positions."""
        return Track(
            t,
            x,
            y,
            self.length_units,
            self.time_units,
            self.id,
            self.parent,
            self.y_down,
            self.source,
        )

    def __len__(self) -> int:
        return int(self.t.size)

    def __repr__(self) -> str:
        name = f" {self.id!r}" if self.id else ""
        return f"<Track{name}: {len(self)} records>"


class Tracks(Sequence[Track]):
    """Tracks of one or more files; a sequence of `Track`, kept as columns so that 10⁵ fit.

    Parameters
    ----------
    t, x, y : ndarray, shape (records,)
        Records of all tracks, those of one track together and in the order of time.
    starts : ndarray of int, shape (tracks + 1,)
        Where each track begins, and the end.
    ids : sequence of str
        One a track, all different.
    source : Source
        How the file was understood.
    left_out : tuple of LeftOut
        Tracks and rows that were not taken, with the reason.
    parents : mapping of str to str
        Id of the track that another one split from.
    """

    def __init__(
        self,
        t: np.ndarray,
        x: np.ndarray,
        y: np.ndarray,
        starts: np.ndarray,
        ids: Sequence[str],
        source: Source = UNTOLD,
        left_out: tuple[LeftOut, ...] = (),
        parents: dict[str, str] | None = None,
    ) -> None:
        for column in (t, x, y, starts):
            column.setflags(write=False)
        self.t, self.x, self.y, self.starts = t, x, y, starts
        self.ids = tuple(ids)
        self.source = source
        self.left_out = left_out
        self.parents = dict(parents or {})
        self._places = {name: place for place, name in enumerate(self.ids)}

    @classmethod
    def of(cls, tracks: Iterable[Any], source: Source | None = None) -> Tracks:
        """Return a `Tracks` of single tracks, anything with ``t``, ``x`` and ``y``.

        Ids that are missing or repeated become numbers, so that no two cells share one.
        """
        try:
            given = list(tracks)
        except Exception:
            raise InputError(f"tracks must be a list of tracks, not {shown(tracks)}") from None
        for track in given:
            if not all(hasattr(track, name) for name in ("t", "x", "y")):
                raise InputError(f"a track has t, x and y, and {shown(track)} has not")
        first = given[0] if given else None
        told = getattr(first, "source", UNTOLD)
        source = source or (_source_of(first) if told is UNTOLD else told)
        ids = [str(getattr(track, "id", "")) for track in given]
        if len(set(ids)) < len(ids):
            ids = [str(number) for number in range(len(ids))]
        sizes = [len(track.t) for track in given]
        starts = np.concatenate([[0], np.cumsum(sizes)]).astype(np.int64)
        t, x, y = (
            np.concatenate([np.asarray(getattr(track, name), float) for track in given])
            if given
            else np.empty(0)
            for name in ("t", "x", "y")
        )
        parents = {
            name: track.parent
            for name, track in zip(ids, given, strict=True)
            if getattr(track, "parent", "")
        }
        return cls(t, x, y, starts, ids, source, parents=parents)

    @overload
    def __getitem__(self, which: int | str) -> Track: ...
    @overload
    def __getitem__(self, which: slice) -> Tracks: ...
    def __getitem__(self, which: int | str | slice) -> Track | Tracks:
        """Return a track by place or by id, or some of them by a slice."""
        if isinstance(which, slice):
            chosen = Tracks.of([self[place] for place in range(len(self))[which]], self.source)
            chosen.left_out = self.left_out
            return chosen
        if isinstance(which, str):
            if which not in self._places:
                raise InputError(f"there is no track {which!r} among these {len(self)}")
            which = self._places[which]
        place = range(len(self))[which]  # an IndexError for a place beyond the end
        part = slice(int(self.starts[place]), int(self.starts[place + 1]))
        name, source = self.ids[place], self.source
        return Track(
            self.t[part],
            self.x[part],
            self.y[part],
            source.length_units,
            source.time_units,
            name,
            self.parents.get(name, ""),
            source.y_down,
            source,
        )

    def __len__(self) -> int:
        return len(self.ids)

    def __iter__(self) -> Iterator[Track]:
        return (self[place] for place in range(len(self)))

    def __repr__(self) -> str:
        return f"<Tracks: {len(self)} tracks, {self.t.size} records, {self.source.format}>"

    def lines(self) -> list[str]:
        """Return what was read and what was left out and why, in a few lines."""
        sizes = np.diff(self.starts)
        count = f"{len(self)} track{'s' if len(self) != 1 else ''}"
        if sizes.size:
            span = f"{sizes.min()} to {sizes.max()}" if sizes.min() < sizes.max() else f"{sizes[0]}"
            count += f" of {span} records"
        return [*self.source.lines(), count, *listed(self.left_out)]

    def summary(self) -> str:
        """Return `lines` as one text."""
        return "\n".join(self.lines())

    def with_source(self, **changes: Any) -> Tracks:
        """Return the same tracks with fields of their `Source` changed."""
        return Tracks(
            self.t,
            self.x,
            self.y,
            self.starts,
            self.ids,
            replace(self.source, **changes),
            self.left_out,
            self.parents,
        )


def _source_of(track: Any) -> Source:
    return Source(
        length_units=getattr(track, "length_units", ""),
        time_units=getattr(track, "time_units", ""),
        y_down=getattr(track, "y_down", False),
    )
