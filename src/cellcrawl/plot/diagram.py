"""Diagrams of a sweep over one or two parameters: the modes, or the mean of a measure."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import to_rgb
from matplotlib.lines import Line2D
from matplotlib.markers import MarkerStyle
from matplotlib.path import Path

from cellcrawl.arguments import checked
from cellcrawl.errors import InputError
from cellcrawl.plot.along import draw_measure, draw_modes
from cellcrawl.plot.colouring import plain
from cellcrawl.plot.mode_symbols import EDGE, MODE_SYMBOLS
from cellcrawl.plot.scales import Limits, checked_limits, extend_for
from cellcrawl.plot.spacing import edges, prepare
from cellcrawl.plot.style import COLUMN, PAGE, axes_or_new, colormap_for, figure_of
from cellcrawl.plot.symbols import MEASURE_LABELS, parameter_label
from cellcrawl.sweeps import Sweep
from cellcrawl.sweeps.planes import Plane, line, majority, means, only_axis, plane
from cellcrawl.validation import real_number

_HEIGHT = 0.5 * PAGE
_FEW = 8  # points across that have room in a column
_ABOVE = 3.0  # zorder: above a stability map
_FILLS = 0.62  # of the space between points
_SMALLEST, _LARGEST = 3.0, 9.0  # points
_FAINT = 0.45  # of a mode's colour, for its region
_BELOW = -0.17  # of the axes' height: under the label
_KEY_WIDTH = 72.0  # points
_ARC = 24  # vertices of a full pie


@checked
def diagram(
    sweep: Sweep,
    x: str | None = None,
    y: str | None = None,
    *,
    legend: bool = True,
    size: float | None = None,
    ax: Axes | None = None,
) -> Axes:
    """Draw which mode cells take up over two parameters, or along one.

    A point where all runs agree has the mode's colour and marker; one where they differ is a small
    pie of the runs' modes, torn cells included. Points that make no regular grid (see
    `sweeps.refine`) are dots on regions in the colour of the mode of most runs at the nearest
    point; where runs differ the dot is a pie. Where one parameter differs, each mode has a row, and
    a symbol's area is the part of the runs that show it. Points that are evenly spaced in their
    logarithm make a logarithmic axis.

    Parameters
    ----------
    sweep : Sweep
        From `sweep` or `open_sweep`, finished or not.
    x, y : str, optional
        The parameters; the first two that differ unless given. Runs that differ in something else,
        their seeds say, are put together in one point.
    legend : bool
        Name the modes, with the number of runs of each: above the axes, or below yours.
    size : float, optional
        Diameter of the symbols in points, 0.5 to 50; as large as their distance allows unless
        given.
    ax : Axes, optional
        Where to draw, on top of a stability map say; the only axes of a new figure unless given.

    Returns
    -------
    Axes

    Raises
    ------
    InputError
        If there are no rows, nothing that differs, or more than two parameters that do.
    """
    table = _rows(sweep)
    if size is not None:
        size = real_number("size", size, 0.5, 50.0)
    only = only_axis(table, x, y)
    if only:
        return draw_modes(line(table, only), size, ax)
    found = plane(table, x, y)
    few = np.unique(found.x).size <= _FEW
    with axes_or_new(ax, COLUMN if few else PAGE, COLUMN if few else _HEIGHT) as axes:
        if ax is None:
            _frame(axes, found)
        if _is_regular(found):
            _draw_points(axes, found, size or _marker_size(axes, found))
        else:
            _draw_regions(axes, found)
        axes.set_xlabel(parameter_label(found.x_name))
        axes.set_ylabel(parameter_label(found.y_name))
        if legend:
            _name_modes(axes, found, above=ax is None)
    return axes


@checked
def measure_map(
    sweep: Sweep,
    measure: str,
    x: str | None = None,
    y: str | None = None,
    *,
    limits: Limits | None = None,
    colormap: str | None = None,
    colorbar: bool = True,
    ax: Axes | None = None,
) -> Axes:
    """Draw the mean of a measure over two parameters, without torn cells; or along one.

    Parameters
    ----------
    sweep : Sweep
        From `sweep` or `open_sweep`.
    measure : str
        A measured column: "speed", "tension", "circularity", "x_c", "tension_period", ...
    x, y : str, optional
        The parameters; the first two that differ unless given. Where only one differs, the line
        is the mean, and each run has the symbol of its mode.
    limits : (float, float), optional
        Ends of the colour scale, or of the axis where one parameter differs.
    colormap : str, optional
        A colour map of matplotlib's; "viridis" unless given.
    colorbar : bool
        Draw the colour bar.
    ax : Axes, optional
        Where to draw; the only axes of a new figure unless given.

    Returns
    -------
    Axes
        Points are drawn as tiles where they make a regular grid, else as dots; a point without a
        value is left blank.

    Raises
    ------
    InputError
        For an unknown measure, or as for `diagram`.
    """
    table = _rows(sweep)
    values = means(table, measure, x, y)
    ends: Any = (None, None) if limits is None else checked_limits(limits)
    if not np.isfinite(values).any():
        raise InputError(f"no run has a value of {measure}: they may be too short to show it")
    only = only_axis(table, x, y)
    if only:
        return draw_measure(table, line(table, only), measure, values, ends, ax)
    found = plane(table, x, y)
    look: Any = {"cmap": colormap_for("viridis", colormap), "vmin": ends[0], "vmax": ends[1]}
    with axes_or_new(ax, 0.5 * PAGE, 0.4 * PAGE) as axes:
        across, up = np.unique(found.x), np.unique(found.y)
        if ax is None:
            _frame(axes, found, 0.5 if _is_regular(found) else 0.75)
        drawn: Any
        if _is_regular(found):
            tiles = values.reshape(across.size, up.size).T
            drawn = axes.pcolormesh(edges(across), edges(up), tiles, **look)
        else:
            size = _marker_size(axes, found)
            drawn = axes.scatter(found.x, found.y, s=size**2, c=values, linewidths=0, **look)
        axes.set_xlabel(parameter_label(found.x_name))
        axes.set_ylabel(parameter_label(found.y_name))
        if colorbar:
            extend = extend_for(drawn.norm, values)
            bar = axes.figure.colorbar(drawn, ax=axes, pad=0.02, extend=extend)
            bar.set_label(MEASURE_LABELS[measure])
            plain(bar)
    return axes


def _rows(sweep: Sweep) -> Any:
    table = sweep.table()
    if len(table) == 0:
        raise InputError(f"{sweep.path} has no rows yet: there is nothing to draw")
    return table


def _is_regular(found: Plane) -> bool:
    return np.unique(found.x).size * np.unique(found.y).size == found.x.size


def _draw_regions(axes: Axes, found: Plane) -> None:
    """Colour the finest lattice by the nearest point, and mark the points."""
    across, i = np.unique(found.x, return_inverse=True)
    up, j = np.unique(found.y, return_inverse=True)
    colours = np.array([to_rgb(MODE_SYMBOLS[mode].colour) for mode in majority(found)])
    tiles = np.empty((up.size, across.size, 3))
    for row in range(up.size):
        away = (np.arange(across.size)[:, None] - i) ** 2 + (row - j) ** 2
        tiles[row] = colours[away.argmin(axis=1)]
    axes.pcolormesh(edges(across), edges(up), _faint(tiles), zorder=_ABOVE - 1.0)
    _draw_points(axes, found, 2.0 * _SMALLEST / 3.0, lone=1.0)


def _frame(axes: Axes, found: Plane, margin: float = 0.75) -> None:
    """Set scales, limits and ticks of both axes."""
    prepare(axes, "x", found.x, margin)
    prepare(axes, "y", found.y, margin)


def _marker_size(axes: Axes, found: Plane) -> float:
    """Diameter in points at which neighbours stay apart."""
    points = np.column_stack([found.x, found.y])
    parts = axes.transLimits.transform(axes.transScale.transform(points))
    spaces = []
    for at, room in zip(parts.T, _size_of(axes), strict=True):
        places = np.unique(np.round(at, 9))
        if places.size > 1:
            spaces.append(float(np.min(np.diff(places))) * room)
    return min(max(_FILLS * min(spaces, default=_LARGEST), _SMALLEST), _LARGEST)


def _size_of(axes: Axes) -> tuple[float, float]:
    """Width and height in points."""
    figure, box = figure_of(axes), axes.get_position()
    return 72.0 * figure.get_figwidth() * box.width, 72.0 * figure.get_figheight() * box.height


def _draw_points(axes: Axes, found: Plane, size: float, lone: float | None = None) -> None:
    """Draw each point; with ``lone``, those that agree as dots of that size."""
    runs = found.runs
    agreed = np.zeros(runs.size, dtype=bool)
    for mode, count in found.counts.items():
        whole = count == runs
        agreed |= whole
        symbol = MODE_SYMBOLS[mode]
        width = size * (0.85 if symbol.marker in ("D", "s") else 1.0)
        axes.scatter(
            found.x[whole],
            found.y[whole],
            s=(width if lone is None else lone) ** 2,
            c=symbol.colour,
            marker=symbol.marker if lone is None else "o",
            linewidths=0.3 if lone is None else 0.0,
            edgecolors=EDGE,
            zorder=_ABOVE,
        )
    slices: dict[tuple[str, float, float], list[int]] = {}
    for point in np.flatnonzero(~agreed).tolist():
        first = 0.0
        for mode, count in found.counts.items():
            part = float(count[point]) / float(runs[point])
            if part > 0.0:
                slices.setdefault((mode, round(first, 6), round(first + part, 6)), []).append(point)
            first += part
    for (mode, first, last), points in slices.items():
        outline, extent = _slice(first, last)
        axes.scatter(
            found.x[points],
            found.y[points],
            s=(extent * size) ** 2,
            c=MODE_SYMBOLS[mode].colour,
            marker=MarkerStyle(outline),
            linewidths=0.3,
            edgecolors=EDGE,
            zorder=_ABOVE,
        )


def _slice(first: float, last: float) -> tuple[Path, float]:
    """Return a slice of a pie of diameter 1, clockwise from the top, and how far it reaches.

    Matplotlib scales a marker by the largest of its coordinates.
    """
    count = max(2, math.ceil(_ARC * (last - first)) + 1)
    angle = 0.5 * math.pi - 2.0 * math.pi * np.linspace(first, last, count)
    rim = np.column_stack([np.cos(angle), np.sin(angle)])
    outline = np.concatenate([[[0.0, 0.0]], rim, [[0.0, 0.0]]])
    return Path(outline, closed=True), float(np.abs(outline).max())


def _faint(colours: np.ndarray) -> np.ndarray:
    return np.asarray(1.0 - _FAINT * (1.0 - colours))


def _name_modes(axes: Axes, found: Plane, *, above: bool) -> None:
    regions = not _is_regular(found)
    colours = {mode: np.array(to_rgb(MODE_SYMBOLS[mode].colour)) for mode in found.counts}
    if regions:
        colours = {mode: _faint(colour) for mode, colour in colours.items()}
    keys = [
        Line2D(
            [],
            [],
            linestyle="none",
            marker="s" if regions else MODE_SYMBOLS[mode].marker,
            markerfacecolor=tuple(colours[mode].tolist()),
            markeredgecolor=EDGE,
            markeredgewidth=0.3,
            markersize=6.0 if regions else 5.0,
            label=f"{mode} ({int(count.sum())})",
        )
        for mode, count in found.counts.items()
    ]
    axes.legend(
        handles=keys,
        loc="lower center" if above else "upper center",
        bbox_to_anchor=(0.5, 1.0 if above else _BELOW),
        ncols=max(1, min(len(keys), int(_size_of(axes)[0] / _KEY_WIDTH))),
        frameon=False,
        handletextpad=0.1,
        columnspacing=1.0,
        borderpad=0.2,
    )
