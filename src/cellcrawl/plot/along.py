"""A sweep along one parameter: the modes in rows, or a measure run by run."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.axes import Axes

from cellcrawl.plot.mode_symbols import EDGE, MODE_SYMBOLS
from cellcrawl.plot.spacing import prepare
from cellcrawl.plot.style import COLUMN, GUIDE, axes_or_new, on
from cellcrawl.plot.symbols import MEASURE_LABELS, parameter_label
from cellcrawl.sweeps.planes import Plane, named_modes

if TYPE_CHECKING:
    import pyarrow as pa

_LARGEST = 7.0  # points: the symbol of all runs of a point
_ROW = 0.26  # inches


def draw_modes(found: Plane, size: float | None, ax: Axes | None) -> Axes:
    """Draw a row for each mode; a symbol's area is the part of a point's runs that show it."""
    rows = list(found.counts)
    with axes_or_new(ax, COLUMN, 0.6 + _ROW * len(rows)) as axes:
        for row, mode in enumerate(rows):
            share = found.counts[mode] / found.runs
            there = share > 0.0
            axes.axhline(row, color=on(axes, GUIDE), linewidth=0.4, alpha=0.5, zorder=1.0)
            axes.scatter(
                found.x[there],
                np.full(int(there.sum()), float(row)),
                s=share[there] * (size or _LARGEST) ** 2,
                zorder=3.0,
                **_symbol(mode),
            )
        axes.set_yticks(
            range(len(rows)), [f"{mode} ({int(found.counts[mode].sum())})" for mode in rows]
        )
        axes.set_ylim(len(rows) - 0.4, -0.6)  # in the order of a legend
        axes.tick_params(axis="y", length=0)
        prepare(axes, "x", found.x)
        axes.set_xlabel(parameter_label(found.x_name))
    return axes


def draw_measure(
    table: pa.Table,
    found: Plane,
    measure: str,
    means: np.ndarray,
    limits: Any,
    ax: Axes | None,
) -> Axes:
    """Draw the mean of a measure as a line, and each run by its mode's symbol."""
    x = table[found.x_name].to_numpy()
    values = np.array([np.nan if v is None else v for v in table[measure].to_pylist()], dtype=float)
    modes = np.array(named_modes(table))
    with axes_or_new(ax, COLUMN, 0.65 * COLUMN) as axes:
        axes.plot(found.x, means, color=on(axes, GUIDE), linewidth=0.9, zorder=2.0)
        for mode in found.counts:
            runs = (modes == mode) & np.isfinite(values)
            if runs.any():
                axes.scatter(
                    x[runs], values[runs], s=4.5**2, zorder=3.0, label=mode, **_symbol(mode)
                )
        prepare(axes, "x", found.x)
        if limits[0] is not None:
            axes.set_ylim(*limits)
        axes.set_xlabel(parameter_label(found.x_name))
        axes.set_ylabel(MEASURE_LABELS[measure])
        axes.spines[["top", "right"]].set_visible(False)
        axes.legend(frameon=False, handletextpad=0.1, borderpad=0.2)
    return axes


def _symbol(mode: str) -> dict[str, Any]:
    symbol = MODE_SYMBOLS[mode]
    return {
        "color": symbol.colour,
        "marker": symbol.marker,
        "linewidths": 0.3,
        "edgecolors": EDGE,
    }
