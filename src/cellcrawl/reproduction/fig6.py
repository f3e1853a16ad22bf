"""Fig. 6: a gliding cell whose adhesion changes becomes a zigzagging one, whatever the route."""

from __future__ import annotations

from typing import Final

import numpy as np
import xarray as xr

from cellcrawl import classify, observables, plot
from cellcrawl.parameters import Parameters, Schedule
from cellcrawl.plot.style import PAGE, paper_figure
from cellcrawl.reproduction.cells import through
from cellcrawl.reproduction.workplace import Workplace

GLIDES: Final = (16.0, 580.0)
ZIGZAGS: Final = (30.0, 580.0)
_BETWEEN: Final = (24.0, 540.0)
_FRESH: Final = "(30, 580) from the start"
_ROUND: Final = (56.0, 560.0)
_ZIGZAGS_TOO: Final = (26.0, 600.0)


def routes(scale: float = 1.0) -> dict[str, Schedule]:
    """Return the changes from one to the other by name, times multiplied by ``scale``."""

    def ramp(start: float, over: float) -> Schedule:
        return through([(scale * start, GLIDES), (scale * (start + over), ZIGZAGS)])

    return {
        "t₀ = 25, abrupt": ramp(25, 0),
        "t₀ = 25, Δt = 10": ramp(25, 10),
        "t₀ = 25, Δt = 25": ramp(25, 25),
        "t₀ = 50, abrupt": ramp(50, 0),
        "t₀ = 50, Δt = 10": ramp(50, 10),
        "by (24, 540), 25 to 50": through(
            [
                (scale * 25, GLIDES),
                (scale * 25, _BETWEEN),
                (scale * 50, _BETWEEN),
                (scale * 50, ZIGZAGS),
            ]
        ),
    }


def make(workplace: Workplace, name: str) -> list[str]:
    """Draw contours around the jump, and tension over time on every route."""
    scale = 0.1 if workplace.quick else 1.0
    end = 100.0 * scale
    first = Parameters(r_on=GLIDES[0], zeta_1=GLIDES[1])
    runs = {
        label: workplace.run(first, end, schedule=schedule, save_every=0.1)
        for label, schedule in list(routes(scale).items())[: 2 if workplace.quick else None]
    }
    fresh = workplace.run(first.replace(r_on=ZIGZAGS[0]), end, save_every=0.1)
    abrupt = next(iter(runs.values()))
    window = abrupt.sel(time=slice(10.0 * scale, 70.0 * scale))
    round_ones = _from_round(workplace, scale)
    with paper_figure(PAGE, 5.2) as figure:
        grid = figure.add_gridspec(2, 2, width_ratios=(1.0, 1.9), height_ratios=(1.5, 1.0))
        left = figure.add_subplot(grid[:, 0])
        plot.path(window, every=5.0 * scale, times=True, ax=left)
        upper, lower = (figure.add_subplot(grid[row, 1]) for row in (0, 1))
        plot.time_series({**runs, _FRESH: fresh}, ["tension"], axes=[upper])
        plot.time_series(round_ones, ["tension"], axes=[lower])
        lower.set_xlim(20.0 * scale, 45.0 * scale)
        for panel, below in ((upper, -0.2), (lower, -0.32)):
            panel.legend(frameon=False, ncols=2, loc="upper center", bbox_to_anchor=(0.5, below))
        for panel, letter in ((left, "A"), (upper, "B"), (lower, "C")):
            panel.set_title(letter, loc="left", fontweight="bold")
        workplace.picture(figure)
    tension = {label: run["tension"] for label, run in {**runs, _FRESH: fresh}.items()}
    columns = {label: values.values for label, values in tension.items()}
    workplace.table("tension", {"time": fresh["time"].values, **columns})
    columns = {label: run["tension"].values for label, run in round_ones.items()}
    times = next(iter(round_ones.values()))["time"].values
    workplace.table("tension-from-round", {"time": times, **columns})
    return [*_found(tension, end), *_found_from_round(round_ones, end)]


def _from_round(workplace: Workplace, scale: float) -> dict[str, xr.Dataset]:
    """Return runs of a nearly round glider made to zigzag: by a jump, slowly, by the other law."""
    runs = {}
    for law, over in (("printed", 0.0), ("printed", 10.0), ("consistent", 0.0)):
        cell = Parameters(r_on=_ROUND[0], zeta_1=_ROUND[1], elasticity=law)
        schedule = through([(scale * 25, _ROUND), (scale * (25 + over), _ZIGZAGS_TOO)])
        how = f"Δt = {over:g}" if over else "abrupt"
        runs[f"{how}, {law} law"] = workplace.run(
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
