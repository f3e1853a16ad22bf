"""The cell itself: its edge coloured by a field, its body, a scale bar, an arrow of its motion."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.backend_bases import RendererBase
from matplotlib.collections import LineCollection
from matplotlib.patches import Polygon
from matplotlib.transforms import Bbox
from mpl_toolkits.axes_grid1.anchored_artists import AnchoredSizeBar  # type: ignore[import-untyped]

from cellcrawl.data.units import typical_radius, units_of
from cellcrawl.observables import speed
from cellcrawl.plot.colouring import Colouring
from cellcrawl.plot.labels import length_unit, unit
from cellcrawl.plot.style import BODY, INK, RIM, on


def segments(points: np.ndarray) -> np.ndarray:
    """Return the pieces of closed edges, from midpoint to node to midpoint.

    ``points`` (..., node, 2) give (..., node, 3, 2): each node colours the edge around it.
    """
    after = 0.5 * (points + np.roll(points, -1, axis=-2))
    before = np.roll(after, 1, axis=-2)
    return np.stack([before, points, after], axis=-2)


def edge_points(dataset: xr.Dataset, record: int) -> np.ndarray:
    """Return the edge at a record, shape (node, 2)."""
    cell = dataset.isel(time=record)
    return np.column_stack([cell["x"].values, cell["y"].values])


def draw_cell(
    ax: Axes,
    points: np.ndarray,
    values: np.ndarray,
    colours: Colouring,
    *,
    linewidth: float,
    zorder: float = 2.0,
) -> LineCollection:
    """Draw one cell: a pale body, and its edge coloured by ``values``, shape (node,)."""
    body = Polygon(points, facecolor=on(ax, BODY), alpha=0.7, linewidth=0.0, zorder=zorder - 0.5)
    for patch in (body, rim(ax, points, colours, linewidth, zorder)):
        ax.add_artist(patch)  # callers set the limits; add_patch would measure each outline
    edge = LineCollection(
        list(segments(points)),
        array=values,
        cmap=colours.colormap,
        norm=colours.norm,
        linewidths=linewidth,
        capstyle="round",
        joinstyle="round",
        zorder=zorder,
    )
    ax.add_collection(edge, autolim=False)
    return edge


def rim(
    ax: Axes, points: np.ndarray, colours: Colouring, linewidth: float, zorder: float
) -> Polygon:
    """Return a grey line just wider than the edge, where its colours may be as light as paper."""
    return Polygon(
        points,
        fill=False,
        edgecolor=on(ax, RIM),
        linewidth=linewidth + 0.9 if colours.needs_rim else 0.0,
        joinstyle="round",
        zorder=zorder,
    )


def draw_velocity(ax: Axes, centre: np.ndarray, velocity: np.ndarray, per_speed: float) -> None:
    """Draw the centroid's velocity as an arrow of length ``per_speed`` times the speed."""
    ax.annotate(
        "",
        xy=tuple(centre + per_speed * velocity),
        xytext=tuple(centre),
        arrowprops={"arrowstyle": "-|>", "color": "#d55e00", "lw": 1.0, "shrinkA": 0, "shrinkB": 0},
        zorder=4,
    )


def arrow_time(run: xr.Dataset, times: float) -> float:
    """Return a length of arrows over speed: so many units of time, or about the cell's radius."""
    one = units_of(run).one("time")
    if math.isfinite(one):
        return times * one
    fastest = float(speed(run).max())
    return typical_radius(run) / fastest if fastest > 0.0 else 0.0


def scale_bar(ax: Axes, run: xr.Dataset, length: float | None = None) -> None:
    """Add a bar of a round length in the unit of the run below the axes, at the left."""
    low, high = sorted(ax.get_xlim())
    size = length or round_length(0.25 * (high - low))
    ax.add_artist(
        AnchoredSizeBar(
            ax.transData,
            size,
            length_text(run, size),
            "upper left",
            pad=0.1,
            borderpad=0.1,
            sep=2,
            frameon=False,
            color=on(ax, INK),
            bbox_to_anchor=(0.0, 0.0, 1.0, 0.0),
            bbox_transform=ax.transAxes,
        )
    )


def length_text(run: xr.Dataset, length: float) -> str:
    """Return a length with its unit."""
    return f"{length:g} {unit(length_unit(run))}"


def round_length(about: float) -> float:
    """Return 1, 2 or 5 times a power of ten, at most ``about``."""
    power = 10.0 ** np.floor(np.log10(about))
    return float(power * max(step for step in (1.0, 2.0, 5.0) if step * power <= about * 1.0001))


def frame(ax: Axes, low: np.ndarray, high: np.ndarray, *, fill: bool = False) -> None:
    """Show the box from ``low`` to ``high`` in equal aspect, without axes.

    With ``fill`` the axes keep their shape, whatever it becomes, and show more where the box has
    another.
    """
    ax.set_xlim(low[0], high[0])
    ax.set_ylim(low[1], high[1])
    ax.set_aspect("equal")
    ax.set_axis_off()
    if fill and ax.get_axes_locator() is None:
        ax.set_axes_locator(_Filling(low, high))


class _Filling:
    """Widens the limits of axes around a box to their shape, anew at each drawing.

    Matplotlib's own "datalim" widens what it has widened before: a figure whose layout is found in
    steps, or that changes its size, would show its content smaller and smaller.
    """

    def __init__(self, low: np.ndarray, high: np.ndarray) -> None:
        self._middle, self._half = 0.5 * (low + high), 0.5 * (high - low)
        self._set = np.array([low, high])

    def __call__(self, ax: Any, renderer: RendererBase | None) -> Bbox:
        place: Bbox = ax.get_position(original=True)
        limits = np.transpose([ax.get_xlim(), ax.get_ylim()])
        if np.allclose(limits, self._set):  # else somebody has zoomed
            panel = place.transformed(ax.figure.transSubfigure)
            shape = np.array([panel.width, panel.height])
            half = float(np.max(self._half / shape)) * shape
            self._set = np.array([self._middle - half, self._middle + half])
            ax.set_xlim(*self._set[:, 0])
            ax.set_ylim(*self._set[:, 1])
        return place
