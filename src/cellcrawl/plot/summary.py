"""One page about a run: path, kymograph, tension and speed."""

from __future__ import annotations

import json
from typing import Any

import matplotlib as mpl
import numpy as np
import xarray as xr
from matplotlib.figure import Figure

from cellcrawl.arguments import checked
from cellcrawl.modes import classify, is_long_enough
from cellcrawl.observables import front_position
from cellcrawl.observables.inputs import edge_field
from cellcrawl.plot.colouring import colouring
from cellcrawl.plot.inputs import drawable
from cellcrawl.plot.kymograph import kymograph
from cellcrawl.plot.labels import time_label, time_text
from cellcrawl.plot.layout import Edge, Place, PlacedLayout, shared
from cellcrawl.plot.path import path, path_shape
from cellcrawl.plot.scales import Limits
from cellcrawl.plot.style import PAGE, STYLE, paper_figure
from cellcrawl.plot.symbols import PARAMETER_SYMBOLS
from cellcrawl.plot.time_series import draw_series

# Inches, for text of the house's size: room for two-line labels and long numbers.
_TOP, _BOTTOM, _GAP = 0.26, 0.39, 0.115
_LABELS, _BAR = 0.82, 0.62  # left of the panels over time, and right of them for the colour bar
_BAR_SPACE, _BAR_WIDTH = 0.15, 0.08
_UNDER = 0.3  # the path's scale bar and caption
_EDGE = 0.05
_SERIES = [0.87, 0.87, 1.3]  # heights from the bottom up
_SIDE = (1.6, 3.0)  # the path's least and largest width beside the rest
_NARROWEST = 5.0  # on a narrower page, or if much wider than tall, the path stands above the rest
_WIDE = 1.9
_MOST_VALUES = 4  # of a parameter that changes, in the title


@checked
def summary(
    dataset: xr.Dataset,
    every: float | None = None,
    *,
    field: str = "bound_fraction",
    limits: Limits | None = None,
    colormap: str | None = None,
) -> Figure:
    """Draw one page about a run: the path, a kymograph of bound fraction, tension and speed.

    Parameters
    ----------
    dataset : Dataset
        A run.
    every : float, optional
        Time between the contours along the path; see `path`.
    field : str
        The field on the edge that colours path and kymograph.
    limits : (float, float), optional
        Ends of the colour scale that both share; the field's own unless given.
    colormap : str, optional
        A colour map of matplotlib's; the field's own unless given.

    Returns
    -------
    Figure

    Raises
    ------
    InputError
        For an ``every`` that is not above 0, an unknown field, or a dataset that is no run.

    Notes
    -----
    The panels are placed anew when the figure changes its size.
    """
    run = drawable(dataset)
    edge_field(field)
    colours = colouring(run, field, run[field].values, limits, colormap)
    look: Any = {"field": field, "limits": colours.limits, "colormap": colours.colormap}
    shape = path_shape(run, every)
    with paper_figure(PAGE, 3.9, layout="none", shown=True) as figure:
        stacked = shape > _WIDE or figure.get_figwidth() < _NARROWEST
        left = figure.add_axes((0.0, 0.0, 0.4, 1.0))
        path(run, every, ax=left, colorbar=False, **look)
        top = figure.add_axes((0.5, 0.6, 0.4, 0.3))
        kymograph(run, origin="front" if _has_front(run) else "material", ax=top, **look)
        bar = figure.axes[-1]
        bar.set_box_aspect(None)
        series = [figure.add_axes((0.5, 0.3 * row, 0.4, 0.2), sharex=top) for row in (1, 0)]
        for panel, quantity in zip(series, ("tension", "speed"), strict=True):
            draw_series(panel, run, quantity)
        top.set_xlabel("")
        for panel in (top, series[0]):
            panel.tick_params(labelbottom=False)
        series[-1].set_xlabel(time_label(run))
        figure.align_ylabels([top, *series])
        figure.suptitle(describe(run), x=0.01, ha="left")
        grown = float(mpl.rcParams["font.size"]) / STYLE["font.size"]
        wide = figure.get_figwidth()
        if stacked:
            tall = min((wide - 2.0 * _EDGE) / shape, 4.5)
            around = (_TOP + _BOTTOM + _UNDER + 3.0 * _GAP) * grown
            figure.set_figheight(around + sum(_SERIES) + tall)
            places = _stacked(tall, wide, grown)
        else:
            places = _side_by_side(shape, wide, grown)
        axes = [left, top, bar, *series]
        figure.set_layout_engine(PlacedLayout(dict(zip(axes, places, strict=True))))
    return figure


