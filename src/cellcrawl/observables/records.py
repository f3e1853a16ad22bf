"""Records that say nothing of the way a cell goes: wild ones, repeats, and those of a pause."""

from __future__ import annotations

import itertools
from dataclasses import dataclass

import numpy as np

from cellcrawl.observables.noise import position_noise
from cellcrawl.observables.short_arrays import median, row_means
from cellcrawl.observables.track import Track

_FEWEST = 8  # records a track keeps at least; below that nothing is left out
_DETOUR = 3.0  # a wild record lies this many median steps off on both sides ...
_FAR = 2.5  # ... and this many times farther than any other step of the track goes
_FAR_AT_END = 5.0  # at an end there is one side only
_BACK = 0.5  # and its neighbours are nearer to each other than this part of the way to it
_IN_A_ROW = 3
_MOST_WILD = 0.1  # of the records: more than that are no mistakes but the motion
_AT_PACE = 0.8  # quantile of the speed that is the speed of a cell on the move
_PAUSE = 2  # repeats inside a track that make a pause
_QUIET = 0.2  # of that speed: slower stretches may be pauses
_KNOWN = 0.07  # noise of a quiet stretch over the way at pace, for which speeds can be told apart
_LONGEST_WINDOW = 6
_WITHIN = 0.5  # of a step at pace: a pause gets no farther
_SCATTER = 3.0  # times the noise


@dataclass(frozen=True, eq=False)
class SoundTrack:
    """A track without the records that have no heading.

    Attributes
    ----------
    track : Track
        What is left: wild records and repeats left out, each pause averaged to one record.
    clock : ndarray, shape (record,)
        Times of these records on a clock that stands still during pauses.
    clean : Track
        The track without its wild records only.
    wild : tuple of int
        Records left out because they lie far off the path, as a wrong link does.
    noise : float
        Error of a position along one axis, of what is left.
    """

    track: Track
    clock: np.ndarray
    clean: Track
    wild: tuple[int, ...]
    noise: float

    @property
    def at_rest(self) -> float:
        """Part of the time spent in pauses."""
        return 1.0 - float(self.clock[-1] - self.clock[0]) / self.track.duration


def sound(track: Track) -> SoundTrack:
    """Leave out what says nothing of the way ahead.

    Notes
    -----
    A position repeated to the last bit is a cell that waits, or one that was lost and filled
    forward: the record says nothing new. In a pause the heading is that of the noise; there all
    records are one position, measured several times. Speeds are told apart from each other, not
    from a length: nothing here has a unit.
    """
    wild = wild_records(track.x, track.y)
    clean = track
    if wild.size:
        kept = np.ones(track.t.size, dtype=bool)
        kept[wild] = False
        clean = _part(track, kept)
    left = _without_repeats(clean)
    noise = position_noise(left)
    moving, clock = _without_pauses(left, noise)
    if moving is not left:
        noise = position_noise(moving)
    return SoundTrack(moving, clock, clean, tuple(wild.tolist()), noise)


