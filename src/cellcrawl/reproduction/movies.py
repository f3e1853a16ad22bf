"""Movies S1-S9, the nine named cells, and S10-S12, cells that change from mode to mode."""

from __future__ import annotations

from typing import Any

import numpy as np
import xarray as xr

from cellcrawl import classify, observables
from cellcrawl.reproduction.cells import LONG, NINE, TRANSITIONS
from cellcrawl.reproduction.workspace import Workspace

SAVE_EVERY = 0.1
_SETTLES = 10.0  # time after a change that is left out when the mode is named


def make(workspace: Workspace, name: str) -> list[str]:
    """Film one of them, ten seconds long."""
    number = int(name.removeprefix("movie-s")) - 1
    end = 0.1 * LONG if workspace.quick else LONG
    if number < len(NINE):
        run = workspace.run(NINE[number].parameters, end, save_every=SAVE_EVERY)
    else:
        change = TRANSITIONS[number - len(NINE)]
        scale = end / LONG
        change = change._replace(time=change.time * scale, over=change.over * scale)
        run = workspace.run(change.parameters, end, schedule=change.schedule, save_every=SAVE_EVERY)
    options: dict[str, Any] = {"seconds": 1.0, "size": (320, 240)} if workspace.quick else {}
    workspace.movie(run, **options)
    centre = np.column_stack([run["centroid_x"].values, run["centroid_y"].values])
    workspace.table(
        "track",
        {
            "time": run["time"].values,
            "x": centre[:, 0],
            "y": centre[:, 1],
            "tension": run["tension"].values,
            "speed": observables.speed(run).values,
        },
    )
    return [f"{run.attrs['status']} at t = {end:g}: {_modes(run, name, end)}"]


def _modes(run: xr.Dataset, name: str, end: float) -> str:
    """Name the mode, or those before and after the change."""
    number = int(name.removeprefix("movie-s")) - 1
    if number < len(NINE):
        return classify(run).mode
    change = TRANSITIONS[number - len(NINE)]
    settled = change.time + change.over + _SETTLES
    before = run.sel(time=slice(None, change.time * end / LONG))
    after = run.sel(time=slice(settled * end / LONG, None))
    return f"{classify(before).mode}, then {classify(after).mode}"
