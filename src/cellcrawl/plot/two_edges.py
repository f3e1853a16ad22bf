"""The cell on a line: where its edges are, and which regime over two parameters."""

from __future__ import annotations

import json
from collections.abc import Sequence
from typing import Any, Final

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.colors import BoundaryNorm, ListedColormap
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from cellcrawl.arguments import checked
from cellcrawl.errors import InputError
from cellcrawl.one_dimensional.cell import Anchoring
from cellcrawl.one_dimensional.diagram import BOUNDARIES, boundaries
from cellcrawl.one_dimensional.regimes import REGIMES, check_two_edges
from cellcrawl.parameters import Parameters
from cellcrawl.plot.labels import length_unit, series_label, time_label, with_unit
from cellcrawl.plot.style import (
    BODY,
    COLUMN,
    INK,
    PAGE,
    figure_of,
    on,
    paper_figure,
    several_axes,
)
from cellcrawl.plot.symbols import parameter_label
from cellcrawl.validation import shown

EDGE_COLOURS: Final = {"front": "#0072b2", "rear": "#d55e00"}
REGIME_COLOURS: Final = {
    "still": "#e4e4e4",
    "crawling": "#56a0d3",
    "stick-slip": "#e9a23b",
    "stepping": "#2f8f6b",
    "bipedal": "#b5338a",
    "failed": "#333333",
}
_OVER: Final[Any] = (0, (3.0, 1.5))  # edges in phase lie on each other
_LINES: Final[dict[str, Any]] = {
    "symmetric": {"linestyle": (0, (4.0, 1.5)), "label": "in-phase Hopf points"},
    "antisymmetric": {"linestyle": "-", "label": "symmetry breaks"},
    "crawling": {"linestyle": (0, (1.0, 1.2)), "label": "crawling exists"},
}
_START_TITLES = {
    "small": "from a small asymmetry",
    "large": "from a large asymmetry",
    "in_phase": "from edges in phase",
}


@checked
def two_edges(dataset: xr.Dataset, *, axes: Sequence[Axes] | None = None) -> Figure:
    """Draw where the cell on a line is, the bound fractions of its edges, and the tension.

    Parameters
    ----------
    dataset : Dataset
        From `one_dimensional.simulate_two_edges`; take a part with
        ``dataset.sel(time=slice(40, 60))``.
    axes : (Axes, Axes, Axes), optional
        Where to draw the three; a new figure unless given.

    Returns
    -------
    Figure

    Raises
    ------
    InputError
        For a dataset that is no run of two edges or has no record.
    """
    run = check_two_edges(dataset)
    if run.sizes["time"] == 0:
        raise InputError("this run has no records: there is nothing to draw")
    if axes is not None:
        given = several_axes(axes, 3, "one each for position, bound fraction and tension")
        _draw(run, given)
        return figure_of(given[0])
    with paper_figure(COLUMN, 3.6, shown=True) as figure:
        panels = list(figure.subplots(3, 1, sharex=True, height_ratios=(1.3, 1.0, 1.0)))
        _draw(run, panels)
        panels[1].legend(frameon=False, loc="best", handlelength=1.2, ncols=2)
        panels[0].set_ylabel(with_unit("position\n$x$", length_unit(run)))
        panels[1].set_ylabel("bound fraction\n$n$")
        panels[2].set_ylabel(series_label(run, "tension"))
        panels[2].set_xlabel(time_label(run))
        figure.align_ylabels(panels)
    return figure


def _draw(run: xr.Dataset, panels: list[Axes]) -> None:
    place, linked, pulled = panels
    times = run["time"].values
    front, rear = (run["position"].sel(edge=edge).values for edge in EDGE_COLOURS)
    place.fill_between(times, rear, front, color=on(place, BODY), linewidth=0.0)
    for (edge, colour), style in zip(EDGE_COLOURS.items(), ("-", _OVER), strict=True):
        place.plot(times, run["position"].sel(edge=edge), color=colour)
        bound = run["bound_fraction"].sel(edge=edge)
        linked.plot(times, bound, color=colour, linestyle=style, label=edge)
    pulled.plot(times, run["tension"], color=on(pulled, INK))
    linked.set_ylim(0.0, 1.0)
    low, high = pulled.get_ylim()
    slack = max(0.0, 0.01 * abs(high) - 0.5 * (high - low))  # a steady tension is a flat line
    pulled.set_ylim(low - slack, high + slack)
    for panel in panels:
        if times.size > 1:
            panel.set_xlim(float(times[0]), float(times[-1]))
        panel.spines[["top", "right"]].set_visible(False)


