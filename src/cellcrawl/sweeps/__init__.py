"""Sweeps: grids of runs on any executor, kept in a folder that nothing done is lost from."""

from cellcrawl.sweeps.driver import sweep
from cellcrawl.sweeps.grid import Grid
from cellcrawl.sweeps.refine import refine
from cellcrawl.sweeps.results import Sweep, open_sweep

__all__ = ["Grid", "Sweep", "open_sweep", "refine", "sweep"]
