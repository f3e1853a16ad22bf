"""Fit: what a cell's track and outline say about its adhesions."""

from cellcrawl.infer.bank import Bank, bank, open_bank
from cellcrawl.infer.fitting import fit, fit_all
from cellcrawl.infer.prior import PAPER_PRIOR, Prior, Range
from cellcrawl.infer.result import Fit

__all__ = ["PAPER_PRIOR", "Bank", "Fit", "Prior", "Range", "bank", "fit", "fit_all", "open_bank"]
