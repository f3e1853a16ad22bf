"""Fig. 2: growth rate and frequency against the wavenumber, four families."""

from __future__ import annotations

from typing import Any, Final

import numpy as np
from matplotlib.axes import Axes

from cellcrawl import linear, plot
from cellcrawl.parameters import Parameters
from cellcrawl.plot.style import GUIDE, PAGE, paper_figure
from cellcrawl.reproduction.workspace import Workspace

_CELL: Final = Parameters(r_on=20, zeta_1=600, D=0.01, sigma_c=100)
# The text has the cell but not the members of the families: these span the ranges of its Table I.
FAMILIES: Final[dict[str, list[float]]] = {
    "zeta_1": [300, 400, 500, 600, 700],
    "r_on": [10, 20, 30, 45, 60],
    "D": [0.01, 0.02, 0.05, 0.1, 0.2],
    "sigma_c": [0, 100, 200, 300],
}
_K_MAX = 40
_LOOK: Final = ("color", "linestyle", "linewidth", "marker", "markersize", "zorder")


def make(workspace: Workspace, name: str) -> list[str]:
    """Draw the families A to D, growth rate above frequency."""
    found, top = [], 0.0
    with paper_figure(PAGE, 4.2) as figure:
        panels = figure.subplots(2, len(FAMILIES), sharex=True, sharey="row")
        rows: list[tuple[Any, ...]] = []
        for letter, column, (parameter, members) in zip(
            "ABCD", panels.T, FAMILIES.items(), strict=True
        ):
            values = members[1:3] if workspace.quick else members
            family: dict[str, Any] = {parameter: values}
            plot.dispersion(_CELL, k_max=_K_MAX, axes=list(column), **family)
            top = max(top, column[0].get_ylim()[1])
            column[0].set_title(letter, loc="left", fontweight="bold")
            column[0].set_xlabel("")
            for value in values:
                cell = _CELL.replace(**{parameter: value})
                for k, roots in enumerate(linear.growth_rates(cell, np.arange(_K_MAX + 1))):
                    rows.append((parameter, value, k, *roots.real, *roots.imag))
            cells = [_CELL.replace(**{parameter: value}) for value in values]
            found.append(
                f"rate of k = 1 and the first k that decays, by {parameter}: "
                + "; ".join(
                    f"{value:g}: {linear.growth_rates(cell, 1)[0].real:.2f}, "
                    f"{_first_decaying(cell)}"
                    for value, cell in zip(values, cells, strict=True)
                )
            )
        for panel in panels[:, 1:].ravel():
            panel.set_ylabel("")
        panels[0, 0].set_ylim(-0.5 * top, top)
        panels[1, 0].set_ylim(bottom=-2.0)
        _magnify(panels[0, -1])
        figure.align_ylabels(list(panels[:, 0]))
        workspace.picture(figure)
    names = ("parameter", "value", "k", "growth_1", "growth_2", "frequency_1", "frequency_2")
    workspace.table("growth-rates", dict(zip(names, zip(*rows, strict=True), strict=True)))
    return found


def _magnify(panel: Axes) -> None:
    """Show where the lines of a family that hardly differ cross zero, larger."""
    inset = panel.inset_axes((0.1, 0.06, 0.42, 0.3), xlim=(24.0, 30.0), ylim=(-1.5, 1.5))
    for line in panel.lines:
        x, y = (np.asarray(values, dtype=float) for values in line.get_data())
        look = {name: getattr(line, f"get_{name}")() for name in _LOOK}
        inset.plot(x, y, **look)
    inset.set_xticks([25, 30])
    inset.set_yticks([])
    inset.tick_params(labelsize="x-small", pad=1.5)
    panel.indicate_inset_zoom(inset, edgecolor=GUIDE, linewidth=0.5)


def _first_decaying(cell: Parameters) -> int:
    """Return the least wavenumber from 1 on that does not grow."""
    grows = linear.growth_rates(cell, np.arange(1, 1001))[:, 0].real > 0.0
    return 1 + int(np.argmin(grows))
