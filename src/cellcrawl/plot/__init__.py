"""Pictures of runs, sweeps and linear theory, made to stand in a paper.

Each function takes a run, a sweep, or for linear theory a cell or a map, and returns the Axes or
the Figure it drew; saving is the caller's: ``plot.path(ds).figure.savefig("path.pdf")``. Where one
axes is enough, ``ax`` draws on your own. In a notebook the picture appears, and where pyplot is
loaded its ``show`` shows it; without pyplot nothing is opened.

The house style leaves alone what you have set in ``matplotlib.rcParams``; `styled` sets width, font
size, colour map and any other of them for a while. A field has the same colours in every picture
and movie, and units are those of the data.
"""

from cellcrawl.plot.branches import boundaries, branch, branch_panels
from cellcrawl.plot.cell import cell, snapshots
from cellcrawl.plot.cycle import cycle
from cellcrawl.plot.diagram import diagram, measure_map
from cellcrawl.plot.dispersion import dispersion
from cellcrawl.plot.exponents import lyapunov_map
from cellcrawl.plot.flat_edge import flat_edge
from cellcrawl.plot.growth import growth
from cellcrawl.plot.kymograph import kymograph, kymographs
from cellcrawl.plot.outlines import outlines
from cellcrawl.plot.path import path, paths
from cellcrawl.plot.stability import stability
from cellcrawl.plot.style import house_style, styled
from cellcrawl.plot.summary import summary
from cellcrawl.plot.time_series import time_series
from cellcrawl.plot.tracks import compare_tracks, tracks
from cellcrawl.plot.two_edges import regimes, two_edges

__all__ = [
    "boundaries",
    "branch",
    "branch_panels",
    "cell",
    "compare_tracks",
    "cycle",
    "diagram",
    "dispersion",
    "flat_edge",
    "growth",
    "house_style",
    "kymograph",
    "kymographs",
    "lyapunov_map",
    "measure_map",
    "outlines",
    "path",
    "paths",
    "regimes",
    "snapshots",
    "stability",
    "styled",
    "summary",
    "time_series",
    "tracks",
    "two_edges",
]
