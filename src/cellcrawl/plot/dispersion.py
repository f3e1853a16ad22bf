"""Growth rates against the wavenumber (Fig. 2 of the paper)."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import MaxNLocator

from cellcrawl.arguments import checked
from cellcrawl.errors import InputError
from cellcrawl.linear import cutoff_wavenumber, growth_rates, hopf_points, oscillation_onset
from cellcrawl.linear.characteristic import checked_values
from cellcrawl.parameters import Parameters
from cellcrawl.plot.style import (
    COLUMN,
    GUIDE,
    INK,
    colormap_for,
    figure_of,
    on,
    paper_figure,
    several_axes,
)
from cellcrawl.plot.symbols import (
    FREQUENCY_LABEL,
    GROWTH_LABEL,
    PARAMETER_SYMBOLS,
    WAVENUMBER_LABEL,
)
from cellcrawl.validation import real_number

_STEPS = 800
_MOST = 12
_BELOW = 0.75  # how far below 0 is shown, over the largest growth rate
_DASHED: Any = (0, (3.0, 1.5))
_ONSET: dict[str, Any] = {"marker": "o", "markersize": 3.5, "markerfacecolor": "white"}
_HOPF: dict[str, Any] = {"marker": "D", "markersize": 3.0}


@checked
def dispersion(
    parameters: Parameters,
    *,
    k_max: float | None = None,
    legend: bool = True,
    axes: Sequence[Axes] | None = None,
    **family: Any,
) -> Figure:
    """Draw growth rate and frequency against the wavenumber, for one cell or a family.

    Both roots are drawn: the larger solid, the smaller dashed, one line once they are a complex
    pair. Dots are the whole wavenumbers, which fit on the circle. An open circle is where two real
    roots meet and oscillation begins (the paper's "Hopf bifurcation"), a filled diamond a Hopf
    point, where a pair crosses the axis. The breathing mode k = 0, which no curve connects to the
    rest, is not drawn.

    Parameters
    ----------
    parameters : Parameters
        The cell.
    k_max : float, optional
        Highest wavenumber, 2 to 10000; unless given, enough to see all decay.
    legend : bool
        Say what the colours are; on a new figure also what the marks are.
    axes : (Axes, Axes), optional
        Where to draw the growth rate and the frequency; a new figure unless given.
    **family : sequence of float
        Values of one parameter, by name, up to 12: ``dispersion(p, zeta_1=[400, 500, 600])``.

    Returns
    -------
    Figure

    Raises
    ------
    InputError
        For more than one parameter, an unknown name, or values out of range.
    """
    name, values = _one_family(parameters, family)
    cells = [parameters.replace(**{name: value}) for value in values]
    highest = _highest(cells) if k_max is None else real_number("k_max", k_max, 2.0, 1e4)
    colours = mpl.colormaps[colormap_for("viridis")](np.linspace(0.0, 0.85, len(cells)))[::-1]
    if axes is not None:
        real, imaginary = several_axes(axes, 2, "one for growth rates, one for frequencies")
        _draw_all(real, imaginary, cells, colours, highest)
        if legend and family:
            _name_colours(real, name, values, colours)
        return figure_of(real)
    with paper_figure(COLUMN, 1.3 * COLUMN, shown=True) as figure:
        real, imaginary = figure.subplots(2, 1, sharex=True, height_ratios=(1.25, 1.0))
        _draw_all(real, imaginary, cells, colours, highest)
        real.set_xlabel("")
        if legend and family:
            _name_colours(real, name, values, colours)
        if legend:
            _name_marks(figure, real)
        figure.align_ylabels([real, imaginary])
    return figure


def _one_family(parameters: Parameters, family: dict[str, Any]) -> tuple[str, list[float]]:
    if not family:
        return "zeta_1", [parameters.zeta_1]
    ((name, values), *others) = checked_values("plot.dispersion", family).items()
    if others:
        raise InputError(f"a family has one parameter, not {len(family)}: keep {name} or another")
    flat = np.atleast_1d(values)
    if flat.ndim > 1 or not 1 <= flat.size <= _MOST:
        raise InputError(f"{name} must be 1 to {_MOST} values")
    return name, [float(value) for value in flat]


def _highest(cells: list[Parameters]) -> float:
    """Return a round wavenumber at which all modes decay, or a usual one."""
    cutoffs = [float(cutoff_wavenumber(cell)) for cell in cells]
    finite = [cutoff for cutoff in cutoffs if math.isfinite(cutoff)]
    wanted = 1.25 * max([8.0, *finite])
    step = 5.0 if wanted < 60.0 else 10.0 ** math.floor(math.log10(wanted))
    return math.ceil(wanted / step) * step


def _draw_all(
    real: Axes, imaginary: Axes, cells: list[Parameters], colours: np.ndarray, highest: float
) -> None:
    ranges = [
        _draw(real, imaginary, cell, colour, highest)
        for cell, colour in zip(cells, colours, strict=True)
    ]
    for ax, label in ((real, GROWTH_LABEL), (imaginary, FREQUENCY_LABEL)):
        ax.axhline(0.0, color=on(ax, GUIDE), linewidth=0.5, zorder=1.0)
        ax.set_xlim(0.0, highest)
        ax.xaxis.set_major_locator(MaxNLocator(integer=True, steps=[1, 2, 5, 10]))
        ax.set_xlabel(WAVENUMBER_LABEL)
        ax.set_ylabel(label)
        ax.spines[["top", "right"]].set_visible(False)
    lowest, top = min(low for low, _ in ranges), max(1.0, *(high for _, high in ranges))
    real.set_ylim(max(-_BELOW * top, lowest - 0.1 * top), 1.1 * top)


def _draw(
    real: Axes, imaginary: Axes, cell: Parameters, colour: np.ndarray, highest: float
) -> tuple[float, float]:
    """Draw one cell; return the least and largest real part shown."""
    onsets = oscillation_onset(cell, k=(1e-6, highest))
    k = np.union1d(np.linspace(1.0, highest, _STEPS), [t.value for t in onsets if t.value > 1.0])
    larger, smaller = growth_rates(cell, k).T
    paired = (larger.imag > 0.0) & ~np.isin(k, [t.value for t in onsets])
    whole = np.arange(1, math.floor(highest) + 1)
    at_whole = growth_rates(cell, whole)
    line: dict[str, Any] = {"color": colour, "zorder": 2.0}
    real.plot(k, larger.real, **line)
    real.plot(k, np.where(paired, np.nan, smaller.real), linestyle=_DASHED, **line)
    real.plot(whole, at_whole[:, 0].real, ".", markersize=2.5, **line)
    for root, style in ((larger, "-"), (smaller, _DASHED)):
        imaginary.plot(k, root.imag, linestyle=style, **line)
    imaginary.plot(whole, at_whole[:, 0].imag, ".", markersize=2.5, **line)
    mark: dict[str, Any] = {"color": colour, "markeredgewidth": 0.8, "zorder": 3.0}
    for t in onsets:
        if t.value > 1.0:
            for ax, height in ((real, t.growth_rate), (imaginary, 0.0)):
                ax.plot(t.value, height, **mark, **_ONSET)
    for t in hopf_points(cell, k=(1.0, highest)):
        for ax, height in ((real, 0.0), (imaginary, t.frequency)):
            ax.plot(t.value, height, **mark, **_HOPF)
    shown = np.concatenate([larger.real, smaller.real])
    return float(shown.min()), float(shown.max())


def _name_colours(real: Axes, name: str, values: list[float], colours: np.ndarray) -> None:
    keys = [
        Line2D([], [], color=colour, label=f"{PARAMETER_SYMBOLS[name]} = {value:g}")
        for value, colour in zip(values, colours, strict=True)
    ]
    real.legend(handles=keys, frameon=False, loc="upper right", handlelength=1.4)


def _name_marks(figure: Figure, ax: Axes) -> None:
    ink = on(ax, INK)
    mark: dict[str, Any] = {"linestyle": "none", "color": ink, "markeredgewidth": 0.8}
    keys = [
        Line2D([], [], color=ink, label="larger root"),
        Line2D([], [], color=ink, linestyle=_DASHED, label="smaller root"),
        Line2D([], [], label="onset of oscillation", **mark, **_ONSET),
        Line2D([], [], label="Hopf point", **mark, **_HOPF),
    ]
    figure.legend(
        handles=keys, frameon=False, loc="outside lower center", ncols=2, handlelength=1.8
    )
