"""Pictures of a fit: the film, the posterior, runs that it foretells, and the calibration."""

from __future__ import annotations

import functools
import math
from collections.abc import Callable, Mapping, Sequence
from typing import Any, Final, TypeVar, cast

import matplotlib as mpl
import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.ticker import LogLocator, MaxNLocator, NullFormatter, StrMethodFormatter

from cellcrawl.arguments import checked
from cellcrawl.infer import films
from cellcrawl.infer.cells import Cell, cells_of
from cellcrawl.infer.population import Comparison
from cellcrawl.infer.prior import TIME_UNIT, unit_of
from cellcrawl.infer.result import Fit
from cellcrawl.infer.trained import Calibration
from cellcrawl.plot.style import (
    COLUMN,
    GUIDE,
    INK,
    PAGE,
    TRACK,
    PaperFigure,
    house_style,
)
from cellcrawl.plot.symbols import PARAMETER_SYMBOLS
from cellcrawl.simulation import simulate
from cellcrawl.starts import RandomPerturbation
from cellcrawl.validation import one_of, whole_number

_OUTLINES: Final = 8
_BINS: Final = 24
_PANEL: Final = 1.9  # inches a parameter
_WIDE: Final = 6.0  # highest over lowest: an axis below is as good as straight

F = TypeVar("F", bound=Callable[..., Any])


def _in_house(function: F) -> F:
    """Draw in the house style."""

    @functools.wraps(function)
    def call(*args: Any, **named: Any) -> Any:
        with mpl.rc_context(house_style()):
            return function(*args, **named)

    return cast(F, call)


def _few_ticks(axis: Any) -> None:
    """Label a logarithmic axis of a decade or so in plain numbers."""
    axis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
    axis.set_major_formatter(StrMethodFormatter("{x:g}"))
    axis.set_minor_formatter(NullFormatter())


def _new(rows: int, columns: int, width: float, height: float) -> tuple[Figure, np.ndarray]:
    figure = PaperFigure(figsize=(width, height), layout="constrained")
    FigureCanvasAgg(figure)
    return figure, figure.subplots(rows, columns, squeeze=False)


@_in_house
def cell_picture(cells: Sequence[tuple[str, Cell]], y_down: bool = False) -> Figure:
    """Draw films beside each other, on one scale: path and some outlines."""
    wide = PAGE if len(cells) > 2 else COLUMN
    figure, axes = _new(1, len(cells), wide, 0.72 * wide if len(cells) == 1 else 0.35 * wide)
    for axis, (title, cell) in zip(axes[0], cells, strict=True):
        axis.plot(cell.path.real, cell.path.imag, color=TRACK, lw=0.8)
        if cell.modes is not None:
            edges = films.edge_of_modes(cell.modes)
            for place in np.linspace(0, len(edges) - 1, _OUTLINES).astype(int):
                edge = np.append(edges[place], edges[place, 0]) + cell.path[place]
                axis.plot(edge.real, edge.imag, color=INK, lw=0.5)
        axis.set_aspect("equal", adjustable="datalim")
        if y_down:
            axis.invert_yaxis()
        axis.set_title(title)
        axis.set_xlabel("x (R_0)" if cell.model_units else "x (µm)")
    return figure


@_in_house
def margin_picture(fit: Fit, name: str, truth: float | None = None) -> Figure:
    """Draw the posterior of one parameter over its prior."""
    figure, axes = _new(1, 1, 2.3, 1.5)
    axis = axes[0, 0]
    place = fit.names.index(name)
    range_ = fit.trained.view.ranges[place]
    edges = range_.value(np.linspace(0.0, 1.0, _BINS + 1))
    share, _ = np.histogram(fit.values[:, place], edges, weights=fit.samples.weight)
    middle = 0.5 * (edges[1:] + edges[:-1])
    axis.bar(middle, share * _BINS, np.diff(edges), color=TRACK, alpha=0.75, lw=0)
    axis.axhline(1.0, color=GUIDE, lw=0.7, ls="--")
    found = fit.interval(name)
    axis.axvspan(found.low, found.high, color=TRACK, alpha=0.1, lw=0)
    axis.axvline(found.value, color=INK, lw=0.9)
    if truth is not None:
        axis.axvline(truth, color="#1b7837", lw=1.2, ls=":")
    axis.set_xlim(edges[0], edges[-1])
    _scale(axis.xaxis, axis.set_xscale, edges)
    axis.set_xlabel(_label(fit, name))
    axis.set_yticks([])
    axis.set_ylabel("times the prior")
    return figure


