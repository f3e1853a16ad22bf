"""Fit: what a cell's track and outline say about its adhesions."""

from cellcrawl.infer.bank import Bank, bank, open_bank
from cellcrawl.infer.prior import PAPER_PRIOR, Prior, Range

__all__ = ["PAPER_PRIOR", "Bank", "Prior", "Range", "bank", "open_bank"]