def wild_records(x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """Return records far off the path: there and back in leaps like no other step.

    Up to three in a row, inside or at an end; never more than a tenth of the track.
    """
    none = np.zeros(0, dtype=int)
    size = x.size
    if size < _FEWEST:
        return none
    steps = np.hypot(x[1:] - x[:-1], y[1:] - y[:-1])
    ordered = np.sort(steps)
    typical = ordered[int(np.searchsorted(ordered, 0.0, side="right") + size) // 2 - 1]
    if ordered[-1] <= _DETOUR * typical or typical == 0.0:
        return none
    suspects = _there_and_back(x, y, steps, _DETOUR * typical)
    off = np.zeros(size, dtype=bool)
    for first, last in suspects:
        off[first : last + 1] = True
    others = steps[~(off[1:] | off[:-1])]
    if others.size < size // 2:
        return none
    largest = float(others.max())
    found = [
        record
        for first, last in suspects
        if min(steps[first - 1], steps[last]) > _FAR * largest
        for record in range(first, last + 1)
    ]
    found += _at_an_end(steps, found)
    return np.unique(np.array(found, dtype=int)) if 0 < len(found) <= _MOST_WILD * size else none


def _there_and_back(
    x: np.ndarray, y: np.ndarray, steps: np.ndarray, least: float
) -> list[tuple[int, int]]:
    """Return first and last records of stretches that a leap leads to and another leads back."""
    leaps = np.flatnonzero(steps > least).tolist()
    found = []
    for before, after in itertools.pairwise(leaps):
        if after - before <= _IN_A_ROW:
            across = np.hypot(x[after + 1] - x[before], y[after + 1] - y[before])
            if across < _BACK * min(steps[before], steps[after]):
                found.append((before + 1, after))
    return found


def _at_an_end(steps: np.ndarray, inner: list[int]) -> list[int]:
    """Return the first or the last record if the one step to it is like no other."""
    near = np.zeros(steps.size, dtype=bool)
    for record in inner:
        near[record - 1 : record + 1] = True
    found = []
    for end, record in ((0, 0), (-1, steps.size)):
        rest = near.copy()
        rest[end] = True
        if not near[end] and steps[end] > _FAR_AT_END * steps[~rest].max(initial=0.0):
            found.append(record)
    return found


def _without_repeats(track: Track) -> Track:
    """Leave out positions that repeat the one before, short runs and those that end the track.

    Long runs inside are pauses, and time stands still there.
    """
    repeats = (track.x[1:] == track.x[:-1]) & (track.y[1:] == track.y[:-1])
    if not repeats.any():
        return track
    kept = np.concatenate([[True], ~repeats])
    edges = np.flatnonzero(np.diff(np.concatenate([[0], repeats.view(np.int8), [0]])))
    for start, end in zip(edges[::2].tolist(), edges[1::2].tolist(), strict=True):
        if end - start >= _PAUSE and end < repeats.size:
            kept[start + 1 : end + 1] = True
    return _part(track, kept) if np.count_nonzero(kept) >= _FEWEST else track


def _without_pauses(track: Track, noise: float) -> tuple[Track, np.ndarray]:
    """Average the records of each pause, and stop the clock meanwhile."""
    pauses = _find_pauses(track, noise)
    size = track.t.size
    if not pauses or size - sum(last - first for first, last in pauses) < _FEWEST:
        return track, track.t
    kept = np.ones(size, dtype=bool)
    t, x, y = track.t.copy(), track.x.copy(), track.y.copy()
    passed = np.diff(track.t, prepend=track.t[0])
    for first, last in pauses:
        kept[first + 1 : last + 1] = False
        passed[first + 1 : last + 1] = 0.0
        for values in (t, x, y):
            values[first] = values[first : last + 1].mean()
    clock = track.t[0] + np.cumsum(passed)
    return _part(track.at(t, x, y), kept), clock[kept]


def _find_pauses(track: Track, noise: float) -> list[tuple[int, int]]:
    """Return the first and the last record of each pause."""
    size = track.t.size
    if size < _FEWEST:
        return []
    places = np.array([track.x, track.y])
    step = median(track.t[1:] - track.t[:-1])
    speeds = _speeds(track, places, 1)
    pace = _at_pace(speeds) * step
    if pace == 0.0:
        return []
    window = max(1, int(np.ceil(np.sqrt(2.0) * noise / (_KNOWN * pace))))
    if window > min(_LONGEST_WINDOW, size // 4):
        return []
    if window > 1:
        speeds = _speeds(track, places, window)
        pace = _at_pace(speeds) * step
    quiet = speeds < _QUIET * pace / step
    if not quiet.any():
        return []
    return _pauses(places, quiet, window, _WITHIN * pace + _SCATTER * noise)


def _at_pace(speeds: np.ndarray) -> float:
    """Return the speed of a cell on the move, of speeds some of which are those of pauses."""
    ordered = np.sort(speeds)
    return float(ordered[int(_AT_PACE * (ordered.size - 1))])


def _speeds(track: Track, places: np.ndarray, window: int) -> np.ndarray:
    moved = places[:, window:] - places[:, :-window]
    speeds: np.ndarray = np.hypot(moved[0], moved[1]) / (track.t[window:] - track.t[:-window])
    return speeds


def _pauses(
    places: np.ndarray, quiet: np.ndarray, window: int, within: float
) -> list[tuple[int, int]]:
    """Return first and last records of stretches that stay within a distance of their mean."""
    size = places.shape[1]
    found: list[tuple[int, int]] = []
    edges = np.flatnonzero(np.diff(np.concatenate([[0], quiet.view(np.int8), [0]])))
    for start, end in zip(edges[::2].tolist(), edges[1::2].tolist(), strict=True):
        first, last = start, end - 1 + window
        if found and first <= found[-1][1]:
            continue
        middle = row_means(places[:, first : last + 1])
        if last - first < 2 or _farthest(places[:, first : last + 1] - middle) > within:
            continue
        near = np.hypot(*(places - middle)) <= 0.5 * within
        while first > 0 and near[first - 1]:
            first -= 1
        while last < size - 1 and near[last + 1]:
            last += 1
        if found and first <= found[-1][1] + 1:
            first = found.pop()[0]
        found.append((first, last))
    return found


def _farthest(apart: np.ndarray) -> float:
    return float(np.sqrt(np.max(apart[0] ** 2 + apart[1] ** 2)))


def _part(track: Track, kept: np.ndarray) -> Track:
    return track.at(track.t[kept], track.x[kept], track.y[kept])
