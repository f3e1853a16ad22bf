"""Kymographs: fields of the edge over time and arclength (Fig. 3 B-E of the paper)."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.image import AxesImage

from cellcrawl import observables
from cellcrawl.errors import InputError
from cellcrawl.plot.edge import colour_bar
from cellcrawl.plot.inputs import drawable
from cellcrawl.plot.scales import SCALES, TIME_LABEL, Limits, norm_for
from cellcrawl.plot.style import COLUMN, PAGE, axes_or_new, figure_of, paper_figure

_PANELS = ("bound_fraction", "off_rate", "friction", "curvature")
_AXIS_LABELS = {"front": "$s/L$ from front", "material": "$s/L$"}


def kymograph(
    dataset: xr.Dataset,
    field: str = "bound_fraction",
    *,
    origin: str = "front",
    limits: Limits | None = None,
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
        _draw(axes, run, field, origin, limits)
        axes.set(xlabel=TIME_LABEL, ylabel=_AXIS_LABELS[origin])
    return axes


def kymographs(
    dataset: xr.Dataset, *, origin: str = "front", axes: Sequence[Axes] | None = None
) -> Figure:
    """Draw the kymographs of bound fraction, off-rate, friction and curvature on one page.

    Parameters
    ----------
    dataset : Dataset
        A run.
    origin : {"front", "material"}
        The front in the middle, or a material point at the bottom; see `observables.kymograph`.
    axes : four Axes, optional
        Where to draw; a new figure unless given.

    Returns
    -------
    Figure

    Raises
    ------
    InputError
        For an unknown origin, a cell that never moves and so has no front, axes that are not four,
        or a dataset that is no run.
    """
    run = drawable(dataset)
    if axes is not None:
        if len(axes) != len(_PANELS):
            raise InputError(f"kymographs need {len(_PANELS)} axes, not {len(axes)}")
        _draw_four(axes, run, origin)
        for panel in axes:
            panel.set(xlabel=TIME_LABEL, ylabel=_AXIS_LABELS[origin])
        return figure_of(axes[0])
    with paper_figure(PAGE, 3.4) as figure:
        panels = figure.subplots(2, 2, sharex=True, sharey=True)
        _draw_four(panels.ravel().tolist(), run, origin)
        for panel in panels[-1]:
            panel.set_xlabel(TIME_LABEL)
        for panel in panels[:, 0]:
            panel.set_ylabel(_AXIS_LABELS[origin])
    return figure


def _draw_four(panels: Sequence[Axes], run: xr.Dataset, origin: str) -> None:
    for panel, field in zip(panels, _PANELS, strict=True):
        _draw(panel, run, field, origin, None)
        panel.set_title(f"{SCALES[field].name} {SCALES[field].symbol}", loc="left")


def _draw(ax: Axes, run: xr.Dataset, field: str, origin: str, limits: Limits | None) -> AxesImage:
    shown = observables.kymograph(run, field, origin)
    times, arclength = shown["time"].values, shown["arclength"].values
    values = _on_even_times(times, shown.values)
    half_t = 0.5 * (times[-1] - times[0]) / max(times.size - 1, 1) or 0.5  # one record: a band
    half_s = 0.5 / arclength.size
    image = ax.imshow(
        values.T,
        extent=(
            float(times[0] - half_t),
            float(times[-1] + half_t),
            float(arclength[0] - half_s),
            float(arclength[-1] + half_s),
        ),
        norm=norm_for(field, values, limits),
        cmap=SCALES[field].colormap,
        origin="lower",
        aspect="auto",
    )
    if times.size > 1:
        ax.set_xlim(float(times[0]), float(times[-1]))
    ax.set_yticks([-0.5, 0.0, 0.5] if origin == "front" else [0.0, 0.5, 1.0])
    colour_bar(image, ax, field, values, short=True)
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
