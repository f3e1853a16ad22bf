"""Name the mode of a run or of a track."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
import xarray as xr

from cellcrawl.arguments import checked
from cellcrawl.data import STATUSES
from cellcrawl.data.units import units_of
from cellcrawl.modes import rule
from cellcrawl.modes.confidence import trust
from cellcrawl.modes.evidence import Evidence, gather
from cellcrawl.modes.measures import measure, measure_rest, onset
from cellcrawl.modes.result import STEADY_SPIN, Classification, Measures
from cellcrawl.observables.inputs import records_with
from cellcrawl.observables.smoothing import SmoothTrack, smooth
from cellcrawl.observables.track import Track, as_track, track_of_checked
from cellcrawl.validation import real_number

FEWEST_RECORDS = 12
"""Fewer records than this cannot show a mode."""
SHORTEST_RUN = 50.0
"""Runs of the model shorter than this, in 1/k_off0, may not have come to their mode."""
_LATER_STARTS = (0.0, 1 / 9, 2 / 9, 3 / 9)
"""Where the transient may end, as parts of what follows the onset."""
_SHORT, _LONG = 24, 60  # records up to which none of these, and only the last, is tried
_PREFER_EARLY = 0.3  # a start that leaves out the part p must fit better by this times p
_FEW_TURNS = 3  # a track that has turned less often, and less than once round, may be any mode
_CUT_SHORT = 0.5  # the confidence that a run which failed, or is too short, can have
_UNEVENTFUL = ("gliding", "stationary")  # modes of cells that have not turned, or not set off, yet
_FAILURES = tuple(set(STATUSES) - {"completed", "fragmented", "interrupted", "running"})


@checked
def classify(dataset: xr.Dataset, *, use_size: bool = True) -> Classification:
    """Name the motility mode of a run.

    The same as `classify_track` of its centroid, with the cell's radius known.

    Parameters
    ----------
    dataset : Dataset
        A run, of at least 12 records unless it tore.
    use_size : bool
        Whether the size of the cell counts; without it only the form of the track does.

    Returns
    -------
    Classification
        "fragmented" for a run that tore, whatever it did before.

    Raises
    ------
    InputError
        If the dataset is no run, or has too few records.

    Notes
    -----
    The modes are those of a cell left to itself: a schedule that changes parameters on the way
    makes a track with several modes, which is "other". A run of less than about 50 may not have
    come to its mode: one that has not turned or not set off by then has a confidence of at most
    0.5. A run that a failure ended (outside the model, or unresolved) is named by what
    there is, says so in ``doubt``, and its confidence is at most 0.5.
    """
    torn = isinstance(dataset, xr.Dataset) and dataset.attrs.get("status") == "fragmented"
    fewest = 1 if torn else FEWEST_RECORDS
    run = records_with(dataset, "centroid_x", "centroid_y", "area", at_least=fewest)
    if torn:
        return _fragmented()
    track = track_of_checked(run)
    radius = math.sqrt(float(np.median(run.variables["area"].values)) / math.pi)
    found = _classify(track, radius if use_size else None)
    return _ended(_early(found, run), str(run.attrs.get("status", "completed")), float(track.t[-1]))


@checked
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
        How the run ended, as in a Dataset's attributes: "fragmented" is a mode of its own, and one
        that says it failed lowers the confidence to 0.5 at most.

    Returns
    -------
    Classification

    Raises
    ------
    InputError
        For a track that is too short, has values that are not finite, or times that do not rise.

    Notes
    -----
    The rule is on the page "Motility modes" of the documentation. Records may be uneven in time.
    Their interval must be short enough to show a turn, about a quarter of the time from one swing
    to the next, and the noise of the positions is found from the track itself. Measures are taken
    after the transient, which is found as well: the time to the onset of crawling and up to a
    third of what follows.
    """
    if status == "fragmented":
        return _fragmented()
    if cell_radius is not None:
        real_number("cell_radius", cell_radius, 0.0, math.inf, open_low=True)
    track = as_track(t, x, y, at_least=FEWEST_RECORDS)
    return _ended(_classify(track, cell_radius), status, float(track.t[-1]))


@checked
def is_long_enough(dataset: xr.Dataset) -> bool:
    """Whether a run of the model lasts `SHORTEST_RUN` and has the records to show its mode."""
    times, one = records_with(dataset)["time"].values, units_of(dataset).one("time")
    long = float(times[-1] - times[0]) >= SHORTEST_RUN * (one if math.isfinite(one) else 0.0)
    return times.size >= FEWEST_RECORDS and long


def _classify(track: Track, cell_radius: float | None) -> Classification:
    smoothed = smooth(track)
    named, evidence = name_by_rule(smoothed)
    found = _with_confidence(named, evidence)
    if cell_radius is not None:
        found = _with_size(found, cell_radius)
    return replace(found, doubt=_joined(found.doubt, _told_of(smoothed.sound.wild, track)))


def _with_confidence(named: Classification, evidence: Evidence) -> Classification:
    """Say how often such an answer is right, and take it back if "other" is right more often."""
    found = trust(named.mode, evidence)
    doubt = _joined(named.doubt, found.against)
    if found.mode != named.mode:
        why = found.against or named.doubt or "too little to tell"
        doubt = f"not surely {named.mode}: {why}"
    return replace(named, mode=found.mode, confidence=found.confidence, doubt=doubt)


