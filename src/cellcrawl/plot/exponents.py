"""Lyapunov exponents over a plane: the rate as a colour, what a cell does for good as a marker."""

from __future__ import annotations

from typing import Final

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.lines import Line2D

from cellcrawl.arguments import checked
from cellcrawl.branches import LABELS
from cellcrawl.errors import InputError
from cellcrawl.plot.mode_symbols import EDGE
from cellcrawl.plot.style import PAGE, axes_or_new, colormap_for, figure_of
from cellcrawl.plot.symbols import parameter_label
from cellcrawl.validation import real_number

_MARKERS: Final = {
    "steady glide": "o",
    "steady spin": "^",
    "at rest": ".",
    "breathing at rest": "h",
    "periodic": "D",
    "quasi-periodic": "s",
    "irregular for a while": "P",
    "chaotic": "*",
    "undecided": "v",
    "torn": "x",
}
_DIAMETER: Final = 6.0
_BELOW = -0.13  # of the axes' height: under the label


@checked
def lyapunov_map(
    found: xr.Dataset, *, limit: float = 0.06, legend: bool = True, ax: Axes | None = None
) -> Axes:
    """Draw exponents over a plane: red where small changes grow, blue where they fade.

    Parameters
    ----------
    found : Dataset
        From `cellcrawl.branches.lyapunov_map` or `open_lyapunov_map`, finished or not.
    limit : float
        Rate at which the colours end, either way, 1e-4 to 100.
    legend : bool
        Name the labels below, with the number of cells of each.
    ax : Axes, optional
        Where to draw; the only axes of a new figure unless given.

    Raises
    ------
    InputError
        For a dataset that is no map, or one with nothing measured.
    """
    if not {"exponent", "label"} <= set(found) or {"zeta_1", "r_on"} != set(found["label"].dims):
        raise InputError("found is no map of exponents: cellcrawl.branches.lyapunov_map makes one")
    most = real_number("limit", limit, 1e-4, 100.0)
    across, up = np.meshgrid(found["r_on"].values, found["zeta_1"].values)
    labels = found["label"].transpose("zeta_1", "r_on").values
    rates = found["exponent"].transpose("zeta_1", "r_on").values
    seen = [label for label in LABELS if np.any(labels == label)]
    if not seen:
        raise InputError("nothing of this map was measured yet")
    keys = []
    with axes_or_new(ax, PAGE, 0.55 * PAGE) as axes:
        colours = None
        for label in seen:
            here, marker = labels == label, _MARKERS[label]
            size = (_DIAMETER * (1.4 if marker == "*" else 1.0)) ** 2
            if not np.any(np.isfinite(rates[here])):  # torn: there is no rate
                axes.scatter(across[here], up[here], color=EDGE, marker=marker, s=0.5 * size)
            else:
                colours = axes.scatter(
                    across[here], up[here], c=rates[here], marker=marker, s=size, edgecolors=EDGE,
                    linewidths=0.3, cmap=colormap_for("RdBu_r"), vmin=-most, vmax=most,
                )  # fmt: skip
            key = Line2D(
                [], [], linestyle="none", marker=marker, markerfacecolor="white",
                markeredgecolor=EDGE, markeredgewidth=0.5, markersize=5.0,
                label=f"{label} ({int(here.sum())})",
            )  # fmt: skip
            keys.append(key)
        axes.set_xlabel(parameter_label("r_on"))
        axes.set_ylabel(parameter_label("zeta_1"))
        if colours is not None:
            bar = figure_of(axes).colorbar(colours, ax=axes, extend="both", pad=0.02)
            bar.set_label("rate of growth of small changes")
        if legend:
            axes.legend(
                handles=keys, loc="upper center", bbox_to_anchor=(0.5, _BELOW),
                ncols=min(len(keys), 4), frameon=False, handletextpad=0.1,
            )  # fmt: skip
    return axes