@checked
@_in_house
def corner(fit: Fit, truth: Mapping[str, float] | None = None) -> Figure:
    """Draw the posterior of every parameter and every pair, as wide as it is within its prior.

    Parameters
    ----------
    fit : Fit
    truth : mapping of str to float, optional
        Values to mark, where they are known.

    Returns
    -------
    Figure

    Raises
    ------
    InputError
        For a value that was not unknown.
    """
    names = fit.names
    marks = {one_of("truth", name, names): value for name, value in (truth or {}).items()}
    width = min(PAGE, _PANEL * len(names))
    figure, axes = _new(len(names), len(names), width, 0.95 * width)
    values, weight = fit.values, fit.samples.weight
    grids = [_grid(fit, name) for name in names]
    known = [marks.get(name) for name in names]
    for row, column in np.ndindex(axes.shape):
        axis: Any = axes[row, column]
        if column > row:
            axis.set_axis_off()
            continue
        if column == row:
            axis.hist(values[:, row], grids[row], weights=weight, color=TRACK, alpha=0.75)
            axis.set_yticks([])
        else:
            pair = values[:, column], values[:, row]
            bins = grids[column], grids[row]
            axis.hist2d(*pair, bins, weights=weight, cmap="Purples")
            _scale(axis.yaxis, axis.set_yscale, grids[row])
            if known[row] is not None:
                axis.axhline(known[row], color=INK, lw=0.6, ls="--")
        axis.set_xlim(grids[column][0], grids[column][-1])
        _scale(axis.xaxis, axis.set_xscale, grids[column])
        axis.tick_params(axis="x", rotation=45)
        if known[column] is not None:
            axis.axvline(known[column], color=INK, lw=0.6, ls="--")
        if row == len(names) - 1:
            axis.set_xlabel(_label(fit, names[column]))
        else:
            axis.tick_params(labelbottom=False, which="both")
        if column == 0 and row > 0:
            axis.set_ylabel(_label(fit, names[row]))
        elif column < row:
            axis.tick_params(labelleft=False, which="both")
    return figure


def _grid(fit: Fit, name: str) -> np.ndarray:
    """Return the ends of bins that hold all but a thousandth of a posterior."""
    range_ = fit.trained.view.ranges[fit.names.index(name)]
    found = fit.interval(name, 0.999)
    low, high = range_.part(np.array([found.low, found.high]))
    aside = 0.15 * (high - low)
    parts = np.linspace(max(low - aside, 0.0), min(high + aside, 1.0), _BINS + 1)
    return np.asarray(range_.value(parts))


def _scale(ticks: Any, set_scale: Callable[[str], None], grid: np.ndarray) -> None:
    """Make an axis logarithmic if its bins are, over more than a small range."""
    even = np.allclose(np.diff(grid), grid[1] - grid[0], atol=0.0)
    if not even and grid[-1] > _WIDE * grid[0]:
        set_scale("log")
        _few_ticks(ticks)
    else:
        ticks.set_major_locator(MaxNLocator(4))


def _label(fit: Fit, name: str) -> str:
    unit = "" if fit.cell.model_units else unit_of(name)
    return PARAMETER_SYMBOLS.get(name, name) + (f" ({unit})" if unit else "")


@checked
def foretold(fit: Fit, count: int = 3, seed: int = 1) -> list[Cell]:
    """Return films of runs with parameters of the posterior, as long as the cell's.

    Parameters
    ----------
    fit : Fit
    count : int
        How many runs, 1 to 20.
    seed : int
        Of the samples and the starts.

    Returns
    -------
    list of Cell
        In µm and s. A run that tears or leaves the model first is not among them.
    """
    whole_number("count", count, 1, 20)
    whole_number("seed", seed, 0, 2**31)
    random = np.random.default_rng(seed)
    microscope = fit.trained.microscope
    found: list[Cell] = []
    for _ in range(3 * count):
        row = int(random.choice(len(fit.samples.weight), p=fit.samples.weight))
        named = dict(zip(fit.names, fit.values[row], strict=True))
        time = float(named.get(TIME_UNIT, microscope.usual_time))
        own = {n: v for n, v in named.items() if n.startswith("laws.")}
        law = fit.trained.bank.law.replace(**{n[5:]: float(v) for n, v in own.items()})
        step = microscope.frame / time
        records = math.ceil(films.TRANSIENT / step) + microscope.frames - 1
        run = simulate(
            fit.parameters(row),
            t_end=records * step,
            save_every=step,
            nodes=films.NODES,
            laws=law,
            start=RandomPerturbation(seed=int(random.integers(2**31))),
            rtol=1e-3,
        )
        if run.attrs["status"] != "completed":
            continue
        (made,) = cells_of(run) if _moves(run) else (None,)
        if made is None:
            continue
        unit = fit.cell.radius / made.radius if fit.cell.modes is not None else 1.0
        unit = unit if microscope.length_unit is None else microscope.usual_length
        modes = made.modes if fit.cell.modes is not None else None
        found.append(
            Cell(
                f"run {len(found) + 1}",
                fit.cell.frame,
                unit * (made.path - made.path[0]),
                None if modes is None else unit * modes,
                0.0,
                fit.cell.model_units,
            )
        )
        if len(found) == count:
            break
    return found


