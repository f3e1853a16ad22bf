"""Fig. 7: circularity, tension and distance over (r_on, zeta_1), with the modes."""

from __future__ import annotations

from typing import Final

import numpy as np

from cellcrawl import plot
from cellcrawl.plot.style import PAGE, paper_figure
from cellcrawl.reproduction.plane import keep_table, swept
from cellcrawl.reproduction.workspace import Workspace
from cellcrawl.sweeps import Sweep

_MEASURES: Final = {
    "circularity": r"circularity $4\pi A/L^2$",
    "tension": r"tension $\sigma$ ($\zeta_0 v_\beta/2$)",
    "x_c": "distance from start $x_c$ ($R_0$)",
}
_SYMBOL: Final = 3.2  # points: the map stays in sight
_MOVING: Final = ("gliding", "rotational", "zigzag", "other")


def make(workspace: Workspace, name: str) -> list[str]:
    """Draw the three maps, averages over t = 5 to the end and all whole cells of a point."""
    sweep = swept(workspace)
    with paper_figure(PAGE, 6.6) as figure:
        panels = figure.subplots(len(_MEASURES), 1, sharex=True)
        for letter, panel, measure in zip("ABC", panels, _MEASURES, strict=True):
            plot.measure_map(sweep, measure, "r_on", "zeta_1", colorbar=False, ax=panel)
            figure.colorbar(panel.collections[0], ax=panel, pad=0.02, label=_MEASURES[measure])
            panel.set_title(letter, loc="left", fontweight="bold")
        for letter, panel in zip("ABC", panels, strict=True):
            plot.diagram(sweep, "r_on", "zeta_1", size=_SYMBOL, ax=panel, legend=letter == "C")
        for panel in panels[:-1]:
            panel.set_xlabel("")
        workspace.picture(figure)
    keep_table(workspace, sweep, tuple(_MEASURES))
    return _found(sweep)


def _found(sweep: Sweep) -> list[str]:
    rows = [
        row
        for row in sweep.table(["r_on", "zeta_1", "mode", *_MEASURES]).to_pylist()
        if row["mode"] in _MOVING
    ]
    found = []
    for measure in _MEASURES:
        by_mode = {mode: [row[measure] for row in rows if row["mode"] == mode] for mode in _MOVING}
        shown = ", ".join(
            f"{mode} {np.mean(values):.3g} ({min(values):.3g} to {max(values):.3g})"
            for mode, values in by_mode.items()
            if values
        )
        found.append(f"{measure}: {shown}")
        for parameter in ("r_on", "zeta_1"):
            x = np.array([row[parameter] for row in rows])
            y = np.array([row[measure] for row in rows])
            found.append(
                f"{measure} and {parameter} over all that move: "
                f"correlation {np.corrcoef(x, y)[0, 1]:+.2f}"
            )
    return found
