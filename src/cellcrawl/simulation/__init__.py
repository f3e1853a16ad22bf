"""A run: a solver followed in time, its events, its files."""

from cellcrawl.simulation.from_run import FromRun
from cellcrawl.simulation.run import resume, simulate
from cellcrawl.simulation.storage import open_run

__all__ = ["FromRun", "open_run", "resume", "simulate"]
