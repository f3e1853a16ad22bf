"""Kymographs of a flat edge."""

from __future__ import annotations

from typing import Final

import numpy as np
import xarray as xr
from matplotlib.axes import Axes

from cellcrawl.arguments import checked
from cellcrawl.errors import InputError
from cellcrawl.one_dimensional.waves import check_flat_edge
from cellcrawl.plot.colouring import colour_bar, colouring
from cellcrawl.plot.labels import length_unit, time_label, with_unit
from cellcrawl.plot.scales import Limits
from cellcrawl.plot.style import COLUMN, axes_or_new
from cellcrawl.validation import one_of

_SCALE_OF: Final = {
    "bound_fraction": "bound_fraction",
    "off_rate": "off_rate",
    "friction": "friction",
    "curvature": "curvature",
    "velocity": "normal_velocity",
}


@checked
def flat_edge(
    dataset: xr.Dataset,
    field: str = "bound_fraction",
    *,
    limits: Limits | None = None,
    colormap: str | None = None,
    colorbar: bool = True,
    ax: Axes | None = None,
) -> Axes:
    """Draw a field of a flat edge over time and position along it.

    Parameters
    ----------
    dataset : Dataset
        From `one_dimensional.simulate_flat_edge`, with records at even times.
    field : {"bound_fraction", "off_rate", "friction", "curvature", "velocity"}
        What to draw.
    limits : (float, float), optional
        Ends of the colour scale; the field's own unless given.
    colormap : str, optional
        A colour map of matplotlib's; the field's own unless given.
    colorbar : bool
        Add a colour bar.
    ax : Axes, optional
        Where to draw; the only axes of a new figure unless given.

    Returns
    -------
    Axes

    Raises
    ------
    InputError
        For an unknown field, a dataset that is no run of a flat edge, or one with fewer than two
        records.
    """
    run = check_flat_edge(dataset)
    scale = _SCALE_OF[one_of("field", field, _SCALE_OF)]
    times, values = run["time"].values, run[field].values
    if times.size < 2:
        raise InputError("this run has fewer than two records: there is no kymograph to draw")
    even = np.linspace(times[0], times[-1], times.size)
    if not np.allclose(times, even, rtol=0.0, atol=0.5 * (even[1] - even[0])):
        raise InputError("the records are not at even times: choose t_end a multiple of save_every")
    half = 0.5 * (even[1] - even[0])
    length = float(run.attrs["length"])
    colours = colouring(run, field, values, limits, colormap, scale)
    with axes_or_new(ax, COLUMN, 1.9) as axes:
        image = axes.imshow(
            values.T,
            extent=(float(times[0] - half), float(times[-1] + half), 0.0, length),
            norm=colours.norm,
            cmap=colours.colormap,
            origin="lower",
            aspect="auto",
        )
        axes.set_xlim(float(times[0]), float(times[-1]))
        axes.set(xlabel=time_label(run), ylabel=with_unit("position $s$", length_unit(run)))
        if colorbar:
            colour_bar(image, axes, colours, values, short=True)
    return axes
