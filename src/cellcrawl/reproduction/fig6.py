"""Fig. 6: a gliding cell whose adhesion changes becomes a zigzagging one, whatever the route."""

from __future__ import annotations

from typing import Final

import numpy as np
import xarray as xr
from matplotlib.axes import Axes

from cellcrawl import classify, observables, plot
from cellcrawl.parameters import Parameters, Schedule
from cellcrawl.plot.labels import time_label
from cellcrawl.plot.style import PAGE, RIM, paper_figure
from cellcrawl.plot.time_series import draw_series
from cellcrawl.reproduction.cells import through
from cellcrawl.reproduction.workspace import Workspace

GLIDES: Final = (16.0, 580.0)
ZIGZAGS: Final = (30.0, 580.0)
_BETWEEN: Final = (24.0, 540.0)
_FRESH: Final = "(30, 580) from the start"
_ROUND: Final = (56.0, 560.0)
_ZIGZAGS_TOO: Final = (26.0, 600.0)
_LOOKS: Final = (("#9ecae1", 0.8), ("#0072b2", 1.2), ("#d55e00", 1.2))


def routes(scale: float = 1.0) -> dict[str, Schedule]:
    """Return the changes from one to the other by name, times multiplied by ``scale``.

    Names say when a change begins and how long it takes.
    """

    def ramp(start: float, over: float) -> tuple[str, Schedule]:
        start, end = scale * start, scale * (start + over)
        how = f"over {end - start:g}" if over else "abrupt"
        return f"at {start:g}, {how}", through([(start, GLIDES), (end, ZIGZAGS)])

    there, back = scale * 25, scale * 50
    by = [(there, GLIDES), (there, _BETWEEN), (back, _BETWEEN), (back, ZIGZAGS)]
    ramps = [ramp(25, 0), ramp(25, 10), ramp(25, 25), ramp(50, 0), ramp(50, 10)]
    return {**dict(ramps), f"by (24, 540), {there:g} to {back:g}": through(by)}


def make(workspace: Workspace, name: str) -> list[str]:
    """Draw contours around the jump, and tension over time on every route."""
    scale = 0.1 if workspace.quick else 1.0
    end = 100.0 * scale
    first = Parameters(r_on=GLIDES[0], zeta_1=GLIDES[1])
    runs = {
        label: workspace.run(first, end, schedule=schedule, save_every=0.1)
        for label, schedule in list(routes(scale).items())[: 2 if workspace.quick else None]
    }
    fresh = workspace.run(first.replace(r_on=ZIGZAGS[0]), end, save_every=0.1)
    abrupt = next(iter(runs.values()))
    window = abrupt.sel(time=slice(10.0 * scale, 70.0 * scale))
    round_ones = _from_round(workspace, scale)
    with paper_figure(PAGE, 1.9 + 0.62 * len(runs)) as figure:
        grid = figure.add_gridspec(1, 2, width_ratios=(1.0, 1.7))
        left = figure.add_subfigure(grid[0]).subplots()
        plot.path(window, every=5.0 * scale, times=True, ax=left)
        heights = [1.0] * len(runs) + [2.2]
        *upper, lower = figure.add_subfigure(grid[1]).subplots(
            len(runs) + 1, 1, height_ratios=heights
        )
        _draw_routes(upper, runs, fresh)
        _draw_from_round(lower, round_ones)
        lower.set_xlim(20.0 * scale, 45.0 * scale)
        for panel, letter in ((left, "A"), (upper[0], "B"), (lower, "C")):
            panel.set_title(letter, loc="left", fontweight="bold")
        workspace.picture(figure)
    tension = {label: run["tension"] for label, run in {**runs, _FRESH: fresh}.items()}
    columns = {label: values.values for label, values in tension.items()}
    workspace.table("tension", {"time": fresh["time"].values, **columns})
    columns = {label: run["tension"].values for label, run in round_ones.items()}
    times = next(iter(round_ones.values()))["time"].values
    workspace.table("tension-from-round", {"time": times, **columns})
    return [*_found(tension, end), *_found_from_round(round_ones, end)]


def _draw_routes(panels: list[Axes], runs: dict[str, xr.Dataset], fresh: xr.Dataset) -> None:
    """Draw the tension on each route over that of a cell that zigzags from the start, in grey."""
    for number, (panel, (label, run)) in enumerate(zip(panels, runs.items(), strict=True)):
        draw_series(panel, run, "tension")
        panel.plot(fresh["time"], fresh["tension"], color=RIM, linewidth=0.7, zorder=1.0)
        known = label if number else f"{label};  grey: {_FRESH}"
        panel.text(0.0, 1.0, f" {known}", transform=panel.transAxes, va="top", fontsize="small")
        panel.set_ylim(600.0, 1250.0)
        panel.set_yticks([700.0, 1000.0])
        if number != len(runs) // 2:
            panel.set_ylabel("")
        panel.tick_params(labelbottom=number == len(runs) - 1)
    panels[-1].set_xlabel(time_label(fresh))


def _draw_from_round(panel: Axes, runs: dict[str, xr.Dataset]) -> None:
    for (label, run), (colour, width) in zip(runs.items(), _LOOKS, strict=True):
        draw_series(panel, run, "tension", colour, label)
        panel.lines[-1].set_linewidth(width)
    panel.set_xlabel(time_label(run))
    panel.legend(frameon=False, ncols=1, loc="upper right", handlelength=1.4)


def _from_round(workspace: Workspace, scale: float) -> dict[str, xr.Dataset]:
    """Return runs of a nearly round glider made to zigzag: by a jump, slowly, by the other law."""
    runs = {}
    for law, over in (("printed", 0.0), ("printed", 10.0), ("consistent", 0.0)):
        cell = Parameters(r_on=_ROUND[0], zeta_1=_ROUND[1], elasticity=law)
        schedule = through([(scale * 25, _ROUND), (scale * (25 + over), _ZIGZAGS_TOO)])
        how = f"over {scale * over:g}" if over else "abrupt"
        runs[f"{how}, {law} law"] = workspace.run(
            cell, 100.0 * scale, schedule=schedule, save_every=0.04, nodes=64
        )
    return runs


def _found_from_round(runs: dict[str, xr.Dataset], end: float) -> list[str]:
    found = []
    for label, run in runs.items():
        late = run.sel(time=slice(0.6 * end, None))
        tension = late["tension"].values
        found.append(
            f"(56, 560) to (26, 600), {label}: {classify(late).mode}, tension "
            f"{tension.min():.0f} to {tension.max():.0f}, "
            f"speed {float(observables.speed(late).mean()):.3f}"
        )
    return found


def _found(tension: dict[str, xr.DataArray], end: float) -> list[str]:
    late = {label: t.sel(time=slice(0.8 * end, None)).values for label, t in tension.items()}
    return [
        f"tension at the end, {label}: {values.min():.0f} to {values.max():.0f}, "
        f"mean {np.mean(values):.1f}"
        for label, values in late.items()
    ]
