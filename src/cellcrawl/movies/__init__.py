"""Movies of a run: MP4 and GIF, frame by frame from the saved records."""

from cellcrawl.movies.movie import movie

__all__ = ["movie"]
