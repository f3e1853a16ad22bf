"""Tension, speed and the measures of shape over time."""

from __future__ import annotations

from collections.abc import Sequence

import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from cellcrawl import observables
from cellcrawl.errors import InputError
from cellcrawl.plot.inputs import drawable
from cellcrawl.plot.scales import SERIES_LABELS, TIME_LABEL
from cellcrawl.plot.style import COLUMN, paper_figure
from cellcrawl.validation import known_names

_COLOURS = {
    "tension": "#0072b2",
    "speed": "#d55e00",
    "length": "#009e73",
    "area": "#56607a",
    "circularity": "#b5338a",
}


def time_series(
    dataset: xr.Dataset,
    quantities: Sequence[str] = ("tension", "speed", "length", "area", "circularity"),
) -> Figure:
    """Draw tension, speed, length, area and circularity over time, one above the other.

    Parameters
    ----------
    dataset : Dataset
        A run.
    quantities : sequence of str
        Which of the five, in this order.

    Returns
    -------
    Figure

    Raises
    ------
    InputError
        For an unknown quantity, or a dataset that is no run.
    """
    run = drawable(dataset)
    if isinstance(quantities, str):
        quantities = [quantities]
    known_names("plot.time_series", quantities, SERIES_LABELS)
    if not quantities:
        raise InputError(f"quantities is empty: known names: {', '.join(SERIES_LABELS)}")
    with paper_figure(COLUMN, 0.35 + 0.85 * len(quantities)) as figure:
        panels = figure.subplots(len(quantities), 1, sharex=True, squeeze=False).ravel()
        for panel, quantity in zip(panels, quantities, strict=True):
            draw_series(panel, run, quantity)
        panels[-1].set_xlabel(TIME_LABEL)
        figure.align_ylabels(list(panels))
    return figure


def draw_series(ax: Axes, run: xr.Dataset, quantity: str) -> None:
    """Draw one quantity over time, with its label."""
    times = run["time"].values
    marker = "." if times.size == 1 else ""
    ax.plot(times, _values(run, quantity).values, marker=marker, color=_COLOURS[quantity])
    ax.set_ylabel("\n".join(SERIES_LABELS[quantity]))
    if times[-1] > times[0]:
        ax.set_xlim(float(times[0]), float(times[-1]))
    ax.margins(y=0.08)
    ax.spines[["top", "right"]].set_visible(False)


def _values(run: xr.Dataset, quantity: str) -> xr.DataArray:
    if quantity == "speed":
        return observables.speed(run)
    if quantity == "circularity":
        return observables.circularity(run)
    return run[quantity]
