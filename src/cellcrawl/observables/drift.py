"""Motion that all tracks share: a stage that drifts, or cells that go the same way."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from cellcrawl.arguments import checked
from cellcrawl.errors import InputError
from cellcrawl.microscopy.track import Track, Tracks

_FEWEST = 5  # tracks: as many random directions are seldom alike
_UNLIKELY = 0.01  # chance of independent directions that counts as drift
_SHARE = 0.5  # of the mean square displacement at least
_PARTS = 4


@dataclass(frozen=True, eq=False)
class Drift:
    """The motion that tracks share.

    Attributes
    ----------
    t, x, y : ndarray, shape (time,)
        Times of all records, and how far the tracks have moved together by then.
    share : float
        Part of the mean square displacement that all share, from 0 to 1.
    chance : float
        Probability that as many cells with directions of their own go as much the same way.
    tracks : int
        How many tracks were long enough to tell.
    """

    t: np.ndarray
    x: np.ndarray
    y: np.ndarray
    share: float
    chance: float
    tracks: int

    @property
    def noticed(self) -> bool:
        """Whether the tracks move alike: more than by chance, and for the most part."""
        return self.tracks >= _FEWEST and self.chance < _UNLIKELY and self.share >= _SHARE

    def __str__(self) -> str:
        """Say in a line what was found."""
        if not self.noticed:
            return "the tracks share no motion to speak of"
        far = math.hypot(self.x[-1], self.y[-1])
        way = math.degrees(math.atan2(self.y[-1], self.x[-1]))
        return (
            f"drift: all {self.tracks} tracks share {self.share:.0%} of their motion, "
            f"{far:.3g} along {way:.0f} degrees in all; a stage that drifts does that, "
            "and so do cells that go the same way"
        )


@checked
def shared_drift(tracks: Iterable[Track]) -> Drift:
    """Find the motion that tracks share.

    Parameters
    ----------
    tracks : Tracks or iterable of Track
        Tracks on one clock; frames may be missing.

    Returns
    -------
    Drift

    Raises
    ------
    InputError
        If there are no tracks.

    Notes
    -----
    The drift is the sum of the mean velocity, from each time to the next, of the tracks that are
    seen then. Whether it is one is asked of the directions: of ``N`` tracks with displacements
    ``d`` the number ``|sum d|**2 / sum |d|**2`` is N if all go together, and has an exponential
    distribution of mean 1 if each goes its own way (Rayleigh's test, weighted). It is asked of the
    whole time and of its quarters, so that a stage that swings is found as well. Fewer than five
    tracks cannot tell. Cells that are driven the same way, by a gradient or by each other, share
    motion that is their own: then nothing should be taken off.
    """
    given = _columns(tracks)
    times, path = _mean_path(given)
    first, last = float(times[0]), float(times[-1])
    whole = _alike(given, first, last)
    edges = np.linspace(first, last, _PARTS + 1)
    parts = [_alike(given, *ends) for ends in itertools.pairwise(edges)]
    parts = [part for part in parts if part[2] >= _FEWEST]
    best = whole
    if len(parts) == _PARTS:
        # All quarters but the least alike must speak for it, each on its own.
        weakest = sorted(parts, key=lambda part: part[0])[1]
        best = max(whole, weakest, key=lambda part: part[0])
    score, share, count = best
    return Drift(times, path[0], path[1], share, math.exp(-score), count)


@checked
def without_drift(tracks: Iterable[Track], drift: Drift | None = None) -> Tracks:
    """Return tracks without the motion they share.

    Parameters
    ----------
    tracks : Tracks or iterable of Track
    drift : Drift, optional
        What to take off; `shared_drift` of the tracks unless given.

    Returns
    -------
    Tracks
        With a note on what was taken off.

    Raises
    ------
    InputError
        If there are no tracks.

    Notes
    -----
    The mean motion of few tracks is for a good part their own, ``1/N`` of each: of five tracks a
    fifth of what a cell does is taken from it and from all others.
    """
    given = _columns(tracks)
    found = drift or shared_drift(given)
    x = given.x - np.interp(given.t, found.t, found.x)
    y = given.y - np.interp(given.t, found.t, found.y)
    far = math.hypot(found.x[-1], found.y[-1])
    note = f"the motion shared by {found.tracks} tracks was taken off, {far:.3g} in all"
    notes = (*given.source.notes, note)
    return Tracks(
        given.t, x, y, given.starts, given.ids, given.source, given.left_out, given.parents
    ).with_source(notes=notes)


def _columns(tracks: Iterable[Track]) -> Tracks:
    given = tracks if isinstance(tracks, Tracks) else Tracks.of(tracks)
    if len(given) == 0:
        raise InputError("there are no tracks to look for drift in")
    return given


def _mean_path(tracks: Tracks) -> tuple[np.ndarray, np.ndarray]:
    """Return all times, and how far the mean velocity leads by then, (2, time)."""
    times, place = np.unique(tracks.t, return_inverse=True)
    inside = np.ones(tracks.t.size - 1, dtype=bool)
    inside[tracks.starts[1:-1] - 1] = False  # from the end of one track to the start of the next
    passed = np.diff(tracks.t)[inside]
    rows = np.zeros((3, times.size))
    for row, values in enumerate((tracks.x, tracks.y)):
        rate = np.diff(values)[inside] / passed
        np.add.at(rows[row], place[:-1][inside], rate)
        np.add.at(rows[row], place[1:][inside], -rate)
    np.add.at(rows[2], place[:-1][inside], 1.0)
    np.add.at(rows[2], place[1:][inside], -1.0)
    sums = np.cumsum(rows, axis=1)[:, :-1]
    counts = np.maximum(np.round(sums[2]), 1.0)
    path = np.zeros((2, times.size))
    path[:, 1:] = np.cumsum(sums[:2] / counts * np.diff(times), axis=1)
    return times, path


def _alike(tracks: Tracks, start: float, end: float) -> tuple[float, float, int]:
    """Return how alike tracks go from a time to a time: Rayleigh's number, share, tracks."""
    first, last = tracks.starts[:-1], tracks.starts[1:]
    before, within = (_records_before(tracks, time) for time in (start, end * (1.0 + 1e-12)))
    a, b = first + before, np.minimum(first + within, last - 1)
    long = b > a
    long[long] = tracks.t[b[long]] - tracks.t[a[long]] >= 0.5 * (end - start)
    a, b = a[long], b[long]
    displacements = np.column_stack([tracks.x[b] - tracks.x[a], tracks.y[b] - tracks.y[a]])
    power = float(np.sum(displacements**2))
    if power == 0.0:
        return 0.0, 0.0, a.size
    score = float(np.sum(displacements.sum(axis=0) ** 2)) / power
    return score, score / a.size, a.size


def _records_before(tracks: Tracks, time: float) -> np.ndarray:
    """Return how many records of each track come before a time."""
    passed = np.concatenate([[0], np.cumsum(tracks.t < time)])
    number: np.ndarray = passed[tracks.starts[1:]] - passed[tracks.starts[:-1]]
    return number
