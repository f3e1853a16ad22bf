"""Fit the confidence of answers to tracks of known mode, and see how well it holds."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np

from cellcrawl.modes.classify import name_by_rule
from cellcrawl.modes.confidence import Curve, stored_from
from cellcrawl.modes.evidence import Evidence
from cellcrawl.modes.synthetic import SyntheticTrack
from cellcrawl.observables.smoothing import smooth
from cellcrawl.observables.track import as_track

ANSWERS = ("gliding", "rotational", "zigzag", "other", "stationary")
_BENDS = (0.1, 0.3, 0.5, 0.7, 0.9)  # quantiles
_ENDS = (0.005, 0.995)
_RIDGE = 0.02
_DIGITS = 5
_PARTS = 4
_SETTLING_BENDS = np.array([0.05, 0.15, 0.3, 0.5, 0.7, 0.85, 0.95, 0.985])
_SETTLING_RIDGE = 2.0
_POINTS = np.concatenate(
    [[0.0], (1.0 / (1.0 + np.exp(-np.linspace(-7.0, 7.0, 57)))).round(_DIGITS), [1.0]]
)
_UNSETTLED: dict[str, Any] = {"raw": [0.0, 1.0], "settled": [[0.0, 1.0]]}
LENGTHS = ((12, 24), (25, 60), (61, 200), (201, 1000))
"""Numbers of records whose answers are settled, and looked at, apart."""


class Answers(NamedTuple):
    """Answers of the rule to tracks of known mode."""

    given: np.ndarray
    right: np.ndarray
    evidence: np.ndarray


def answers(tracks: Iterable[SyntheticTrack]) -> Answers:
    """Name tracks by the rule and gather the evidence: modes (track,), evidence (track, number)."""
    given, right, evidence = [], [], []
    for track in tracks:
        named, seen = name_by_rule(smooth(as_track(track.t, track.x, track.y)))
        given.append(named.mode)
        right.append(track.mode)
        evidence.append(seen)
    return Answers(np.array(given), np.array(right), np.array(evidence))


def fit(known: Answers) -> dict[str, Any]:
    """Return what `confidence.json` holds, but for where it came from.

    How often answers keep the word of the curves is asked of tracks that they were not fitted to:
    a part of the tracks at a time is held back.
    """
    part = np.arange(known.given.size) % _PARTS
    raw = np.zeros(known.given.size)
    right = np.zeros(known.given.size)
    for number in range(_PARTS):
        held = part == number
        curves = {"answers": _curves(_chosen(known, ~held)), "lengths": [], **_UNSETTLED}
        chosen, raw[held] = stored_from(curves).decide(known.given[held], known.evidence[held])
        right[held] = chosen == known.right[held]
    lengths = np.log2(np.array(LENGTHS)[:-1, 1] + 0.5)
    bands = np.searchsorted(lengths, known.evidence[:, Evidence._fields.index("records")])
    return {
        "evidence": list(Evidence._fields),
        "answers": _curves(known),
        "lengths": lengths.round(_DIGITS).tolist(),
        "raw": _POINTS.tolist(),
        "settled": [_settled(raw[bands == i], right[bands == i]) for i in range(len(LENGTHS))],
    }


def _chosen(known: Answers, which: np.ndarray) -> Answers:
    return Answers(*(values[which] for values in known))


def _curves(known: Answers) -> dict[str, Any]:
    """Fit, for each answer of the rule, how often it is right and how often "other" is."""
    found = {}
    for mode in ANSWERS:
        asked = known.given == mode
        evidence, truth = known.evidence[asked], known.right[asked]
        right = _fitted(evidence, truth == mode)
        other = right if mode == "other" else _fitted(evidence, truth == "other")
        found[mode] = {"right": right, "other": other}
    return found


def _settled(raw: np.ndarray, right: np.ndarray) -> list[float]:
    """Return how often answers are right at the probabilities `_POINTS` of the curves.

    A logistic regression on the log-odds with bends: smooth, rising, and as the curves say where
    there are no answers.
    """
    columns = _bent(raw)
    as_said = np.zeros(columns.shape[1])
    as_said[1] = 1.0
    weights = as_said + _logistic(columns, right, _SETTLING_RIDGE, columns @ as_said)
    found = 1.0 / (1.0 + np.exp(-_bent(_POINTS) @ weights))
    rising: list[float] = np.maximum.accumulate(found).round(_DIGITS).tolist()
    return rising


def _bent(chance: np.ndarray) -> np.ndarray:
    """Return the regressors (answer, column) of probabilities: their log-odds, and its bends."""
    odds = _log_odds(np.clip(chance, 1e-3, 1.0 - 1e-3))
    lines = np.maximum(0.0, odds[:, None] - _log_odds(_SETTLING_BENDS))
    return np.column_stack([np.ones(odds.size), odds, lines])


def _log_odds(chance: np.ndarray) -> np.ndarray:
    odds: np.ndarray = np.log(chance / (1.0 - chance))
    return odds


def _fitted(evidence: np.ndarray, true: np.ndarray) -> dict[str, Any]:
    low, high = (ends.round(_DIGITS) for ends in np.quantile(evidence, _ENDS, axis=0))
    span = np.where(high > low, high - low, 1.0)
    scaled = (np.clip(evidence, low, high) - low) / span
    lines = [
        (owner, float(knot))
        for owner, column in enumerate(scaled.T)
        for knot in sorted({0.0, *np.quantile(column, _BENDS).round(3).tolist()} - {1.0})
    ]
    owners = np.array([owner for owner, _ in lines])
    knots = np.array([knot for _, knot in lines])
    bare = Curve(low, high, owners, knots, np.zeros(0), np.zeros(0))
    weights = _logistic(bare.columns(evidence), true.astype(float), _RIDGE).round(_DIGITS)
    usual = np.median(evidence[true], axis=0).round(_DIGITS)
    return {
        name: getattr(replace(bare, weights=weights, usual=usual), name).tolist()
        for name in Curve.__dataclass_fields__
    }


def _logistic(
    columns: np.ndarray, true: np.ndarray, least: float, known: float | np.ndarray = 0.0
) -> np.ndarray:
    """Return the weights of a logistic regression with a small ridge, by Newton's method.

    ``known`` is the part of the log-odds that is not fitted.
    """
    weights = np.zeros(columns.shape[1])
    ridge = np.full(columns.shape[1], least)
    ridge[0] = 1e-6
    for _ in range(60):
        chance = 1.0 / (1.0 + np.exp(-np.clip(known + columns @ weights, -30.0, 30.0)))
        slope = columns.T @ (true - chance) - ridge * weights
        bend = (columns * (chance * (1.0 - chance))[:, None]).T @ columns + np.diag(ridge)
        change = np.linalg.solve(bend, slope)
        weights = weights + change * min(1.0, 20.0 / float(np.abs(change).max(initial=1e-12)))
        if np.abs(change).max() < 1e-4:
            break
    return weights
