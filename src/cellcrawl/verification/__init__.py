"""The verification: everything the package claims about itself and the paper, measured anew."""

from cellcrawl.verification.check import Check, Outcome, Result
from cellcrawl.verification.registry import CHECKS, PARTS
from cellcrawl.verification.runner import run

__all__ = ["CHECKS", "PARTS", "Check", "Outcome", "Result", "run"]