def _with_size(named: Classification, cell_radius: float) -> Classification:
    """Judge by the size of the cell too: it enters as it fits, for it is no matter of chance."""
    still, wide = rule.against_size(named.measures, cell_radius)
    if still.fit >= 0.5:
        sure = max(still.fit, named.confidence if named.mode == "stationary" else 0.0)
        return replace(named, mode="stationary", confidence=sure, doubt=still.words)
    if named.mode != "rotational":
        return replace(named, confidence=named.confidence * (1.0 - still.fit))
    fits = {**named.memberships, "rotational": min(named.memberships["rotational"], wide.fit)}
    if wide.fit >= 0.5:
        sure = named.confidence * wide.fit
        doubt = _joined(named.doubt, wide.words if wide.fit < 1.0 else "")
        return replace(named, confidence=sure, doubt=doubt, memberships=fits)
    sure = 1.0 - named.confidence * wide.fit
    doubt = _joined(f"not rotational: {wide.words}", named.doubt)
    return Classification("other", sure, fits, named.measures, doubt, STEADY_SPIN)


def _told_of(wild: tuple[int, ...], track: Track) -> str:
    """Say which records were left out because they lie far off the path."""
    if not wild:
        return ""
    which = ", ".join(f"{record} (t = {track.t[record]:g})" for record in wild)
    records = "records" if len(wild) > 1 else "record"
    return f"{records} {which} left out: far off the path, as by a wrong link"


def _joined(*doubts: str) -> str:
    return ", ".join(dict.fromkeys(filter(None, doubts)))


def name_by_rule(smoothed: SmoothTrack) -> tuple[Classification, Evidence]:
    """Name the form of a track by the rule, as sure as it fits, and gather the evidence."""
    still = measure_rest(smoothed.sound.clean, smoothed.noise)
    at_rest = max(rule.stationary(still), key=_fit)
    if at_rest.fit >= 0.5:
        named = Classification("stationary", at_rest.fit, {}, still, at_rest.words)
        return named, gather(smoothed, still, still, {"stationary": at_rest.fit, "": 0.0})
    first = onset(smoothed)
    left = smoothed.t.size - first
    starts = _LATER_STARTS if left >= _LONG else _LATER_STARTS[:: 3 if left > _SHORT else 4]
    best = _apply_rule(smoothed, first)
    best_score = _score(best, 0.0)
    for later in starts[1:]:
        if best_score >= 1.0 - _PREFER_EARLY * later:
            break
        result = _apply_rule(smoothed, first + int(later * left))
        if _score(result, later) > best_score:
            best, best_score = result, _score(result, later)
    seen = replace(
        best.measures, extent=still.extent, late_extent=still.late_extent, disorder=still.disorder
    )
    best = replace(best, measures=seen)
    return best, gather(smoothed, seen, still, best.memberships)


def _ended(found: Classification, status: str, time: float) -> Classification:
    """Return the result with what it is worth if a failure ended the run: it saw a beginning."""
    if status not in _FAILURES:
        return found
    words = f"the run ended {status} at t = {time:.4g}"
    doubt = "; ".join(part for part in (words, found.doubt) if part)
    return replace(found, confidence=min(found.confidence, _CUT_SHORT), doubt=doubt)


def _early(found: Classification, run: xr.Dataset) -> Classification:
    """Return the result with what it is worth where nothing has happened, and still may."""
    end, begins = float(run["time"][-1]), SHORTEST_RUN * units_of(run).one("time")
    if found.mode not in _UNEVENTFUL or not end < begins:
        return found
    words = f"it ends at t = {end:.4g}, and turns may begin up to t = {begins:g}"
    return replace(
        found, confidence=min(found.confidence, _CUT_SHORT), doubt=_joined(words, found.doubt)
    )


def _score(result: Classification, later: float) -> float:
    return result.confidence - _PREFER_EARLY * later if result.mode != "other" else 0.0


def _apply_rule(track: SmoothTrack, start: int) -> Classification:
    found = measure(track, start)
    conditions = {
        "gliding": rule.gliding(found),
        "rotational": rule.rotational(found),
        "zigzag": rule.zigzag(found),
    }
    fits = {mode: min(map(_fit, held)) for mode, held in conditions.items()}
    mode = max(fits, key=lambda name: fits[name])
    if fits[mode] >= 0.5:
        if mode == "rotational":
            found = replace(found, period=2.0 * math.pi / abs(found.turning_rate))
        weakest = min(conditions[mode], key=_fit)
        doubt = weakest.words if weakest.fit < 1.0 else ""
        return Classification(mode, fits[mode], fits, found, doubt)
    # The mode with most conditions held says best what is odd about the track.
    nearest = max(
        conditions, key=lambda name: sum(map(_fit, conditions[name])) / len(conditions[name])
    )
    doubt = f"not {nearest}: {min(conditions[nearest], key=_fit).words}"
    if found.swings < _FEW_TURNS and abs(found.turned) < 2.0 * math.pi:
        doubt = "it turns too few times to tell"
    return Classification("other", 1.0 - fits[mode], fits, found, doubt)


def _fit(condition: rule.Condition) -> float:
    return condition.fit


def _fragmented() -> Classification:
    return Classification("fragmented", 1.0, {}, Measures(), "it tore")
