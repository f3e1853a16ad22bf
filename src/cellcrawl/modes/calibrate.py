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
_RIDGE = 3.0
_DIGITS = 5
_BINS = 25


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

    Curves are fitted to three tracks of four; the fourth says how often they keep their word.
    """
    held = np.arange(known.given.size) % 4 == 3
    kept: dict[str, Any] = {"evidence": list(Evidence._fields), "answers": {}}
    for mode in ANSWERS:
        asked = (known.given == mode) & ~held
        evidence, truth = known.evidence[asked], known.right[asked]
        kept["answers"][mode] = {
            "right": _fitted(evidence, truth == mode),
            "other": _fitted(evidence, truth == "other"),
        }
    kept["raw"], kept["settled"] = [0.0, 1.0], [0.0, 1.0]
    chosen, raw = stored_from(kept).decide(known.given[held], known.evidence[held])
    kept["raw"], kept["settled"] = _settled(raw, chosen == known.right[held])
    return kept


def _settled(raw: np.ndarray, right: np.ndarray) -> tuple[list[float], list[float]]:
    """Return a rising curve of how often answers are right against what was said of them.

    Means over bins of the same number of answers, those that would fall taken together.
    """
    order = np.argsort(raw)
    bins = [
        [float(raw[part].sum()), float(right[part].sum()), float(part.size)]
        for part in np.array_split(order, _BINS)
    ]
    pooled: list[list[float]] = []
    for one in bins:
        pooled.append(one)
        while len(pooled) > 1 and pooled[-2][1] / pooled[-2][2] >= pooled[-1][1] / pooled[-1][2]:
            last = pooled.pop()
            pooled[-1] = [a + b for a, b in zip(pooled[-1], last, strict=True)]
    said = [0.0, *(total / count for total, _, count in pooled), 1.0]
    held = [hits / count for _, hits, count in pooled]
    held = [min(held[0], said[1]), *held, held[-1]]
    return [round(x, _DIGITS) for x in said], [round(y, _DIGITS) for y in held]


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
    weights = _logistic(bare.columns(evidence), true.astype(float)).round(_DIGITS)
    usual = replace(bare, weights=weights).adds(evidence[true]).mean(axis=0).round(_DIGITS)
    return {
        name: getattr(replace(bare, weights=weights, usual=usual), name).tolist()
        for name in Curve.__dataclass_fields__
    }


def _logistic(columns: np.ndarray, true: np.ndarray) -> np.ndarray:
    """Return the weights of a logistic regression with a small ridge, by Newton's method."""
    weights = np.zeros(columns.shape[1])
    ridge = np.full(columns.shape[1], _RIDGE)
    ridge[0] = 1e-6
    for _ in range(60):
        chance = 1.0 / (1.0 + np.exp(-np.clip(columns @ weights, -30.0, 30.0)))
        slope = columns.T @ (true - chance) - ridge * weights
        bend = (columns * (chance * (1.0 - chance))[:, None]).T @ columns + np.diag(ridge)
        change = np.linalg.solve(bend, slope)
        weights = weights + change * min(1.0, 5.0 / float(np.abs(change).max(initial=1e-12)))
        if np.abs(change).max() < 1e-6:
            break
    return weights