def _side_by_side(shape: float, wide: float, grown: float) -> list[Place]:
    """Return the places of the path, at the left, and of kymograph, bar, tension and speed."""
    between, after = _LABELS * grown, _BAR * grown
    width = min(max(_SIDE[0], shape * (sum(_SERIES) + _BOTTOM - _UNDER)), _SIDE[1])
    rest = max(wide - _EDGE - between - after - width, 0.5 * width)
    one, other = shared([width, rest], [between], _EDGE, after)
    heights = shared(_SERIES, [_GAP * grown] * 2, _BOTTOM * grown, _TOP * grown)
    across = Place(*one, Edge(0.0, _UNDER * grown), Edge(1.0, -_TOP * grown))
    return [across, *_over_time(other, heights, grown)]


def _stacked(tall: float, wide: float, grown: float) -> list[Place]:
    """Return the same places with the path above the rest."""
    gaps = [_GAP * grown] * 2 + [(_GAP + _UNDER) * grown]
    *heights, above = shared([*_SERIES, tall], gaps, _BOTTOM * grown, _TOP * grown)
    ((left, right),) = shared([1.0], [], _LABELS * grown, _BAR * grown)
    across = Place(Edge(0.0, _EDGE), Edge(1.0, -_EDGE), *above)
    return [across, *_over_time((left, right), heights, grown)]


def _over_time(
    sides: tuple[Edge, Edge], heights: list[tuple[Edge, Edge]], grown: float
) -> list[Place]:
    speed, tension, kymograph = heights
    end = sides[1]
    bar = (
        Edge(end.part, end.inches + _BAR_SPACE * grown),
        Edge(end.part, end.inches + (_BAR_SPACE + _BAR_WIDTH) * grown),
    )
    return [
        Place(*sides, *kymograph),
        Place(*bar, *kymograph),
        Place(*sides, *tension),
        Place(*sides, *speed),
    ]


def _has_front(run: xr.Dataset) -> bool:
    return bool(np.isfinite(front_position(run).values).all())


def describe(run: xr.Dataset) -> str:
    """Return one line on a run: its main parameters, its seed, its mode and how it ended."""
    parameters = _table(run.attrs.get("parameters"))
    changes = _table(run.attrs.get("schedule"))
    parts = [
        f"{symbol} = {_values(parameters[name], changes.get(name))}"
        for name, symbol in PARAMETER_SYMBOLS.items()
        if isinstance(parameters.get(name), (int, float))
        and (name in ("r_on", "zeta_1") or name in changes)
    ]
    seed = run.attrs.get("seed", -1)
    if int(seed) >= 0:
        parts.append(f"seed {int(seed)}")
    if run.attrs.get("status") == "completed" and is_long_enough(run):
        parts.append(classify(run).mode)
    end = float(run["time"].values[-1])
    parts.append(f"{run.attrs.get('status', 'run')} at $t$ = {time_text(run, end)}")
    return ",  ".join(parts)


def _values(first: float, points: Any) -> str:
    """Return a parameter's value, or those that its schedule leads through."""
    try:
        values = [float(value) for _, value in points or ()] or [first]
    except (TypeError, ValueError):
        values = [first]
    turns = [values[0]]
    for before, value, after in zip(values, values[1:], [*values[2:], None], strict=False):
        if after is None or (value - before) * (after - value) <= 0.0:
            turns.append(value)
    turns = [value for n, value in enumerate(turns) if n == 0 or value != turns[n - 1]]
    if len(turns) > _MOST_VALUES:
        return f"{min(values):g} to {max(values):g}"
    return r" $\to$ ".join(f"{value:g}" for value in turns)


def _table(text: Any) -> dict[str, Any]:
    try:
        found = json.loads(text)
    except (TypeError, ValueError):
        return {}
    return found if isinstance(found, dict) else {}
