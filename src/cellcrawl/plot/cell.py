"""The cell at one instant, and at several side by side (Figs. 3 A and 5 of the paper)."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.colors import Normalize
from matplotlib.figure import Figure

from cellcrawl.errors import InputError
from cellcrawl.observables import centroid_velocity
from cellcrawl.observables.inputs import edge_field
from cellcrawl.plot.edge import (
    colour_bar,
    draw_cell,
    draw_velocity,
    edge_points,
    frame,
    round_length,
    scale_bar,
)
from cellcrawl.plot.inputs import drawable, record_at, records_at
from cellcrawl.plot.scales import Limits, norm_for
from cellcrawl.plot.style import COLUMN, INK, PAGE, axes_or_new, figure_of, paper_figure

_ARROW = 4.0  # length of the velocity's arrow, in units of time
_IN_A_ROW = 6


def cell(
    dataset: xr.Dataset,
    time: float | None = None,
    *,
    field: str = "bound_fraction",
    limits: Limits | None = None,
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
    with axes_or_new(ax, COLUMN, 0.85 * COLUMN, equal=True) as axes:
        edge = draw_cell(
            axes, points, values, field, norm_for(field, values, limits), linewidth=2.5
        )
        _draw_centroid(axes, run, record, velocity)
        low, high = points.min(axis=0), points.max(axis=0)
        middle, reach = 0.5 * (low + high), 0.5 * float(np.max(high - low)) + 0.15
        axes.set_xlim(middle[0] - reach, middle[0] + reach)
        axes.set_ylim(middle[1] - reach, middle[1] + reach)
        axes.set_aspect("equal")
        axes.set(xlabel="$x$ ($R_0$)", ylabel="$y$ ($R_0$)", title=_time_label(run, record))
        if colorbar:
            colour_bar(edge, axes, field, values)
    return axes


def snapshots(
    dataset: xr.Dataset,
    times: Any,
    *,
    field: str = "bound_fraction",
    limits: Limits | None = None,
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
    norm = norm_for(field, values, limits)
    if axes is not None:
        if len(axes) != len(records):
            raise InputError(f"there are {len(axes)} axes for {len(records)} times")
        edge = _draw_all(axes, run, records, field, norm, velocity)
        if colorbar:
            colour_bar(edge, list(axes), field, values, fraction=0.03, shrink=0.8)
        return figure_of(axes[0])
    columns = min(len(records), _IN_A_ROW)
    rows = -(-len(records) // columns)
    side = min((PAGE - 0.7) / columns, 1.6)
    with paper_figure(side * columns + 0.7, (side + 0.2) * rows + 0.2, equal=True) as figure:
        panels = figure.subplots(rows, columns, squeeze=False).ravel().tolist()
        for panel in panels[len(records) :]:
            panel.set_axis_off()
        edge = _draw_all(panels, run, records, field, norm, velocity)
        if colorbar:
            colour_bar(edge, panels, field, values, fraction=0.03, shrink=0.8)
    return figure


def _draw_all(
    panels: Sequence[Axes],
    run: xr.Dataset,
    records: Sequence[int],
    field: str,
    norm: Normalize,
    velocity: bool,
) -> LineCollection:
    """Draw the cell of each record on its panel, all at one scale; return the last edge."""
    outlines = [edge_points(run, record) for record in records]
    reach = 0.5 * max(float(np.ptp(outline, axis=0).max()) for outline in outlines) + 0.1
    start = np.array([run["centroid_x"].values[0], run["centroid_y"].values[0]])
    for panel, record, outline in zip(panels, records, outlines, strict=False):
        colours = run[field].isel(time=record).values
        edge = draw_cell(panel, outline, colours, field, norm, linewidth=1.8)
        middle = 0.5 * (outline.min(axis=0) + outline.max(axis=0))
        frame(panel, middle - reach, middle + reach, 0.0)
        if np.all(np.abs(start - middle) < reach):
            panel.plot(*start, "o", color=INK, markersize=2.0, zorder=4)
        _draw_centroid(panel, run, record, velocity)
        panel.set_title(_time_label(run, record))
    scale_bar(panels[0], round_length(reach))
    return edge


def _draw_centroid(ax: Axes, run: xr.Dataset, record: int, velocity: bool) -> None:
    now = run.isel(time=[record])
    centre = np.array([now["centroid_x"].values[0], now["centroid_y"].values[0]])
    ax.plot(*centre, "o", color=INK, markersize=3.0, zorder=5)
    if velocity:
        draw_velocity(ax, centre, centroid_velocity(now).values[0], _ARROW)


def _time_label(run: xr.Dataset, record: int) -> str:
    return f"$t$ = {float(run['time'].values[record]):.4g}"
