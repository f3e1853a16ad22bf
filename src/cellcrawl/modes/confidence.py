"""The confidence of an answer: how often answers like it are right.

Of each answer of the rule, a logistic regression on the evidence says how often it is right, and
how often the track is "other" instead: fitted to a mixture of known tracks by
``cellcrawl bench confidence --calibrate`` and kept in ``confidence.json``. Each number enters as a
line with bends, and with each of the others as their product.
"""

from __future__ import annotations

import functools
import json
from dataclasses import dataclass
from importlib import resources
from typing import Any, Final, NamedTuple

import numpy as np

from cellcrawl.modes.evidence import WORDS, Evidence

FILE: Final = "confidence.json"
_TELLING = 0.5  # of the log-odds: evidence that weighs less is not named

TOLD: Final = 0.8
"""Below this confidence the reason is told."""


class Trust(NamedTuple):
    """The answer that is right most often, how often, and what speaks against it, in words."""

    mode: str
    confidence: float
    against: str


@dataclass(frozen=True, eq=False)
class Curve:
    """A logistic regression on lines with bends.

    Attributes
    ----------
    low, high : ndarray, shape (evidence,)
        Range of each number where it was fitted; beyond, its end counts.
    owners : ndarray of int, shape (column,)
        Which number a line belongs to.
    knots : ndarray, shape (column,)
        Where in that range, from 0 to 1, the line starts to rise.
    weights : ndarray, shape (1 + column + pair,)
        Of the constant, of the lines, and of the products of two numbers.
    usual : ndarray, shape (evidence,)
        Each number as it usually is where the answer is right.
    """

    low: np.ndarray
    high: np.ndarray
    owners: np.ndarray
    knots: np.ndarray
    weights: np.ndarray
    usual: np.ndarray

    def columns(self, evidence: np.ndarray) -> np.ndarray:
        """Return the regressors (track, 1 + column + pair) of evidence (track, number)."""
        span = np.where(self.high > self.low, self.high - self.low, 1.0)
        scaled = (np.minimum(np.maximum(evidence, self.low), self.high) - self.low) / span
        lines = np.maximum(0.0, scaled[:, self.owners] - self.knots)
        pairs = scaled[:, _FIRST] * scaled[:, _SECOND]
        return np.concatenate([np.ones((evidence.shape[0], 1)), lines, pairs], axis=1)

    def odds(self, evidence: np.ndarray) -> np.ndarray:
        """Return the log-odds (track,) for evidence (track, number)."""
        odds: np.ndarray = self.columns(evidence) @ self.weights
        return odds

    def probability(self, evidence: np.ndarray) -> np.ndarray:
        """Return the probability (track,) for evidence (track, number)."""
        chance: np.ndarray = 1.0 / (1.0 + np.exp(-np.clip(self.odds(evidence), -30.0, 30.0)))
        return chance


_NAMES = list(Evidence._fields)
_NAMED = [place for place, name in enumerate(_NAMES) if name in WORDS]
_FIRST, _SECOND = np.triu_indices(len(_NAMES), 1)
_LENGTH_AT = _NAMES.index("records")


def trust(mode: str, evidence: Evidence) -> Trust:
    """Return what to answer when the rule gives a mode, and how far to trust it."""
    stored = _stored()
    row = np.array([evidence])
    chosen, raw = stored.decide(np.array([mode]), row)
    confidence = float(stored.settle(raw, row)[0])
    against = _against(stored.curves[mode][0], row) if confidence < TOLD else ""
    return Trust(str(chosen[0]), confidence, against)


@dataclass(frozen=True, eq=False)
class Stored:
    """What `confidence.json` holds.

    Attributes
    ----------
    curves : dict
        For each answer of the rule, how often it is right and how often "other" is.
    lengths : ndarray, shape (band - 1,)
        Logarithm of the numbers of records at which one band of lengths ends and the next begins.
    raw : ndarray, shape (point,)
        Probabilities given by the curves ...
    settled : ndarray, shape (band, point)
        ... and how often such answers were right, on tracks that the curves were not fitted to.
    """

    curves: dict[str, tuple[Curve, Curve]]
    lengths: np.ndarray
    raw: np.ndarray
    settled: np.ndarray

    def decide(self, modes: np.ndarray, evidence: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return answers and their probabilities for answers of the rule and evidence.

        An answer that is wrong more often than right gives way to "other" if that is likelier.
        """
        chosen = modes.astype(object)
        raw = np.zeros(modes.size)
        for mode in set(modes.tolist()):
            asked = np.flatnonzero(modes == mode)
            right, other = self.curves[mode]
            raw[asked] = right.probability(evidence[asked])
            if mode != "other":
                weak = asked[raw[asked] < 0.5]
                instead = other.probability(evidence[weak])
                taken = instead > raw[weak]
                chosen[weak[taken]] = "other"
                raw[weak[taken]] = instead[taken]
        return chosen, raw

    def settle(self, raw: np.ndarray, evidence: np.ndarray) -> np.ndarray:
        """Return how often answers with these probabilities are right, by the length of track."""
        bands = np.searchsorted(self.lengths, evidence[:, _LENGTH_AT])
        found = np.zeros(raw.size)
        for band in set(bands.tolist()):
            found[bands == band] = np.interp(raw[bands == band], self.raw, self.settled[band])
        return found


def stored_from(kept: dict[str, Any]) -> Stored:
    """Return what a table as in `confidence.json` holds."""
    curves = {
        mode: (_curve(pair["right"]), _curve(pair["other"]))
        for mode, pair in kept["answers"].items()
    }
    return Stored(curves, *(np.array(kept[name]) for name in ("lengths", "raw", "settled")))


def _against(curve: Curve, row: np.ndarray) -> str:
    """Name the number that would raise the odds most if it were as it usually is."""
    instead = np.repeat(row, len(_NAMED), axis=0)
    instead[np.arange(len(_NAMED)), _NAMED] = curve.usual[_NAMED]
    gained = curve.odds(instead) - curve.odds(row)[0]
    most = int(np.argmax(gained))
    return WORDS[_NAMES[_NAMED[most]]] if gained[most] > _TELLING else ""


@functools.cache
def _stored() -> Stored:
    text = resources.files("cellcrawl.modes").joinpath(FILE).read_text("utf-8")
    return stored_from(json.loads(text))


def _curve(kept: dict[str, Any]) -> Curve:
    return Curve(*(np.array(kept[name]) for name in Curve.__dataclass_fields__))
