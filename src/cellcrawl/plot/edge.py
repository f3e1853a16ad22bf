"""The cell itself: its edge coloured by a field, its body, a scale bar, an arrow of its motion."""

from __future__ import annotations

from typing import Any

import matplotlib as mpl
import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.colorbar import Colorbar
from matplotlib.colors import Normalize
from matplotlib.patches import Polygon
from mpl_toolkits.axes_grid1.anchored_artists import AnchoredSizeBar  # type: ignore[import-untyped]

from cellcrawl.plot.scales import SCALES, extend_for, ticks_for
from cellcrawl.plot.style import BODY, INK, RIM, figure_of


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
    field: str,
    norm: Normalize,
    *,
    linewidth: float,
    zorder: float = 2.0,
) -> LineCollection:
    """Draw one cell: a pale body, and its edge coloured by ``values``, shape (node,)."""
    body = Polygon(points, facecolor=BODY, alpha=0.7, linewidth=0.0, zorder=zorder - 0.5)
    for patch in (body, rim(points, field, linewidth, zorder)):
        ax.add_artist(patch)  # callers set the limits; add_patch would measure each outline
    edge = LineCollection(
        list(segments(points)),
        array=values,
        cmap=SCALES[field].colormap,
        norm=norm,
        linewidths=linewidth,
        capstyle="round",
        joinstyle="round",
        zorder=zorder,
    )
    ax.add_collection(edge, autolim=False)
    return edge


def rim(points: np.ndarray, field: str, linewidth: float, zorder: float) -> Polygon:
    """Return a grey line just wider than the edge, where its colours may be as light as paper."""
    return Polygon(
        points,
        fill=False,
        edgecolor=RIM,
        linewidth=linewidth + 0.9 if SCALES[field].reaches_white else 0.0,
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


def colour_bar(
    mappable: Any, ax: Any, field: str, values: np.ndarray, *, short: bool = False, **options: Any
) -> Colorbar:
    """Add the colour bar of a field, with arrows where values lie beyond its ends."""
    scale = SCALES[field]
    first = ax if isinstance(ax, Axes) else np.ravel(np.asarray(ax, dtype=object))[0]
    bar = figure_of(first).colorbar(
        mappable,
        ax=ax,
        extend=extend_for(mappable.norm, values),
        label=scale.short_label if short else scale.label,
        **{"fraction": 0.05, "pad": 0.02, "aspect": 18, **options},
    )
    ticks = ticks_for(mappable.norm)
    if ticks is not None:
        bar.set_ticks(ticks, labels=[f"{tick:g}".replace("-", "\N{MINUS SIGN}") for tick in ticks])
        bar.ax.minorticks_off()
    decoration: Any = bar  # its parts are not typed
    decoration.outline.set_linewidth(0.4)
    decoration.solids.set_rasterized(True)
    bar.ax.tick_params(which="major", length=2, width=mpl.rcParams["ytick.minor.width"])
    return bar


def scale_bar(ax: Axes, length: float | None = None) -> None:
    """Add a bar of a round length in R_0 below the axes, at the left."""
    low, high = sorted(ax.get_xlim())
    size = length or round_length(0.25 * (high - low))
    ax.add_artist(
        AnchoredSizeBar(
            ax.transData,
            size,
            f"{size:g} $R_0$",
            "upper left",
            pad=0.1,
            borderpad=0.1,
            sep=2,
            frameon=False,
            color=INK,
            bbox_to_anchor=(0.0, 0.0, 1.0, 0.0),
            bbox_transform=ax.transAxes,
        )
    )


def round_length(about: float) -> float:
    """Return 1, 2 or 5 times a power of ten, at most ``about``."""
    power = 10.0 ** np.floor(np.log10(about))
    return float(power * max(step for step in (1.0, 2.0, 5.0) if step * power <= about * 1.0001))


def frame(ax: Axes, low: np.ndarray, high: np.ndarray, margin: float) -> None:
    """Show the box from ``low`` to ``high`` with a margin, in equal aspect, without axes."""
    ax.set_xlim(low[0] - margin, high[0] + margin)
    ax.set_ylim(low[1] - margin, high[1] + margin)
    ax.set_aspect("equal")
    ax.set_axis_off()
