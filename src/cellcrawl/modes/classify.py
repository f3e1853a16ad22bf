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
from cellcrawl.validation import real_number

FEWEST_RECORDS = 12
"""Fewer records than this cannot show a mode."""
_LATER_STARTS = (0.0, 1 / 9, 2 / 9, 3 / 9)
"""Where the transient may end, as parts of what follows the onset."""
_PREFER_EARLY = 0.3  # a start that leaves out the part p must fit better by this times p
_BLOCKS = 8  # parts of a track whose means tell motion from noise
_MOVES = 3.0  # a cell moves if these means scatter this many times as much as noise would
_ON_THE_SPOT = 0.05  # of the cell's radius: it rests if it moves less than this


def classify(dataset: xr.Dataset) -> Classification:
    """Name the motility mode of a run.

    The same as `classify_track` of its centroid, with the cell's radius known.

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
    run = records_with(dataset, "centroid_x", "centroid_y", "area")
    if run.attrs.get("status") == "fragmented":
        return _fragmented()
    radius = math.sqrt(float(np.median(run["area"].values)) / math.pi)
    return _classify(as_track(run, at_least=FEWEST_RECORDS), radius)


def classify_track(
    t: Any, x: Any, y: Any, *, cell_radius: float | None = None, status: str = "completed"
) -> Classification:
    """Name the motility mode of any centroid track.

    Parameters
    ----------
    t, x, y : array_like, shape (record,)
        Times, which must rise, and positions, in any units; at least 12 records.
    cell_radius : float, optional
        Radius of the cell in the units of x and y. With it, a cell that spins within its own
        outline is "other" and one that moves less than a twentieth of it is "stationary"; without
        it only the form of the track counts.
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
    if cell_radius is not None:
        real_number("cell_radius", cell_radius, 0.0, math.inf, open_low=True)
    return _classify(as_track(t, x, y, at_least=FEWEST_RECORDS), cell_radius)


def _classify(track: Track, cell_radius: float | None) -> Classification:
    smoothed = smooth(track)
    if _rests(track, smoothed, cell_radius):
        found = Measures(start=float(track.t[0]), speed=0.0, noise=smoothed.noise)
        return Classification("stationary", 1.0, {}, found, "it does not move beyond its noise")
    first = onset(smoothed)
    left = smoothed.t.size - first
    found_at = {
        later: _apply_rule(smoothed, first + int(later * left), cell_radius)
        for later in (_LATER_STARTS if left > 2 * FEWEST_RECORDS else (0.0,))
    }
    named = {later: result for later, result in found_at.items() if result.mode != "other"}
    if not named:
        return found_at[0.0]
    return named[max(named, key=lambda later: named[later].confidence - _PREFER_EARLY * later)]


def _apply_rule(track: SmoothTrack, start: int, cell_radius: float | None) -> Classification:
    found = measure(track, start)
    conditions = {
        "gliding": rule.gliding(found),
        "rotational": rule.rotational(found, cell_radius),
        "zigzag": rule.zigzag(found),
    }
    fits = {mode: min(c.fit for c in held) for mode, held in conditions.items()}
    mode = max(fits, key=lambda name: fits[name])
    worst = min(conditions[mode], key=lambda condition: condition.fit)
    if fits[mode] >= 0.5:
        return Classification(mode, fits[mode], fits, found, worst.words)
    return Classification("other", 1.0 - fits[mode], fits, found, worst.words)


def _rests(track: Track, smoothed: SmoothTrack, cell_radius: float | None) -> bool:
    """Whether the positions after the first quarter are those of a cell that does not move."""
    after = np.searchsorted(track.t, track.t[0] + 0.25 * track.duration)
    places = np.stack([track.x, track.y])
    late = places[:, after:]
    extent = float(np.ptp(late, axis=1).max())
    if cell_radius is not None and extent < _ON_THE_SPOT * cell_radius:
        return True
    if extent <= 1e-9 * np.abs(places).max() or extent < 0.02 * np.ptp(places, axis=1).max():
        return True
    each = late.shape[1] // _BLOCKS
    if each < 2 or smoothed.noise == 0.0:
        return False
    blocks = late[:, : each * _BLOCKS].reshape(2, _BLOCKS, each).mean(axis=2)
    scatter = float(np.sqrt(blocks.var(axis=1, ddof=1).mean()))
    return scatter < _MOVES * smoothed.noise / math.sqrt(each)


def _fragmented() -> Classification:
    return Classification("fragmented", 1.0, {}, Measures(), "the cell tore")
