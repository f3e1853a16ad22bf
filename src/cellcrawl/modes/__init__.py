"""Which motility mode a track shows: a rule on its turns, from the words of the paper."""

from cellcrawl.modes.classify import (
    FEWEST_RECORDS,
    SHORTEST_RUN,
    classify,
    classify_track,
    is_long_enough,
)
from cellcrawl.modes.combine import Verdict, combine
from cellcrawl.modes.result import MODES, Classification, Measures

__all__ = [
    "FEWEST_RECORDS",
    "MODES",
    "SHORTEST_RUN",
    "Classification",
    "Measures",
    "Verdict",
    "classify",
    "classify_track",
    "combine",
    "is_long_enough",
]
