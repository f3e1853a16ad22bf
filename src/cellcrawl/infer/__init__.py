"""Fit: what a cell's track and outline say about its adhesions."""

from cellcrawl.infer.bank import Bank, bank, open_bank
from cellcrawl.infer.choice import Choice, choose
from cellcrawl.infer.fitting import fit, fit_all
from cellcrawl.infer.neural import save_network
from cellcrawl.infer.page import report
from cellcrawl.infer.pictures import corner, foretold
from cellcrawl.infer.population import Comparison, Group, compare, together
from cellcrawl.infer.prior import PAPER_PRIOR, Prior, Range
from cellcrawl.infer.result import Fit

__all__ = [
    "PAPER_PRIOR",
    "Bank",
    "Choice",
    "Comparison",
    "Fit",
    "Group",
    "Prior",
    "Range",
    "bank",
    "choose",
    "compare",
    "corner",
    "fit",
    "fit_all",
    "foretold",
    "open_bank",
    "report",
    "save_network",
    "together",
]
