"""The cell at one instant, and at several side by side (Figs. 3 A and 5 of the paper)."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure

from cellcrawl.arguments import checked
from cellcrawl.data.units import typical_radius
from cellcrawl.observables import centroid_velocity
from cellcrawl.observables.inputs import edge_field
from cellcrawl.plot.colouring import Colouring, colour_bar, colouring
from cellcrawl.plot.edge import (
    arrow_time,
    draw_cell,
    draw_velocity,
    edge_points,
    frame,
    round_length,
    scale_bar,
)
from cellcrawl.plot.ground import draw_ground
from cellcrawl.plot.inputs import drawable, record_at, records_at
from cellcrawl.plot.labels import position_label, time_text
from cellcrawl.plot.scales import Limits
from cellcrawl.plot.style import (
    COLUMN,
    INK,
    PAGE,
    axes_or_new,
    figure_of,
    on,
    paper_figure,
    several_axes,
)

_ARROW = 4.0  # length of the velocity's arrow, in units of time
_IN_A_ROW = 6


@checked
def cell(
    dataset: xr.Dataset,
    time: float | None = None,
    *,
    field: str = "bound_fraction",
    limits: Limits | None = None,
    colormap: str | None = None,
    velocity: bool = True,
    colorbar: bool = True,
    ax: Axes | None = None,
) -> Axes:
    """Draw the cell at one instant, its edge coloured by a field.

    Parameters
    ----------
    dataset : Dataset
        A run.
    time : float, optional
        The record nearest this time; the last one unless given.
    field : str
        The field on the edge that colours it.
    limits : (float, float), optional
        Ends of the colour scale; the field's own unless given.
    colormap : str, optional
        A colour map of matplotlib's; the field's own unless given.
    velocity : bool
        Draw the velocity of the centroid as an arrow.
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
        For an unknown field, a time outside the run, or a dataset that is no run.
    """
    run = drawable(dataset)
    edge_field(field)
    record = record_at(run, run["time"].values[-1] if time is None else time)
    points, values = edge_points(run, record), run[field].isel(time=record).values
    colours = colouring(run, field, values, limits, colormap)
    with axes_or_new(ax, COLUMN, 0.85 * COLUMN, equal=True) as axes:
        edge = draw_cell(axes, points, values, colours, linewidth=2.5)
        _draw_centroid(axes, run, record, velocity)
        low, high = points.min(axis=0), points.max(axis=0)
        middle = 0.5 * (low + high)
        reach = 0.5 * float(np.max(high - low)) + 0.15 * typical_radius(run)
        axes.set_xlim(middle[0] - reach, middle[0] + reach)
        axes.set_ylim(middle[1] - reach, middle[1] + reach)
        axes.set_aspect("equal")
        draw_ground(axes, run, middle - reach, middle + reach)
        axes.set(xlabel=position_label(run, "x"), ylabel=position_label(run, "y"))
        axes.set_title(_time_label(run, record))
        if colorbar:
            colour_bar(edge, axes, colours, values)
    return axes


@checked
def snapshots(
    dataset: xr.Dataset,
    times: Any,
    *,
    field: str = "bound_fraction",
    limits: Limits | None = None,
    colormap: str | None = None,
    velocity: bool = False,
    colorbar: bool = True,
    axes: Sequence[Axes] | None = None,
) -> Figure:
    """Draw the cell at several times, side by side at one scale.

    Dots mark the centroid now and, where it is still in view, at the start of the run.

    Parameters
    ----------
    dataset : Dataset
        A run.
    times : sequence of float
        The records nearest these times.
    field : str
        The field on the edge that colours it.
    limits : (float, float), optional
        Ends of the colour scale; the field's own unless given.
    colormap : str, optional
        A colour map of matplotlib's; the field's own unless given.
    velocity : bool
        Draw the velocity of the centroid as an arrow.
    colorbar : bool
        Add a colour bar.
    axes : sequence of Axes, optional
        Where to draw, one for each time; a new figure unless given.

    Returns
    -------
    Figure

    Raises
    ------
    InputError
        For an unknown field, no times, a time outside the run, axes that are not as many as the
        times, or a dataset that is no run.
    """
    run = drawable(dataset)
    edge_field(field)
    records = records_at(run, times)
    values = run[field].isel(time=records).values
    colours = colouring(run, field, values, limits, colormap)
    bar: Any = {"fraction": 0.03, "shrink": 0.8}
    if axes is not None:
        given = several_axes(axes, len(records), "one for each time")
        edge = _draw_all(given, run, records, field, colours, velocity)
        if colorbar:
            colour_bar(edge, given, colours, values, **bar)
        return figure_of(given[0])
    columns = min(len(records), _IN_A_ROW)
    rows = -(-len(records) // columns)
    side = min((PAGE - 0.7) / columns, 1.6)
    width, height = side * columns + 0.7, (side + 0.2) * rows + 0.2
    with paper_figure(width, height, equal=True, shown=True) as figure:
        panels = figure.subplots(rows, columns, squeeze=False).ravel().tolist()
        for panel in panels[len(records) :]:
            panel.set_axis_off()
        edge = _draw_all(panels, run, records, field, colours, velocity)
        if colorbar:
            colour_bar(edge, panels, colours, values, **bar)
    return figure


def _draw_all(
    panels: Sequence[Axes],
    run: xr.Dataset,
    records: Sequence[int],
    field: str,
    colours: Colouring,
    velocity: bool,
) -> LineCollection:
    """Draw the cell of each record on its panel, all at one scale; return the last edge."""
    outlines = [edge_points(run, record) for record in records]
    reach = 0.5 * max(float(np.ptp(outline, axis=0).max()) for outline in outlines)
    reach += 0.1 * typical_radius(run)
    start = np.array([run["centroid_x"].values[0], run["centroid_y"].values[0]])
    for panel, record, outline in zip(panels, records, outlines, strict=False):
        values = run[field].isel(time=record).values
        edge = draw_cell(panel, outline, values, colours, linewidth=1.8)
        middle = 0.5 * (outline.min(axis=0) + outline.max(axis=0))
        frame(panel, middle - reach, middle + reach)
        draw_ground(panel, run, middle - reach, middle + reach)
        if np.all(np.abs(start - middle) < reach):
            panel.plot(*start, "o", color=on(panel, INK), markersize=2.0, zorder=4)
        _draw_centroid(panel, run, record, velocity)
        panel.set_title(_time_label(run, record))
    scale_bar(panels[0], run, round_length(reach))
    return edge


def _draw_centroid(ax: Axes, run: xr.Dataset, record: int, velocity: bool) -> None:
    now = run.isel(time=[record])
    centre = np.array([now["centroid_x"].values[0], now["centroid_y"].values[0]])
    ax.plot(*centre, "o", color=on(ax, INK), markersize=3.0, zorder=5)
    if velocity:
        draw_velocity(ax, centre, centroid_velocity(now).values[0], arrow_time(run, _ARROW))


def _time_label(run: xr.Dataset, record: int) -> str:
    return f"$t$ = {time_text(run, float(run['time'].values[record]))}"
