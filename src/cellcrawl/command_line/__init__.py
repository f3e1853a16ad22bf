"""The command `cellcrawl`."""

from cellcrawl.command_line.main import main

__all__ = ["main"]
