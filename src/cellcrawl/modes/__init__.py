"""Which motility mode a track shows: a rule on its turns, from the words of the paper."""

from cellcrawl.modes.classify import classify, classify_track
from cellcrawl.modes.combine import Verdict, combine
from cellcrawl.modes.result import MODES, Classification

__all__ = ["MODES", "Classification", "Verdict", "classify", "classify_track", "combine"]
