"""Cell contours along the centroid's path (Fig. 4 B-J of the paper)."""

from __future__ import annotations

import numpy as np
import xarray as xr
from matplotlib.axes import Axes

from cellcrawl.errors import InputError
from cellcrawl.observables import speed
from cellcrawl.observables.inputs import edge_field
from cellcrawl.plot.edge import colour_bar, draw_cell, edge_points, frame, scale_bar
from cellcrawl.plot.inputs import drawable, record_at
from cellcrawl.plot.scales import Limits, norm_for
from cellcrawl.plot.style import BODY, COLUMN, TRACK, axes_or_new
from cellcrawl.validation import real_number

_STEPS = (1.0, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 7.5, 8.0, 10.0)
_MARGIN = 0.2  # around the contours, in R_0
_NARROWEST = 0.7  # width over height of the picture
_MOST = 1000
_APART = 0.45  # in R_0: between two times that are written
_NEAREST = 0.4  # of `every`: nearer contours than this are not added at the end


def path(
    dataset: xr.Dataset,
    every: float | None = None,
    *,
    field: str = "bound_fraction",
    limits: Limits | None = None,
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
    colorbar : bool
        Add a colour bar.
    times : bool
        Write the time of each contour in it, unless that would cover the time before.
    ax : Axes, optional
        Where to draw; the only axes of a new figure unless given.

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
    step = (
        default_every(run) if every is None else real_number("every", every, 0, 1e9, open_low=True)
    )
    records = _contours(run, step)
    points = [edge_points(run, record) for record in records]
    track = np.column_stack([run["centroid_x"].values, run["centroid_y"].values])
    low, high = _box([*points, track])
    values = run[field].isel(time=records).values
    norm = norm_for(field, values, limits)
    wide, tall = high - low + 2.0 * _MARGIN
    height = np.clip(COLUMN * 0.85 * tall / wide + 0.25, 1.4, 1.5 * COLUMN)
    with axes_or_new(ax, COLUMN, float(height), equal=True) as axes:
        frame(axes, low, high, _MARGIN)
        axes.plot(*track.T, color=TRACK, linewidth=0.9, zorder=3.0, solid_capstyle="round")
        axes.plot(*track[0], "o", color=TRACK, markersize=2.5, zorder=3.1)
        last: np.ndarray | None = None
        for number, (outline, colours) in enumerate(zip(points, values, strict=True)):
            edge = draw_cell(
                axes, outline, colours, field, norm, linewidth=1.5, zorder=2.0 + 1e-4 * number
            )
            middle = outline.mean(axis=0)
            if times and (last is None or np.hypot(*(middle - last)) > _APART):
                last = middle
                axes.text(
                    float(middle[0]),
                    float(middle[1]),
                    f"{float(run['time'][records[number]]):.4g}",
                    ha="center",
                    va="center",
                    fontsize="small",
                    zorder=3.2,
                    bbox={"facecolor": BODY, "edgecolor": "none", "alpha": 0.8, "pad": 0.6},
                )
        scale_bar(axes)
        axes.annotate(
            _caption(run, step),
            (1.0, 0.0),
            xytext=(0.0, -3.0),
            xycoords="axes fraction",
            textcoords="offset points",
            ha="right",
            va="top",
        )
        if colorbar:
            colour_bar(edge, axes, field, values)
    return axes


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
    apart = rf"$\Delta t$ = {every:.4g}"
    if not _ended_early(dataset):
        return apart
    return f"{apart}, end at $t$ = {float(dataset['time'].values[-1]):.4g}"


def _ended_early(dataset: xr.Dataset) -> bool:
    return bool(dataset.attrs.get("status", "completed") != "completed")


def _box(clouds: list[np.ndarray]) -> tuple[np.ndarray, np.ndarray]:
    """Return the corners of the box around all points, wide enough for what stands below it."""
    low = np.min([cloud.min(axis=0) for cloud in clouds], axis=0)
    high = np.max([cloud.max(axis=0) for cloud in clouds], axis=0)
    missing = _NARROWEST * (high[1] - low[1]) - (high[0] - low[0])
    widen = np.array([0.5 * max(missing, 0.0), 0.0])
    return low - widen, high + widen
