"""The mode of a set of runs that differ in their start only."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass

from cellcrawl.arguments import checked
from cellcrawl.errors import InputError
from cellcrawl.modes.result import MODES, Classification


@dataclass(frozen=True)
class Verdict:
    """The mode of a set of runs.

    Attributes
    ----------
    mode : str
        The mode all agree on, or "mixed"; torn cells and cells at rest are left out as long as
        others are there.
    majority : str
        The mode of most; of several with as many, the one with the higher confidence in all.
    confidence : float
        Confidence in ``majority``: its share of the runs that count, each by its confidence.
    counts : dict
        How many runs show each mode, torn ones included.
    """

    mode: str
    majority: str
    confidence: float
    counts: dict[str, int]


@checked
def combine(results: Iterable[Classification]) -> Verdict:
    """Return the mode of several runs: the one they agree on, or "mixed".

    Parameters
    ----------
    results : iterable of Classification
        Results of `classify` for runs with the same parameters.

    Returns
    -------
    Verdict

    Raises
    ------
    InputError
        If there are none.
    """
    given = list(results)
    if not given:
        raise InputError("no runs to combine: give at least one classification")
    counts = Counter(result.mode for result in given)
    whole = [result for result in given if result.mode != "fragmented"] or given
    sure: dict[str, float] = {}
    for result in whole:
        sure[result.mode] = sure.get(result.mode, 0.0) + result.confidence
    majority = max(sure, key=lambda mode: (counts[mode], sure[mode]))
    return Verdict(
        mode=majority if len(sure) == 1 else "mixed",
        majority=majority,
        confidence=sure[majority] / len(whole),
        counts={mode: counts[mode] for mode in MODES if counts[mode]},
    )
