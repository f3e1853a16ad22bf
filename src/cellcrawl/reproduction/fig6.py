"""Fig. 6: a gliding cell whose adhesion changes becomes a zigzagging one, whatever the route."""

from __future__ import annotations

from typing import Final

import numpy as np
import xarray as xr

from cellcrawl import plot
from cellcrawl.parameters import Parameters, Schedule
from cellcrawl.plot.style import PAGE, paper_figure
from cellcrawl.reproduction.cells import through
from cellcrawl.reproduction.workplace import Workplace

GLIDES: Final = (16.0, 580.0)
ZIGZAGS: Final = (30.0, 580.0)
_BETWEEN: Final = (24.0, 540.0)
_FRESH: Final = "(30, 580) from the start"


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
        for label, schedule in routes(scale).items()
    }
    fresh = workplace.run(first.replace(r_on=ZIGZAGS[0]), end, save_every=0.1)
    abrupt = next(iter(runs.values()))
    window = abrupt.sel(time=slice(10.0 * scale, 70.0 * scale))
    with paper_figure(PAGE, 3.6) as figure:
        left, right = figure.subplots(1, 2, width_ratios=(1.0, 1.9))
        plot.path(window, every=5.0 * scale, times=True, ax=left)
        left.set_title("A", loc="left", fontweight="bold")
        plot.time_series({**runs, _FRESH: fresh}, ["tension"], axes=[right])
        right.legend(frameon=False, ncols=2, loc="upper center", bbox_to_anchor=(0.5, -0.14))
        right.set_title("B", loc="left", fontweight="bold")
        workplace.picture(figure)
    tension = {label: run["tension"] for label, run in runs.items()}
    tension[_FRESH] = fresh["tension"]
    workplace.table(
        "tension",
        {"time": fresh["time"].values, **{label: t.values for label, t in tension.items()}},
    )
    return _found(tension, end)


def _found(tension: dict[str, xr.DataArray], end: float) -> list[str]:
    late = {label: t.sel(time=slice(0.8 * end, None)).values for label, t in tension.items()}
    return [
        f"tension at the end, {label}: {values.min():.0f} to {values.max():.0f}, "
        f"mean {np.mean(values):.1f}"
        for label, values in late.items()
    ]
