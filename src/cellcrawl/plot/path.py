"""Cell contours along the centroid's path (Fig. 4 B-J of the paper)."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure

from cellcrawl.arguments import checked
from cellcrawl.data.units import typical_radius
from cellcrawl.errors import InputError
from cellcrawl.observables import speed
from cellcrawl.observables.inputs import edge_field
from cellcrawl.plot.colouring import Colouring, colour_bar, colouring
from cellcrawl.plot.edge import draw_cell, edge_points, frame, scale_bar
from cellcrawl.plot.ground import draw_ground
from cellcrawl.plot.inputs import drawable, record_at
from cellcrawl.plot.labels import length_unit, time_text
from cellcrawl.plot.scales import Limits
from cellcrawl.plot.style import BODY, COLUMN, PAGE, TRACK, axes_or_new, on, paper_figure
from cellcrawl.validation import real_number, table

_STEPS = (1.0, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 7.5, 8.0, 10.0)
_MARGIN = 0.2  # around the contours, in R_0
_NARROWEST = 0.7  # width over height of the picture
_MOST = 1000
_APART = 0.45  # in R_0: between two times that are written
_NEAREST = 0.4  # of `every`: nearer contours than this are not added at the end


@checked
def path(
    dataset: xr.Dataset,
    every: float | None = None,
    *,
    field: str = "bound_fraction",
    limits: Limits | None = None,
    colormap: str | None = None,
    colorbar: bool = True,
    times: bool = False,
    ax: Axes | None = None,
) -> Axes:
    """Draw cell contours along the path of the centroid, coloured by a field.

    Parameters
    ----------
    dataset : Dataset
        A run.
    every : float, optional
        Time between contours, from the first record on; unless given, a round time in which the
        cell moves by about its own diameter. The last record is always the last contour when the
        run ended early.
    field : str
        The field on the edge that colours it.
    limits : (float, float), optional
        Ends of the colour scale; the field's own unless given.
    colormap : str, optional
        A colour map of matplotlib's; the field's own unless given.
    colorbar : bool
        Add a colour bar.
    times : bool
        Write the time of each contour in it, unless that would cover the time before.
    ax : Axes, optional
        Where to draw, in the shape that it has; the only axes of a new figure unless given.

    Returns
    -------
    Axes

    Raises
    ------
    InputError
        For an unknown field, an ``every`` that is not above 0, or a dataset that is no run.
    """
    run = drawable(dataset)
    edge_field(field)
    step = _step(run, every)
    records = _contours(run, step)
    values = run[field].isel(time=records).values
    colours = colouring(run, field, values, limits, colormap)
    low, high = _box(run, records)
    wide, tall = high - low
    height = float(np.clip(COLUMN * 0.85 * tall / wide + 0.25, 1.4, 1.5 * COLUMN))
    with axes_or_new(ax, COLUMN, height, equal=True) as axes:
        frame(axes, low, high, fill=ax is not None)
        draw_ground(axes, run, low, high)
        edge = _draw(axes, run, records, values, colours, times)
        scale_bar(axes, run)
        _write_caption(axes, run, step)
        if colorbar:
            colour_bar(edge, axes, colours, values)
    return axes


@checked
def paths(
    runs: Mapping[str, xr.Dataset],
    every: float | None = None,
    *,
    field: str = "bound_fraction",
    limits: Limits | None = None,
    colormap: str | None = None,
    colorbar: bool = True,
) -> Figure:
    """Draw the paths of several runs side by side, all at one scale and with one colour bar.

    Parameters
    ----------
    runs : mapping of str to Dataset
        Runs by their titles, in one system of units.
    every, field, limits, colormap, colorbar
        As in `path`, for all of them.

    Returns
    -------
    Figure

    Raises
    ------
    InputError
        For no runs, runs in different units, or as for `path`.
    """
    shown = {str(title): drawable(run) for title, run in table("runs", runs).items()}
    edge_field(field)
    if not shown:
        raise InputError("there are no runs to draw: give at least one by its title")
    if len({length_unit(run) for run in shown.values()}) > 1:
        raise InputError("the runs are in different units: put all into one with Scales.dataset")
    steps = {title: _step(run, every) for title, run in shown.items()}
    records = {title: _contours(run, steps[title]) for title, run in shown.items()}
    values = {title: run[field].isel(time=records[title]).values for title, run in shown.items()}
    together = np.concatenate([part.ravel() for part in values.values()])
    colours = colouring(next(iter(shown.values())), field, together, limits, colormap)
    boxes = {title: _box(run, records[title]) for title, run in shown.items()}
    tall = max(float((high - low)[1]) for low, high in boxes.values())
    widths = [float((high - low)[0]) for low, high in boxes.values()]
    height = np.clip((PAGE - 0.7) * tall / sum(widths) + 0.5, 1.4, 1.2 * PAGE)
    with paper_figure(PAGE, float(height), equal=True, shown=True) as figure:
        panels = figure.subplots(1, len(shown), width_ratios=widths, squeeze=False).ravel().tolist()
        for panel, (title, run) in zip(panels, shown.items(), strict=True):
            low, high = boxes[title]
            spare = np.array([0.0, 0.5 * (tall - (high - low)[1])])
            frame(panel, low - spare, high + spare)
            draw_ground(panel, run, low - spare, high + spare)
            edge = _draw(panel, run, records[title], values[title], colours, False)
            _write_caption(panel, run, steps[title])
            panel.set_title(title)
        scale_bar(panels[0], run)
        if colorbar:
            colour_bar(edge, panels, colours, together, fraction=0.03, shrink=0.8)
    return figure


def _step(run: xr.Dataset, every: float | None) -> float:
    if every is None:
        return default_every(run)
    return real_number("every", every, 0, 1e9, open_low=True)


def _draw(
    axes: Axes,
    run: xr.Dataset,
    records: list[int],
    values: np.ndarray,
    colours: Colouring,
    times: bool,
) -> LineCollection:
    """Draw the track, and the cell at each record; return the last edge."""
    track = _track(run)
    axes.plot(*track.T, color=TRACK, linewidth=0.9, zorder=3.0, solid_capstyle="round")
    axes.plot(*track[0], "o", color=TRACK, markersize=2.5, zorder=3.1)
    apart = _APART * typical_radius(run)
    last: np.ndarray | None = None
    for number, (record, on_edge) in enumerate(zip(records, values, strict=True)):
        outline = edge_points(run, record)
        edge = draw_cell(axes, outline, on_edge, colours, linewidth=1.5, zorder=2.0 + 1e-4 * number)
        middle = outline.mean(axis=0)
        if times and (last is None or np.hypot(*(middle - last)) > apart):
            last = middle
            axes.text(
                float(middle[0]),
                float(middle[1]),
                f"{float(run['time'][record]):.4g}",
                ha="center",
                va="center",
                fontsize="small",
                zorder=3.2,
                bbox={"facecolor": on(axes, BODY), "edgecolor": "none", "alpha": 0.8, "pad": 0.6},
            )
    return edge


def _track(run: xr.Dataset) -> np.ndarray:
    return np.column_stack([run["centroid_x"].values, run["centroid_y"].values])


def _write_caption(axes: Axes, run: xr.Dataset, step: float) -> None:
    axes.annotate(
        _caption(run, step),
        (1.0, 0.0),
        xytext=(0.0, -3.0),
        xycoords="axes fraction",
        textcoords="offset points",
        ha="right",
        va="top",
    )


def default_every(dataset: xr.Dataset) -> float:
    """Return a round time in which the cell moves by about its own diameter.

    Of the round times near it, the one that best divides the run.
    """
    times = dataset["time"].values
    duration = float(times[-1] - times[0])
    if duration == 0.0:
        return 1.0
    pace = float(np.median(speed(dataset).values))
    diameter = 2.0 * float(np.sqrt(np.median(dataset["area"].values) / np.pi))
    wanted = min(0.95 * diameter / pace, duration) if pace > 0.0 else duration
    power = 10.0 ** np.floor(np.log10(wanted))
    near = [
        step * power * scale
        for scale in (0.1, 1.0)
        for step in _STEPS
        if 0.8 <= step * power * scale / wanted <= 1.5
    ]
    return float(min(near, key=lambda step: (_left_over(duration, step), abs(step - wanted))))


def _left_over(duration: float, step: float) -> float:
    """Return the part of a step by which the last contour misses the end, in tenths."""
    return float(round(10.0 * (duration / step + 1e-6) % 10.0) % 10)


def _contours(dataset: xr.Dataset, every: float) -> list[int]:
    times = dataset["time"].values
    first, last = float(times[0]), float(times[-1])
    if (last - first) / every > _MOST:
        raise InputError(
            f"every = {every:g} would draw more than {_MOST} contours: give a longer one"
        )
    chosen = first + every * np.arange(int((last - first) / every * (1.0 + 1e-9)) + 1)
    records = [record_at(dataset, min(time, last)) for time in chosen]
    if _ended_early(dataset):
        if len(records) > 1 and last - chosen[-1] < _NEAREST * every:
            records.pop()
        records.append(times.size - 1)
    return list(dict.fromkeys(records))


def _caption(dataset: xr.Dataset, every: float) -> str:
    """Say how far apart the contours are, and when the last one is if the run ended early."""
    apart = rf"$\Delta t$ = {time_text(dataset, every)}"
    if not _ended_early(dataset):
        return apart
    return f"{apart}, end at {time_text(dataset, float(dataset['time'].values[-1]))}"


def _ended_early(dataset: xr.Dataset) -> bool:
    return bool(dataset.attrs.get("status", "completed") != "completed")


def _box(run: xr.Dataset, records: list[int]) -> tuple[np.ndarray, np.ndarray]:
    """Return the corners of the box around all contours and the track, with a margin.

    It is wide enough for what stands below it.
    """
    clouds = [*(edge_points(run, record) for record in records), _track(run)]
    low = np.min([cloud.min(axis=0) for cloud in clouds], axis=0)
    high = np.max([cloud.max(axis=0) for cloud in clouds], axis=0)
    missing = _NARROWEST * (high[1] - low[1]) - (high[0] - low[0])
    margin = _MARGIN * typical_radius(run) + np.array([0.5 * max(missing, 0.0), 0.0])
    return low - margin, high + margin


def path_shape(run: xr.Dataset, every: float | None = None) -> float:
    """Return width over height of what `path` shows of a run."""
    low, high = _box(run, _contours(run, _step(run, every)))
    wide, tall = high - low
    return float(wide / tall)
