"""What one picture's colours mean: a field's norm, colour map and label."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import matplotlib as mpl
import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colorbar import Colorbar
from matplotlib.colors import Normalize

from cellcrawl.data.units import units_of
from cellcrawl.plot.labels import field_label
from cellcrawl.plot.scales import SCALES, Limits, extend_for, norm_for, reaches_white, ticks_for
from cellcrawl.plot.style import colormap_for, figure_of


class Colouring(NamedTuple):
    """How the values of a field become colours, and what the colour bar says."""

    norm: Normalize
    colormap: str
    label: str
    short_label: str

    @property
    def limits(self) -> Limits:
        """The ends of the colour scale."""
        assert self.norm.vmin is not None
        assert self.norm.vmax is not None
        return float(self.norm.vmin), float(self.norm.vmax)

    @property
    def needs_rim(self) -> bool:
        """Whether some of the colours would be lost on paper."""
        return reaches_white(self.colormap)


def colouring(
    run: xr.Dataset,
    field: str,
    values: np.ndarray,
    limits: Any = None,
    colormap: str | None = None,
    scale: str | None = None,
) -> Colouring:
    """Return the colours of a field for these values.

    Parameters
    ----------
    run : Dataset
        What the values are from; its units are written.
    field : str
        A variable of it.
    values : array
        All that is going to be shown.
    limits : (float, float), optional
        Ends of the colour scale; those of the field's own for these values unless given.
    colormap : str, optional
        A colour map of matplotlib's; the field's own unless given.
    scale : str, optional
        The field whose look it has, if that has another name.
    """
    look = scale or field
    return Colouring(
        norm_for(look, values, limits, units_of(run)),
        colormap_for(SCALES[look].colormap, colormap),
        field_label(run, field, look),
        field_label(run, field, look, short=True),
    )


def colour_bar(
    mappable: Any,
    ax: Any,
    colours: Colouring,
    values: np.ndarray,
    *,
    short: bool = False,
    **options: Any,
) -> Colorbar:
    """Add the colour bar of a field, with arrows where values lie beyond its ends."""
    first = ax if isinstance(ax, Axes) else np.ravel(np.asarray(ax, dtype=object))[0]
    bar = figure_of(first).colorbar(
        mappable,
        ax=ax,
        extend=extend_for(mappable.norm, values),
        label=colours.short_label if short else colours.label,
        **{"fraction": 0.05, "pad": 0.02, "aspect": 18, **options},
    )
    ticks = ticks_for(mappable.norm)
    if ticks is not None:
        bar.set_ticks(ticks, labels=[f"{tick:g}".replace("-", "\N{MINUS SIGN}") for tick in ticks])
        bar.ax.minorticks_off()
    plain(bar)
    return bar


def shared_bar(
    axes: Sequence[Axes], run: xr.Dataset, field: str, limits: Limits, **options: Any
) -> Colorbar:
    """Add one colour bar beside several axes that were drawn with these ``limits``."""
    values = run[field].values
    colours = colouring(run, field, values, limits)
    shown = ScalarMappable(colours.norm, colours.colormap)
    return colour_bar(shown, list(axes), colours, values, **{"fraction": 0.03, **options})


def plain(bar: Colorbar) -> None:
    """Give a colour bar the house's thin outline and ticks."""
    decoration: Any = bar  # its parts are not typed
    decoration.outline.set_linewidth(0.4)
    decoration.solids.set_rasterized(True)
    bar.ax.tick_params(which="major", length=2, width=mpl.rcParams["ytick.minor.width"])
