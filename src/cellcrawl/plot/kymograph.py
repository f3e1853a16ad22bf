"""Kymographs: fields of the edge over time and arclength (Fig. 3 B-E of the paper)."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.image import AxesImage

from cellcrawl import observables
from cellcrawl.arguments import checked
from cellcrawl.errors import InputError
from cellcrawl.observables.inputs import edge_field
from cellcrawl.plot.colouring import colour_bar, colouring
from cellcrawl.plot.inputs import drawable
from cellcrawl.plot.labels import time_label
from cellcrawl.plot.scales import SCALES, Limits
from cellcrawl.plot.style import COLUMN, PAGE, axes_or_new, figure_of, paper_figure, several_axes
from cellcrawl.validation import known_names, table

_PANELS = ("bound_fraction", "off_rate", "friction", "curvature")
_AXIS_LABELS = {"front": "$s/L$ from front", "material": "$s/L$"}


@checked
def kymograph(
    dataset: xr.Dataset,
    field: str = "bound_fraction",
    *,
    origin: str = "front",
    limits: Limits | None = None,
    colormap: str | None = None,
    colorbar: bool = True,
    ax: Axes | None = None,
) -> Axes:
    """Draw a field of the edge over time and normalised arclength.

    Parameters
    ----------
    dataset : Dataset
        A run.
    field : str
        A field on the edge.
    origin : {"front", "material"}
        The front in the middle, or a material point at the bottom; see `observables.kymograph`.
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
        For an unknown field or origin, a cell that never moves and so has no front, or
        a dataset that is no run.

    Notes
    -----
    Curvature has a scale that is linear up to the curvature of the round cell and logarithmic
    beyond, so that corners do not drown the rest. The limits leave out the outer half percent of
    the values; arrows on the colour bar say where.
    """
    run = drawable(dataset)
    with axes_or_new(ax, COLUMN, 1.9) as axes:
        _draw(axes, run, field, origin, limits, colormap, colorbar)
        axes.set(xlabel=time_label(run), ylabel=_AXIS_LABELS[origin])
    return axes


@checked
def kymographs(
    dataset: xr.Dataset,
    fields: Sequence[str] = _PANELS,
    *,
    origin: str = "front",
    limits: Mapping[str, Limits] | None = None,
    colormap: str | None = None,
    colorbar: bool = True,
    axes: Sequence[Axes] | None = None,
) -> Figure:
    """Draw the kymographs of bound fraction, off-rate, friction and curvature on one page.

    Parameters
    ----------
    dataset : Dataset
        A run.
    fields : sequence of str
        Other fields on the edge, one panel each.
    origin : {"front", "material"}
        The front in the middle, or a material point at the bottom; see `observables.kymograph`.
    limits : mapping of str to (float, float), optional
        Ends of the colour scales of some fields, by name; the fields' own unless given.
    colormap : str, optional
        A colour map of matplotlib's for all; the fields' own unless given.
    colorbar : bool
        Add a colour bar to each.
    axes : sequence of Axes, optional
        Where to draw, one for each field; a new figure unless given.

    Returns
    -------
    Figure

    Raises
    ------
    InputError
        For an unknown field or origin, a cell that never moves and so has no front, axes that are
        not as many as the fields, or a dataset that is no run.
    """
    run = drawable(dataset)
    names = [fields] if isinstance(fields, str) else [edge_field(field) for field in fields]
    if not names:
        raise InputError("fields is empty: give at least one field on the edge")
    given = table("limits", {} if limits is None else limits)
    known_names("limits", given, names)
    options: Any = (origin, given, colormap, colorbar)
    if axes is not None:
        panels = several_axes(axes, len(names), "one for each field")
        _draw_several(panels, run, names, *options)
        for panel in panels:
            panel.set(xlabel=time_label(run), ylabel=_AXIS_LABELS[origin])
        return figure_of(panels[0])
    columns = 1 if len(names) == 1 else 2
    rows = -(-len(names) // columns)
    with paper_figure(0.5 * PAGE * columns, 0.2 + 1.6 * rows, shown=True) as figure:
        grid = figure.subplots(rows, columns, sharex=True, sharey=True, squeeze=False)
        panels = grid.ravel().tolist()
        for unused in panels[len(names) :]:
            unused.remove()
        _draw_several(panels[: len(names)], run, names, *options)
        for number, panel in enumerate(panels[: len(names)]):
            if number + columns >= len(names):
                panel.set_xlabel(time_label(run))
                panel.tick_params(labelbottom=True)
            if number % columns == 0:
                panel.set_ylabel(_AXIS_LABELS[origin])
    return figure


def _draw_several(
    panels: Sequence[Axes],
    run: xr.Dataset,
    fields: Sequence[str],
    origin: str,
    limits: Mapping[str, Limits],
    colormap: str | None,
    colorbar: bool,
) -> None:
    for panel, field in zip(panels, fields, strict=True):
        _draw(panel, run, field, origin, limits.get(field), colormap, colorbar)
        panel.set_title(f"{SCALES[field].name} {SCALES[field].symbol}", loc="left")


def _draw(
    ax: Axes,
    run: xr.Dataset,
    field: str,
    origin: str,
    limits: Limits | None,
    colormap: str | None,
    colorbar: bool,
) -> AxesImage:
    shown = observables.kymograph(run, field, origin)
    times, arclength = shown["time"].values, shown["arclength"].values
    values = _on_even_times(times, shown.values)
    half_t = 0.5 * (times[-1] - times[0]) / max(times.size - 1, 1) or 0.5  # one record: a band
    half_s = 0.5 / arclength.size
    colours = colouring(run, field, values, limits, colormap)
    image = ax.imshow(
        values.T,
        extent=(
            float(times[0] - half_t),
            float(times[-1] + half_t),
            float(arclength[0] - half_s),
            float(arclength[-1] + half_s),
        ),
        norm=colours.norm,
        cmap=colours.colormap,
        origin="lower",
        aspect="auto",
    )
    if times.size > 1:
        ax.set_xlim(float(times[0]), float(times[-1]))
    ax.set_yticks([-0.5, 0.0, 0.5] if origin == "front" else [0.0, 0.5, 1.0])
    if colorbar:
        colour_bar(image, ax, colours, values, short=True)
    return image


def _on_even_times(times: np.ndarray, values: np.ndarray) -> np.ndarray:
    """Return ``values`` (time, node) at evenly spaced times: the last record may be nearer."""
    even = np.linspace(times[0], times[-1], times.size)
    if times.size == 1 or np.allclose(times, even, rtol=0.0, atol=1e-3 * (even[1] - even[0])):
        return values
    after = np.clip(np.searchsorted(times, even), 1, times.size - 1)
    part = ((even - times[after - 1]) / (times[after] - times[after - 1]))[:, None]
    blended: np.ndarray = (1.0 - part) * values[after - 1] + part * values[after]
    return blended
