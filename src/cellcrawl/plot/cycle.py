"""A stretch of a run, as one period: a quantity over time above the cell's shapes (Fig. 5)."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from cellcrawl.arguments import checked
from cellcrawl.data.units import typical_radius
from cellcrawl.errors import InputError
from cellcrawl.observables import centroid_velocity
from cellcrawl.observables.inputs import edge_field
from cellcrawl.plot.colouring import Colouring, colour_bar, colouring
from cellcrawl.plot.edge import (
    arrow_time,
    draw_cell,
    draw_velocity,
    edge_points,
    round_length,
    scale_bar,
)
from cellcrawl.plot.inputs import drawable, record_at
from cellcrawl.plot.labels import SERIES, time_label
from cellcrawl.plot.scales import Limits
from cellcrawl.plot.style import INK, PAGE, figure_of, on, paper_figure, several_axes
from cellcrawl.plot.time_series import draw_series, series_values
from cellcrawl.validation import known_names, real_number, whole_number

_GAP = 0.25  # between two cells, in R_0
_ARROW = 3.5  # length of the velocity's arrow, in units of time


@checked
def cycle(
    dataset: xr.Dataset,
    start: float,
    duration: float,
    *,
    shapes: int = 8,
    quantity: str = "tension",
    field: str = "bound_fraction",
    limits: Limits | None = None,
    colormap: str | None = None,
    colorbar: bool = True,
    axes: Sequence[Axes] | None = None,
) -> Figure:
    """Draw a quantity over a stretch of a run, and under it the cell at even times.

    Each cell stands below its time, as it lies on the substrate, with the velocity of its centroid
    as an arrow.

    Parameters
    ----------
    dataset : Dataset
        A run.
    start, duration : float
        The stretch, as one period found by `observables.tension_oscillation`.
    shapes : int
        Number of cells, 2 to 16.
    quantity : str
        What is drawn over time, as in `time_series`.
    field : str
        The field on the edge that colours it.
    limits : (float, float), optional
        Ends of the colour scale; the field's own unless given.
    colormap : str, optional
        A colour map of matplotlib's; the field's own unless given.
    colorbar : bool
        Add a colour bar.
    axes : (Axes, Axes), optional
        Where to draw the quantity and the cells; a new figure unless given.

    Returns
    -------
    Figure

    Raises
    ------
    InputError
        For a stretch that is not within the run, an unknown quantity or field, axes that are not
        two, or a dataset that is no run.
    """
    run = drawable(dataset)
    edge_field(field)
    known_names("plot.cycle", [quantity], SERIES)
    count = whole_number("shapes", shapes, 2, 16)
    long = real_number("duration", duration, 0.0, 1e9, open_low=True)
    times = start + long * (np.arange(count) + 0.5) / count
    records = [record_at(run, time) for time in (start, *times, start + long)]
    if len(set(records)) < len(records):
        raise InputError(
            f"duration = {long:g} has too few records for {count} shapes: save more often, or "
            "draw fewer"
        )
    stretch = run.isel(time=slice(records[0], records[-1] + 1))
    shown = run.isel(time=records[1:-1])
    colours = colouring(run, field, shown[field].values, limits, colormap)
    if axes is not None:
        above, below = several_axes(axes, 2, "one for the quantity, one for the cells")
        _draw((above, below), stretch, shown, quantity, field, colours, colorbar)
        return figure_of(above)
    with paper_figure(PAGE, 2.8, shown=True) as figure:
        panels = figure.subplots(2, 1, height_ratios=(1.4, 1.0)).tolist()
        _draw(panels, stretch, shown, quantity, field, colours, colorbar)
    return figure


def _draw(
    axes: Sequence[Axes],
    stretch: xr.Dataset,
    shown: xr.Dataset,
    quantity: str,
    field: str,
    colours: Colouring,
    colorbar: bool,
) -> None:
    above, below = axes
    draw_series(above, stretch, quantity)
    heights = series_values(shown, quantity).values
    above.plot(shown["time"].values, heights, "o", color=on(above, INK), markersize=2.5, zorder=3)
    above.set_xlabel(time_label(stretch))
    outlines = [edge_points(shown, record) for record in range(shown.sizes["time"])]
    middles = [0.5 * (outline.min(axis=0) + outline.max(axis=0)) for outline in outlines]
    size = max(float(np.ptp(outline, axis=0).max()) for outline in outlines)
    velocity, arrow = centroid_velocity(shown).values, arrow_time(shown, _ARROW)
    gap, margin = (part * typical_radius(shown) for part in (_GAP, 0.1))
    for number, (outline, middle) in enumerate(zip(outlines, middles, strict=True)):
        place = np.array([(number + 0.5) * (size + gap), 0.0]) - middle
        values = shown[field].values[number]
        edge = draw_cell(below, outline + place, values, colours, linewidth=1.8)
        centre = np.array([shown["centroid_x"].values[number], shown["centroid_y"].values[number]])
        draw_velocity(below, centre + place, velocity[number], arrow)
    below.set_xlim(0.0, len(outlines) * (size + gap))
    below.set_ylim(-0.5 * size - margin, 0.5 * size + margin)
    below.set_aspect("equal", anchor="N")
    below.set_axis_off()
    scale_bar(below, shown, round_length(0.5 * size))
    if colorbar:
        colour_bar(edge, list(axes), colours, shown[field].values, fraction=0.03)
