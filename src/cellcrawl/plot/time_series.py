"""Tension, speed and the measures of shape over time."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import matplotlib as mpl
import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.layout_engine import ConstrainedLayoutEngine

from cellcrawl import observables
from cellcrawl.arguments import checked
from cellcrawl.errors import InputError
from cellcrawl.plot.inputs import drawable
from cellcrawl.plot.labels import SERIES, series_label, time_label, time_unit
from cellcrawl.plot.style import COLUMN, colormap_for, figure_of, paper_figure, several_axes
from cellcrawl.validation import known_names

_COLOURS = {
    "tension": "#0072b2",
    "speed": "#d55e00",
    "length": "#009e73",
    "area": "#56607a",
    "circularity": "#b5338a",
}


@checked
def time_series(
    dataset: xr.Dataset | Mapping[str, xr.Dataset],
    quantities: Sequence[str] = ("tension", "speed", "length", "area", "circularity"),
    *,
    axes: Sequence[Axes] | None = None,
) -> Figure:
    """Draw tension, speed, length, area and circularity over time, one above the other.

    Parameters
    ----------
    dataset : Dataset or mapping of str to Dataset
        A run; or several by the names the legend gives them, one colour each.
    quantities : sequence of str
        Which of the five, in this order.
    axes : sequence of Axes, optional
        Where to draw, one for each quantity; a new figure unless given.

    Returns
    -------
    Figure

    Raises
    ------
    InputError
        For an unknown quantity, no runs, axes that are not as many as the quantities, or a dataset
        that is no run.
    """
    runs = _named_runs(dataset)
    if isinstance(quantities, str):
        quantities = [quantities]
    known_names("plot.time_series", quantities, SERIES)
    if not quantities:
        raise InputError(f"quantities is empty: known names: {', '.join(SERIES)}")
    if axes is not None:
        given = several_axes(axes, len(quantities), "one for each quantity")
        _draw_all(given, runs, quantities)
        return figure_of(given[0])
    # Ticks are chosen anew once axes have their place: room for a number below the last.
    layout = ConstrainedLayoutEngine(rect=(0.0, 0.0, 0.98, 1.0))
    height = 0.35 + 0.85 * len(quantities)
    with paper_figure(COLUMN, height, layout=layout, shown=True) as figure:
        panels = figure.subplots(len(quantities), 1, sharex=True, squeeze=False).ravel().tolist()
        _draw_all(panels, runs, quantities)
        figure.align_ylabels(panels)
    return figure


def _named_runs(dataset: Any) -> dict[str, xr.Dataset]:
    if isinstance(dataset, xr.Dataset) or not isinstance(dataset, Mapping):
        return {"": drawable(dataset)}
    runs = {str(name): drawable(run) for name, run in dataset.items()}
    if not runs:
        raise InputError("there are no runs to draw: give at least one by name")
    units = {time_unit(run) for run in runs.values()}
    if len(units) > 1:
        raise InputError(f"the runs have times in {' and '.join(sorted(units))}: draw them apart")
    return runs


def _draw_all(
    panels: Sequence[Axes], runs: Mapping[str, xr.Dataset], quantities: Sequence[str]
) -> None:
    several = len(runs) > 1
    colours = mpl.colormaps[colormap_for("viridis")](np.linspace(0.0, 0.9, len(runs)))
    for panel, quantity in zip(panels, quantities, strict=True):
        for colour, (name, run) in zip(colours, runs.items(), strict=True):
            draw_series(panel, run, quantity, colour if several else None, name)
        first = min(float(run["time"][0]) for run in runs.values())
        last = max(float(run["time"][-1]) for run in runs.values())
        if last > first:
            panel.set_xlim(first, last)
    panels[-1].set_xlabel(time_label(next(iter(runs.values()))))
    if several:
        panels[0].legend(frameon=False, handlelength=1.4)


def draw_series(
    ax: Axes, run: xr.Dataset, quantity: str, colour: Any = None, name: str = ""
) -> None:
    """Draw one quantity over time, with its label."""
    times = run["time"].values
    ax.plot(
        times,
        series_values(run, quantity).values,
        marker="." if times.size == 1 else "",
        color=_COLOURS[quantity] if colour is None else colour,
        label=name or None,
    )
    ax.set_ylabel(series_label(run, quantity))
    if times[-1] > times[0]:
        ax.set_xlim(float(times[0]), float(times[-1]))
    ax.margins(y=0.08)
    ax.spines[["top", "right"]].set_visible(False)


def series_values(run: xr.Dataset, quantity: str) -> xr.DataArray:
    """Return one of the quantities of `time_series`."""
    if quantity == "speed":
        return observables.speed(run)
    if quantity == "circularity":
        return observables.circularity(run)
    return run[quantity]