@checked
def regimes(diagram: xr.Dataset, *, lines: bool = True) -> Figure:
    """Draw the regimes of two edges over two parameters, one panel for each start.

    A dot marks a run that had not settled. Lines are theory: where the still cell loses its
    symmetry, where it starts to stick and slip in phase, where steady crawling exists.

    Parameters
    ----------
    diagram : Dataset
        From `one_dimensional.phase_diagram`.
    lines : bool
        Draw the lines of theory.

    Returns
    -------
    Figure

    Raises
    ------
    InputError
        For a dataset that is no phase diagram.
    """
    if not isinstance(diagram, xr.Dataset) or "regimes" not in diagram.attrs:
        raise InputError(
            f"this is no phase diagram of two edges but {shown(type(diagram).__name__)}: make one "
            "with one_dimensional.phase_diagram"
        )
    starts = [str(start) for start in diagram["start"].values]
    drawn: list[str] = []
    with paper_figure(max(COLUMN, PAGE * len(starts) / 3.0), 2.75, shown=True) as figure:
        panels = figure.subplots(1, len(starts), sharex=True, sharey=True, squeeze=False).ravel()
        for panel, start in zip(panels, starts, strict=True):
            _fill(panel, diagram, start)
            panel.set_title(_START_TITLES[start], loc="left")
        panels[0].set_ylabel(parameter_label(str(diagram["regime"].dims[2])))
        if lines:
            drawn = _draw_lines(panels, diagram)
        figure.legend(
            handles=_keys(diagram, drawn),
            frameon=False,
            loc="outside lower center",
            ncols=4 if len(starts) < 2 else 8,
            handlelength=1.5,
            columnspacing=1.1,
        )
    return figure


def _fill(panel: Axes, diagram: xr.Dataset, start: str) -> None:
    _, first, second = diagram["regime"].dims
    shown_codes = diagram["regime"].sel(start=start).values
    x, y = diagram[first].values, diagram[second].values
    colours = ListedColormap([REGIME_COLOURS[name] for name in REGIMES])
    norm = BoundaryNorm(np.arange(len(REGIMES) + 1) - 0.5, len(REGIMES))
    panel.pcolormesh(x, y, shown_codes.T, cmap=colours, norm=norm, shading="nearest", zorder=1.0)
    i, j = np.nonzero(~diagram["settled"].sel(start=start).values)
    panel.plot(x[i], y[j], ".", color=on(panel, INK), markersize=1.5, zorder=2.0)
    panel.set_xlabel(parameter_label(str(first)))


def _draw_lines(panels: np.ndarray, diagram: xr.Dataset) -> list[str]:
    """Draw what theory gives; return the names of the lines there are."""
    drawn = []
    _, first, second = (str(name) for name in diagram["regime"].dims)
    parameters = Parameters(**json.loads(diagram.attrs["parameters"]))
    anchoring = Anchoring(**json.loads(diagram.attrs["anchoring"]))
    ranges = {name: diagram[name].values[[0, -1]] for name in (first, second)}
    for which in BOUNDARIES:
        curves = boundaries(parameters, which, anchoring=anchoring, **ranges)
        drawn += [which] if curves else []
        for panel in panels:
            for curve in curves:
                style = _LINES[which]["linestyle"]
                panel.plot(
                    *curve.T, color=on(panel, INK), linewidth=0.9, linestyle=style, zorder=3.0
                )
    return drawn


def _keys(diagram: xr.Dataset, drawn: list[str]) -> list[Any]:
    present = np.unique(diagram["regime"].values)
    keys: list[Any] = [
        Patch(facecolor=REGIME_COLOURS[REGIMES[code]], edgecolor="none", label=REGIMES[code])
        for code in present
    ]
    lines = [Line2D([], [], color=INK, linewidth=0.9, **_LINES[which]) for which in drawn]
    return [*keys, *lines]
