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
    counts: Counter[str] = Counter()
    sure: dict[str, float] = {}
    for result in results:  # one by one: there may be a hundred thousand
        counts[result.mode] += 1
        sure[result.mode] = sure.get(result.mode, 0.0) + result.confidence
    if not counts:
        raise InputError("no runs to combine: give at least one classification")
    if len(sure) > 1:
        sure.pop("fragmented", None)
    majority = max(sure, key=lambda mode: (counts[mode], sure[mode]))
    return Verdict(
        mode=majority if len(sure) == 1 else "mixed",
        majority=majority,
        confidence=sure[majority] / sum(counts[mode] for mode in sure),
        counts={mode: counts[mode] for mode in MODES if counts[mode]},
    )
