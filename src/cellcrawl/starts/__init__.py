"""How a cell begins."""

from cellcrawl.starts.base import CellState, Start
from cellcrawl.starts.eigenmode import Eigenmode
from cellcrawl.starts.fourier import PerturbedCircle, RandomPerturbation
from cellcrawl.starts.outline import FromOutline

__all__ = [
    "CellState",
    "Eigenmode",
    "FromOutline",
    "PerturbedCircle",
    "RandomPerturbation",
    "Start",
]