def _moves(run: Any) -> bool:
    late = run.isel(time=run["time"].values >= films.TRANSIENT)
    x, y = late["centroid_x"].values, late["centroid_y"].values
    return bool(len(x) > 16 and np.hypot(x - x[0], y - y[0]).max() > 0.3)


@_in_house
def calibration_picture(calibration: Calibration) -> Figure:
    """Draw, for cells set apart: what was found over what is true, ranks, and coverage."""
    count = len(calibration.names)
    figure, axes = _new(count, 3, PAGE, 1.45 * count)
    for place, name in enumerate(calibration.names):
        recovered, ranks, cover = axes[place]
        recovered.plot([0, 1], [0, 1], color=GUIDE, lw=0.6)
        recovered.plot(
            calibration.truth[:, place], calibration.mean[:, place], ".", ms=1.6, color=TRACK
        )
        recovered.set_ylabel(PARAMETER_SYMBOLS.get(name, name))
        recovered.set_xlabel("true, part of the prior")
        recovered.set_title(f"R² = {calibration.recovered[place]:.2f}")
        cells = len(calibration.rank)
        ranks.hist(calibration.rank[:, place], bins=10, range=(0, 1), color=TRACK, alpha=0.75)
        ranks.axhspan(*_expected(cells, 10), color=GUIDE, alpha=0.3, lw=0)
        ranks.set_title(f"ranks, p = {calibration.evenness[place]:.2f}")
        ranks.set_yticks([])
        levels = np.linspace(0.05, 0.95, 19)
        held = [calibration.coverage(float(level))[place] for level in levels]
        cover.plot([0, 1], [0, 1], color=GUIDE, lw=0.6)
        cover.plot(levels, held, color=TRACK)
        cover.set_title(f"90 % hold {calibration.coverage(0.9)[place]:.0%}")
        cover.set_xlabel("level")
    return figure


@_in_house
def comparison_picture(comparison: Comparison) -> Figure:
    """Draw where the cells of two conditions lie, parameter by parameter."""
    names = comparison.names
    figure, axes = _new(1, len(names), PAGE, 2.4)
    for place, (axis, name) in enumerate(zip(axes[0], names, strict=True)):
        range_ = comparison.control.fits[0].trained.view.ranges[place]
        for at, (group, colour) in enumerate(
            ((comparison.control, INK), (comparison.treated, TRACK))
        ):
            for i, fit in enumerate(group.fits):
                found = fit.interval(name, 0.5)
                x = at + 0.6 * (i / max(len(group.fits) - 1, 1) - 0.5)
                axis.plot([x, x], [found.low, found.high], color=colour, lw=0.6, alpha=0.6)
                axis.plot(x, found.value, ".", ms=2.5, color=colour)
        if range_.scale == "log" and axis.get_ylim()[0] > 0.0:
            _scale(axis.yaxis, axis.set_yscale, np.geomspace(*axis.get_ylim()))
        axis.set_xticks([0, 1], ["control", "treated"])
        axis.set_title(PARAMETER_SYMBOLS.get(name, name))
    return figure


def _expected(cells: int, bins: int) -> tuple[float, float]:
    """Return between which counts of ranks in a bin 95 percent lie if they are even."""
    mean = cells / bins
    wide = 1.96 * math.sqrt(mean * (1.0 - 1.0 / bins))
    return max(mean - wide, 0.0), mean + wide


__all__ = ["corner", "foretold"]
