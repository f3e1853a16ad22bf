"""Regions of instability over two parameters (Fig. 4A of the paper)."""

from __future__ import annotations

from typing import Any

import matplotlib as mpl
import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.patches import Patch, PathPatch

from cellcrawl.arguments import checked
from cellcrawl.linear.stability import axis_names, curves_in
from cellcrawl.plot.regions import Box, region
from cellcrawl.plot.style import COLUMN, axes_or_new
from cellcrawl.plot.symbols import parameter_label

_LIGHTEST, _DARKEST = 0.18, 0.78
_CURVE = 0.14  # how much darker a marginal curve is than its region


@checked
def stability(stability_map: xr.Dataset, *, legend: bool = True, ax: Axes | None = None) -> Axes:
    """Shade where each wavenumber grows, from light to dark blue, with the marginal curves.

    Everything is drawn below a zorder of 2, so that symbols may be plotted on top.

    Parameters
    ----------
    stability_map : Dataset
        From `linear.stability_map`. The shades follow the marginal curves, not the grid.
    legend : bool
        Say above the axes which shade is which wavenumber.
    ax : Axes, optional
        Where to draw; the only axes of a new figure unless given.

    Returns
    -------
    Axes

    Raises
    ------
    InputError
        For a dataset that is no stability map.
    """
    first, second = axis_names(stability_map)
    x, y = stability_map[first].values, stability_map[second].values
    box = (float(x[0]), float(x[-1]), float(y[0]), float(y[-1]))
    wavenumbers = [int(k) for k in stability_map["k"].values]
    shades = np.linspace(_LIGHTEST, _DARKEST, max(len(wavenumbers), 2))
    blues = mpl.colormaps["Blues"]
    with axes_or_new(ax, COLUMN, 0.8 * COLUMN) as axes:
        for number, (k, shade) in enumerate(zip(wavenumbers, shades, strict=False)):
            _draw(axes, stability_map, k, box, blues(shade), blues(shade + _CURVE), number)
        axes.set_xlim(box[:2])
        axes.set_ylim(box[2:])
        axes.set_xlabel(parameter_label(first))
        axes.set_ylabel(parameter_label(second))
        if legend:
            _name_shades(axes, wavenumbers, [blues(shade) for shade in shades])
    return axes


def _draw(
    axes: Axes,
    stability_map: xr.Dataset,
    k: int,
    box: Box,
    fill: Any,
    line: Any,
    number: int,
) -> None:
    curves = curves_in(stability_map, k)
    corner = float(stability_map["growth_rate"].sel(k=k).values[0, 0])
    inside = region(curves, box, corner > 0.0)
    zorder = 1.0 + 0.9 * number / (number + 1.0)
    if inside is not None:
        axes.add_patch(PathPatch(inside, facecolor=fill, edgecolor="none", zorder=zorder))
    for curve in curves:
        axes.plot(*curve.T, color=line, linewidth=0.8, zorder=zorder, solid_capstyle="butt")


def _name_shades(axes: Axes, wavenumbers: list[int], colours: list[Any]) -> None:
    nothing = Patch(facecolor="none", edgecolor="none", label="unstable $k$ =")
    named = [
        Patch(facecolor=colour, edgecolor="none", label=str(k))
        for k, colour in zip(wavenumbers, colours, strict=False)
    ]
    keys = axes.legend(
        handles=[nothing, *named],
        loc="lower center",
        bbox_to_anchor=(0.5, 1.0),
        ncols=len(named) + 1,
        frameon=False,
        handlelength=1.0,
        handleheight=0.9,
        handletextpad=0.4,
        columnspacing=0.9,
        borderpad=0.2,
    )
    axes.add_artist(keys)  # a later legend, of symbols on top, does not replace it
    keys.set_clip_on(False)
    axes.legend_ = None
