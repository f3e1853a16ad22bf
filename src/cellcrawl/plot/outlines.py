"""A sheet about outlines: where they are, and how large, round and long."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from cellcrawl.arguments import checked
from cellcrawl.errors import InputError
from cellcrawl.microscopy.outlines import Outlines
from cellcrawl.observables.edges import edge_series
from cellcrawl.observables.shape import aspect_ratio, circularity
from cellcrawl.plot.style import PAGE, RIM, TRACK, paper_figure
from cellcrawl.plot.track_panels import draw_scale_bar, shown_units

_MOST_DRAWN = 1000


@checked
def outlines(given: Outlines, *, title: str = "") -> Figure:
    """Draw a sheet of outlines: in place, and their areas, circularities and aspect ratios.

    Parameters
    ----------
    given : Outlines
        What `read_outlines` returns.
    title : str
        Stands above.

    Returns
    -------
    Figure

    Raises
    ------
    InputError
        If there are none.

    Notes
    -----
    Outlines stand as they are seen on the screen. Of more than 1000 the measures and the drawing
    are of 1000, evenly spread. Lengths are those of `edge_series`, smoothed by the pixel.
    """
    if len(given) == 0:
        raise InputError("there are no outlines to draw")
    places = np.linspace(0, len(given) - 1, min(len(given), _MOST_DRAWN)).round().astype(int)
    chosen = [given[int(place)] for place in places]
    edges = [edge_series([outline.xy]) for outline in chosen]
    length = shown_units(given.source.length_units)
    measures = {
        f"area ({length}²)" if length else "area": [float(edge["area"][0]) for edge in edges],
        "circularity": [float(circularity(edge)[0]) for edge in edges],
        "aspect ratio": [float(aspect_ratio(edge)[0]) for edge in edges],
    }
    with paper_figure(PAGE, 3.4, shown=True) as figure:
        panels: Any = figure.subplot_mosaic(
            [["place", name] for name in measures], width_ratios=[1.2, 1.0]
        )
        _draw_outlines(panels["place"], [outline.xy for outline in chosen], given)
        for name, values in measures.items():
            _draw_spread(panels[name], name, np.array(values))
        lines = [title or f"{len(given)} outlines"]
        if not given.source.length_units:
            lines.append("lengths in the units of the file, which does not tell them")
        figure.suptitle("\n".join(lines), x=0.01, ha="left")
    return figure


def _draw_outlines(ax: Axes, shapes: list[np.ndarray], given: Outlines) -> None:
    up = -1.0 if given.source.y_down else 1.0
    drawn = [shape * (1.0, up) for shape in shapes]
    faces = PolyCollection(drawn, facecolors=TRACK, edgecolors=TRACK, alpha=0.35, linewidths=0.7)
    ax.add_collection(faces)
    points = np.concatenate(drawn)
    middle = 0.5 * (points.min(axis=0) + points.max(axis=0))
    half = 0.53 * float(np.ptp(points, axis=0).max())
    ax.set(xlim=(middle[0] - half, middle[0] + half), ylim=(middle[1] - half, middle[1] + half))
    ax.set_aspect("equal")
    ax.set_axis_off()
    draw_scale_bar(ax, half, given.source.length_units)


def _draw_spread(ax: Axes, name: str, values: np.ndarray) -> None:
    """Draw every value, stacked where they are alike, and the median."""
    span = max(float(np.ptp(values)), 1e-9 * float(np.abs(values).max()))
    place = np.round((values - values.min()) / span * 40.0).astype(int)
    height = np.zeros(values.size)
    for number in np.unique(place):
        alike = np.flatnonzero(place == number)
        height[alike] = np.arange(1, alike.size + 1)
    ax.plot(values, height, "o", color=TRACK, markersize=2.5, alpha=0.8)
    ax.axvline(float(np.median(values)), color=RIM, linewidth=0.8)
    ax.set_ylim(0.0, 1.2 * max(float(height.max()), 2.0))
    ax.set_xlabel(f"{name}, median {np.median(values):.4g}")
    ax.set_ylabel("cells")
    ax.yaxis.set_major_locator(MaxNLocator(3, integer=True))
    ax.xaxis.set_major_locator(MaxNLocator(5))
    ax.spines[["top", "right"]].set_visible(False)
