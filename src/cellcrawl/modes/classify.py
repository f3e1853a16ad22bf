"""Name the mode of a run or of a track."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import xarray as xr

from cellcrawl.modes import rule
from cellcrawl.modes.measures import measure, onset
from cellcrawl.modes.result import Classification, Measures
from cellcrawl.observables.inputs import records_with
from cellcrawl.observables.smoothing import SmoothTrack, smooth
from cellcrawl.observables.track import Track, as_track

FEWEST_RECORDS = 12
"""Fewer records than this cannot show a mode."""
_RULES = {"gliding": rule.gliding, "rotational": rule.rotational, "zigzag": rule.zigzag}
_LATER_STARTS = (
    0.0,
    0.1,
    0.2,
)  # of what follows the onset: first turns may belong to the transient
_BLOCKS = 8  # parts of a track whose means tell motion from noise
_MOVES = 3.0  # a cell moves if these means scatter this many times as much as noise would


def classify(dataset: xr.Dataset) -> Classification:
    """Name the motility mode of a run.

    Parameters
    ----------
    dataset : Dataset
        A run, of at least 12 records unless it tore.

    Returns
    -------
    Classification

    Raises
    ------
    InputError
        If the dataset is no run, or has too few records.
    """
    status = str(records_with(dataset, "centroid_x", "centroid_y").attrs.get("status", ""))
    if status == "fragmented":
        return _fragmented()
    return _classify(as_track(dataset, at_least=FEWEST_RECORDS))


def classify_track(t: Any, x: Any, y: Any, *, status: str = "completed") -> Classification:
    """Name the motility mode of any centroid track.

    Parameters
    ----------
    t, x, y : array_like, shape (record,)
        Times, which must rise, and positions, in any units; at least 12 records.
    status : str
        How the run ended, as in a Dataset's attributes: "fragmented" is a mode of its own.

    Returns
    -------
    Classification

    Raises
    ------
    InputError
        For a track that is too short, has values that are not finite, or times that do not rise.
    """
    if status == "fragmented":
        return _fragmented()
    return _classify(as_track(t, x, y, at_least=FEWEST_RECORDS))


def _classify(track: Track) -> Classification:
    smoothed = smooth(track)
    if _rests(track, smoothed):
        found = Measures(start=float(track.t[0]), speed=0.0, noise=smoothed.noise)
        return Classification("stationary", 1.0, {}, found, "it does not move beyond its noise")
    first = onset(smoothed)
    last_start = smoothed.t.size - FEWEST_RECORDS // 2
    best: Classification | None = None
    for later in _LATER_STARTS:
        start = min(first + int(later * (smoothed.t.size - first)), last_start)
        result = _apply_rule(smoothed, start)
        if best is None or (best.mode == "other" and result.mode != "other"):
            best = result
        if best.mode != "other" and best.confidence > 0.9:
            break
    assert best is not None
    return best


def _apply_rule(track: SmoothTrack, start: int) -> Classification:
    found = measure(track, start)
    conditions = {mode: conditions_of(found) for mode, conditions_of in _RULES.items()}
    fits = {mode: min(c.fit for c in held) for mode, held in conditions.items()}
    mode = max(fits, key=lambda name: fits[name])
    worst = min(conditions[mode], key=lambda condition: condition.fit)
    if fits[mode] >= 0.5:
        return Classification(mode, fits[mode], fits, found, worst.words)
    return Classification("other", 1.0 - fits[mode], fits, found, worst.words)


def _rests(track: Track, smoothed: SmoothTrack) -> bool:
    """Whether the positions after the first quarter are those of a cell that does not move."""
    after = np.searchsorted(track.t, track.t[0] + 0.25 * track.duration)
    places = np.stack([track.x, track.y])
    late = places[:, after:]
    extent = float(np.ptp(late, axis=1).max())
    size = float(np.abs(places).max())
    if extent <= 1e-9 * size or extent < 0.02 * float(np.ptp(places, axis=1).max()):
        return True
    each = late.shape[1] // _BLOCKS
    if each < 2 or smoothed.noise == 0.0:
        return False
    blocks = late[:, : each * _BLOCKS].reshape(2, _BLOCKS, each).mean(axis=2)
    scatter = float(np.sqrt(blocks.var(axis=1, ddof=1).mean()))
    return scatter < _MOVES * smoothed.noise / math.sqrt(each)


def _fragmented() -> Classification:
    return Classification("fragmented", 1.0, {}, Measures(), "the cell tore")
