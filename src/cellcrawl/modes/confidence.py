"""The confidence of an answer: how often answers like it are right.

Of each answer of the rule, a logistic regression on the evidence says how often it is right, and
how often the track is "other" instead: fitted to a mixture of known tracks by
``cellcrawl bench modes --calibrate`` and kept in ``confidence.json``. Each number enters as a
line with bends, so that what counts can be read off the file.
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
_CROSSED: Final = (  # numbers that count differently in short and in long tracks
    "fit",
    "memory_score",
    "rhythm",
    "heading_error",
    "disorder",
    "records_per_swing",
    "turned",
)
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
    weights : ndarray, shape (1 + column + crossed,)
        Of the constant, of the lines, and of the numbers times that of the records.
    usual : ndarray, shape (evidence,)
        What each number adds to the log-odds of right answers on average.
    """

    low: np.ndarray
    high: np.ndarray
    owners: np.ndarray
    knots: np.ndarray
    weights: np.ndarray
    usual: np.ndarray

    def columns(self, evidence: np.ndarray) -> np.ndarray:
        """Return the regressors (track, 1 + column + crossed) of evidence (track, number)."""
        span = np.where(self.high > self.low, self.high - self.low, 1.0)
        scaled = (np.minimum(np.maximum(evidence, self.low), self.high) - self.low) / span
        lines = np.maximum(0.0, scaled[:, self.owners] - self.knots)
        crossed = scaled[:, _CROSSED_AT] * scaled[:, _LENGTH_AT : _LENGTH_AT + 1]
        return np.concatenate([np.ones((evidence.shape[0], 1)), lines, crossed], axis=1)

    def probability(self, evidence: np.ndarray) -> np.ndarray:
        """Return the probability (track,) for evidence (track, number)."""
        odds: np.ndarray = self.columns(evidence) @ self.weights
        chance: np.ndarray = 1.0 / (1.0 + np.exp(-np.clip(odds, -30.0, 30.0)))
        return chance

    def adds(self, evidence: np.ndarray) -> np.ndarray:
        """Return what each number adds to the log-odds, (track, number)."""
        products = self.columns(evidence)[:, 1:] * self.weights[1:]
        whose = np.concatenate([self.owners, _CROSSED_AT])
        belongs = (whose[:, None] == np.arange(len(_NAMES))).astype(float)
        added: np.ndarray = products @ belongs
        return added


_NAMES = list(Evidence._fields)
_CROSSED_AT = np.array([_NAMES.index(name) for name in _CROSSED])
_LENGTH_AT = _NAMES.index("records")


def trust(mode: str, evidence: Evidence) -> Trust:
    """Return what to answer when the rule gives a mode, and how far to trust it."""
    stored = _stored()
    row = np.array([evidence])
    chosen, raw = stored.decide(np.array([mode]), row)
    confidence = float(np.interp(raw[0], stored.raw, stored.settled))
    against = _against(stored.curves[mode][0], row) if confidence < TOLD else ""
    return Trust(str(chosen[0]), confidence, against)


@dataclass(frozen=True, eq=False)
class Stored:
    """What `confidence.json` holds.

    Attributes
    ----------
    curves : dict
        For each answer of the rule, how often it is right and how often "other" is.
    raw, settled : ndarray
        How often answers were right that the curves gave these probabilities, on tracks that they
        were not fitted to.
    """

    curves: dict[str, tuple[Curve, Curve]]
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


def stored_from(kept: dict[str, Any]) -> Stored:
    """Return what a table as in `confidence.json` holds."""
    curves = {
        mode: (_curve(pair["right"]), _curve(pair["other"]))
        for mode, pair in kept["answers"].items()
    }
    return Stored(curves, np.array(kept["raw"]), np.array(kept["settled"]))


def _against(curve: Curve, row: np.ndarray) -> str:
    """Name the evidence that lowers the odds most against what is usual."""
    lost = curve.usual - curve.adds(row)[0]
    named = [(float(lost[i]), WORDS[name]) for i, name in enumerate(_NAMES) if name in WORDS]
    most, words = max(named)
    return words if most > _TELLING else ""


@functools.cache
def _stored() -> Stored:
    text = resources.files("cellcrawl.modes").joinpath(FILE).read_text("utf-8")
    return stored_from(json.loads(text))


def _curve(kept: dict[str, Any]) -> Curve:
    return Curve(*(np.array(kept[name]) for name in Curve.__dataclass_fields__))
