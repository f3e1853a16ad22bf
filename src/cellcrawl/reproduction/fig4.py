"""Fig. 4: which mode where, over the stability map, and nine tracks."""

from __future__ import annotations

from collections import Counter
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.figure import SubFigure

from cellcrawl import classify, linear, plot
from cellcrawl.parameters import Parameters
from cellcrawl.plot.colouring import shared_bar
from cellcrawl.plot.style import PAGE, paper_figure
from cellcrawl.reproduction.cells import LONG, NINE, Cell
from cellcrawl.reproduction.movies import SAVE_EVERY
from cellcrawl.reproduction.plane import R_ON, ZETA_1, keep_table, swept, verdicts
from cellcrawl.reproduction.workspace import Workspace
from cellcrawl.sweeps import Sweep

_WAVES = (1, 2, 5, 10, 15)
_LIMITS = (0.1, 0.8)


def make(workspace: Workspace, name: str) -> list[str]:
    """Draw the map with the modes (A), and contours along nine tracks (B-J)."""
    end = 0.3 * LONG if workspace.quick else LONG
    sweep = swept(workspace)
    runs = {cell: workspace.run(cell.parameters, end, save_every=SAVE_EVERY) for cell in NINE}
    with paper_figure(PAGE, 9.2) as figure:
        grid = figure.add_gridspec(2, 1, height_ratios=(1.0, 1.4))
        _draw_map(workspace, sweep, figure.add_subfigure(grid[0]))
        _draw_tracks(runs, figure.add_subfigure(grid[1]))
        workspace.picture(figure)
    keep_table(workspace, sweep, ())
    for cell, run in runs.items():
        columns = {"time": run["time"], "x": run["centroid_x"], "y": run["centroid_y"]}
        workspace.table(
            f"track-{cell.r_on:g}-{cell.zeta_1:g}",
            {label: values.values for label, values in columns.items()},
        )
    named = [f"({c.r_on:g}, {c.zeta_1:g}) {classify(run).mode}" for c, run in runs.items()]
    return [*_found(sweep), f"the nine tracks: {', '.join(named)}"]


def _draw_map(workspace: Workspace, sweep: Sweep, panel: SubFigure) -> None:
    ax = panel.subplots()
    plane = {
        "r_on": np.linspace(R_ON[0] - 2, R_ON[-1] + 2, 109),
        "zeta_1": np.linspace(ZETA_1[0] - 10, ZETA_1[-1] + 10, 111),
    }
    stability = linear.stability_map(Parameters(), k=_WAVES, **plane)
    plot.stability(stability, ax=ax)
    ax.set_title("A", loc="left", fontweight="bold")
    panel.canvas.draw()  # symbols are sized by the room that the axes have
    plot.diagram(sweep, "r_on", "zeta_1", ax=ax)
    workspace.data("stability", stability)


def _draw_tracks(runs: dict[Cell, xr.Dataset], panel: SubFigure) -> None:
    axes = panel.subplots(3, 3)
    for letter, ax, (cell, run) in zip("BCDEFGHIJ", axes.ravel(), runs.items(), strict=True):
        plot.path(run, cell.apart, limits=_LIMITS, colorbar=False, ax=ax)
        ax.set_title(f"{letter}   {cell.mode} ({cell.r_on:g}, {cell.zeta_1:g})", loc="left")
    shared_bar(axes.ravel().tolist(), run, "bound_fraction", _LIMITS, shrink=0.4)


def _found(sweep: Sweep) -> list[str]:
    found = verdicts(sweep)
    points = Counter(verdict for verdict, _ in found.values())
    runs: Counter[str] = Counter()
    for _, count in found.values():
        runs += count
    return [
        f"{len(found)} points: {_listed(points)}",
        f"{runs.total()} runs: {_listed(runs)}",
        _stable_points(found),
    ]


def _stable_points(found: dict[tuple[float, float], Any]) -> str:
    """Say how far rest and linear stability of k = 1 go together."""
    rests = {point for point, (verdict, _) in found.items() if verdict == "stationary"}
    stable = {
        (r_on, zeta_1)
        for r_on, zeta_1 in found
        if linear.growth_rates(Parameters(r_on=r_on, zeta_1=zeta_1), 1)[0].real <= 0.0
    }
    return (
        f"the cell rests at {len(rests)} points, the circle is stable at {len(stable)}, "
        f"both at {len(rests & stable)}"
    )


def _listed(counts: Counter[str]) -> str:
    return ", ".join(f"{count} {name}" for name, count in counts.most_common())
