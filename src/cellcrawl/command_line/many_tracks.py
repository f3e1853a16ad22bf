"""Many tracks classified at once: on all cores, one bad track never stopping the others."""

from __future__ import annotations

import contextlib
from collections import deque
from collections.abc import Callable, Iterator
from concurrent.futures import Future
from typing import TYPE_CHECKING, Final, NamedTuple

import numpy as np

from cellcrawl.errors import InputError

if TYPE_CHECKING:
    from cellcrawl.microscopy import Tracks
    from cellcrawl.modes import Classification

_FEW: Final = 4000  # tracks below which starting processes costs more than it saves
_CHUNK: Final = 250


class Named(NamedTuple):
    """What came of one track: its classification, or the reason that there is none."""

    track: str
    result: Classification | None
    reason: str


def classify_all(
    tracks: Tracks, cell_radius: float | None, told: Callable[[int], None] = lambda count: None
) -> Iterator[Named]:
    """Classify tracks, on all cores if they are many; results come in the order of tracks.

    Parameters
    ----------
    tracks : Tracks
    cell_radius : float, optional
        As in `cellcrawl.classify_track`.
    told : callable
        Called with the number of tracks done since the last call.
    """
    chunks = (tracks[first : first + _CHUNK] for first in range(0, len(tracks), _CHUNK))
    from cellcrawl.threads import usable_cores

    cores = usable_cores()
    if len(tracks) < _FEW or cores == 1:
        for chunk in chunks:
            yield from _classify_chunk(chunk, cell_radius)
            told(len(chunk))
        return
    from cellcrawl.sweeps.pool import WorkerPool

    pool = WorkerPool(cores)
    waiting: deque[tuple[int, Future[list[Named]]]] = deque()
    with contextlib.ExitStack() as stack:
        stack.callback(pool.shutdown, wait=False, cancel_futures=True)
        for chunk in chunks:
            while len(waiting) > 4 * cores:  # only so many at a time, so that memory stays flat
                yield from _first_of(waiting, told)
            waiting.append((len(chunk), pool.submit(_classify_chunk, chunk, cell_radius)))
        while waiting:
            yield from _first_of(waiting, told)


def _first_of(
    waiting: deque[tuple[int, Future[list[Named]]]], told: Callable[[int], None]
) -> list[Named]:
    size, future = waiting.popleft()
    done = future.result()
    told(size)
    return done


def _classify_chunk(tracks: Tracks, cell_radius: float | None) -> list[Named]:
    import cellcrawl as cc

    found = []
    for track in tracks:
        try:
            result = cc.classify_track(track.t, track.x, track.y, cell_radius=cell_radius)
            found.append(Named(track.id, result, ""))
        except InputError as error:
            found.append(Named(track.id, None, str(error)))
        except (ArithmeticError, ValueError, np.linalg.LinAlgError) as error:
            found.append(Named(track.id, None, f"it cannot be measured: {error}"))
    return found
