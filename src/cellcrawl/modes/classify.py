"""Name the mode of a run or of a track."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
import xarray as xr

from cellcrawl.modes import rule
from cellcrawl.modes.measures import measure, measure_rest, onset
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
    still = measure_rest(track, smoothed.noise)
    at_rest = max(rule.stationary(still, cell_radius), key=lambda condition: condition.fit)
    if at_rest.fit >= 0.5:
        return Classification("stationary", at_rest.fit, {}, still, at_rest.words)
    first = onset(smoothed)
    left = smoothed.t.size - first
    starts = _LATER_STARTS if left > 2 * FEWEST_RECORDS else _LATER_STARTS[:1]
    best, best_score = None, 0.0
    for later in starts:
        if best_score >= 1.0 - _PREFER_EARLY * later:
            break
        result = _apply_rule(smoothed, first + int(later * left), cell_radius)
        score = result.confidence - _PREFER_EARLY * later if result.mode != "other" else 0.0
        if best is None or score > best_score:
            best, best_score = result, score
    assert best is not None
    seen = replace(
        best.measures,
        extent=still.extent,
        late_extent=still.late_extent,
        disorder=still.disorder,
    )
    return replace(best, confidence=min(best.confidence, 1.0 - at_rest.fit), measures=seen)


def _apply_rule(track: SmoothTrack, start: int, cell_radius: float | None) -> Classification:
    found = measure(track, start)
    conditions = {
        "gliding": rule.gliding(found),
        "rotational": rule.rotational(found, cell_radius),
        "zigzag": rule.zigzag(found),
    }
    fits = {mode: min(c.fit for c in held) for mode, held in conditions.items()}
    mode = max(fits, key=lambda name: fits[name])
    if fits[mode] >= 0.5:
        weakest = min(conditions[mode], key=lambda condition: condition.fit)
        return Classification(mode, fits[mode], fits, found, weakest.words)
    # The mode with most conditions held says best what is odd about the track.
    nearest = max(
        conditions, key=lambda name: sum(c.fit for c in conditions[name]) / len(conditions[name])
    )
    broken = min(conditions[nearest], key=lambda condition: condition.fit)
    return Classification("other", 1.0 - fits[mode], fits, found, f"not {nearest}: {broken.words}")


def _fragmented() -> Classification:
    return Classification("fragmented", 1.0, {}, Measures(), "the cell tore")
