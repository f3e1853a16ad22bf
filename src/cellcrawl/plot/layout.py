"""A layout that is quick and follows the size of the figure.

Constrained layout measures all text, which takes longer than drawing a small page.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, NamedTuple

from matplotlib.axes import Axes
from matplotlib.layout_engine import LayoutEngine


class Edge(NamedTuple):
    """Where a side of some axes is: a part of the figure, and inches on from there."""

    part: float
    inches: float = 0.0

    def at(self, size: float) -> float:
        """Return the place as a part of a figure of that size in inches."""
        return self.part + self.inches / size


class Place(NamedTuple):
    """Where axes are on a figure."""

    left: Edge
    right: Edge
    bottom: Edge
    top: Edge


def shared(
    weights: list[float], gaps: list[float], before: float, after: float
) -> list[tuple[Edge, Edge]]:
    """Return the sides of panels in a row that share a figure by their weights.

    Parameters
    ----------
    weights : list of float
        Sizes of the panels over each other, in order.
    gaps : list of float
        Inches between them, one fewer.
    before, after : float
        Inches left free at the ends of the figure.
    """
    taken, total = before + sum(gaps) + after, sum(weights)
    sides, part, inches = [], 0.0, before
    for weight, gap in zip(weights, [*gaps, 0.0], strict=True):
        start = Edge(part, inches)
        part += weight / total
        inches -= taken * weight / total
        sides.append((start, Edge(part, inches)))
        inches += gap
    return sides


class PlacedLayout(LayoutEngine):
    """Puts each axes into its place whenever the figure is drawn."""

    _adjust_compatible = True
    _colorbar_gridspec = False

    def __init__(self, places: Mapping[Axes, Place]) -> None:
        super().__init__()
        self._places = dict(places)

    def execute(self, fig: Any) -> None:
        """Place the axes on a figure of its present size."""
        wide, tall = fig.bbox.width / fig.dpi, fig.bbox.height / fig.dpi
        for ax, (left, right, bottom, top) in self._places.items():
            x, y = left.at(wide), bottom.at(tall)
            ax.set_position((x, y, right.at(wide) - x, top.at(tall) - y))
