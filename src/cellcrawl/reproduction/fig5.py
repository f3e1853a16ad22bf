"""Fig. 5: tension, shape and velocity through one period of a rotation and of a zigzag."""

from __future__ import annotations

from typing import Any, Final, NamedTuple

import numpy as np
import xarray as xr

from cellcrawl import observables, plot
from cellcrawl.parameters import Parameters
from cellcrawl.plot.colouring import shared_bar
from cellcrawl.plot.style import PAGE, paper_figure
from cellcrawl.reproduction.cells import LONG
from cellcrawl.reproduction.movies import SAVE_EVERY
from cellcrawl.reproduction.workspace import Workspace


class _Panel(NamedTuple):
    r_on: float
    zeta_1: float
    mode: str
    shapes: int
    turns: int
    """How many turns, each with a peak of tension, make a cycle: two in a zigzag."""


_LIMITS: Final = (0.1, 0.8)
_PANELS: Final = (_Panel(24, 540, "rotation", 10, 1), _Panel(26, 600, "zigzag", 12, 2))


def make(workspace: Workspace, name: str) -> list[str]:
    """Draw one period of each, from a minimum of the tension on."""
    end, found = 0.6 * LONG if workspace.quick else LONG, []
    with paper_figure(PAGE, 5.2) as figure:
        axes = figure.subplots(2 * len(_PANELS), 1, height_ratios=(1.4, 1.0) * len(_PANELS))
        for letter, panel, pair in zip("AB", _PANELS, axes.reshape(-1, 2).tolist(), strict=True):
            cell = Parameters(r_on=panel.r_on, zeta_1=panel.zeta_1)
            run = workspace.run(cell, end, save_every=SAVE_EVERY)
            start, turn = period(run)
            duration = panel.turns * turn
            look: Any = {"shapes": panel.shapes, "limits": _LIMITS, "colorbar": False}
            plot.cycle(run, start, duration, axes=pair, **look)
            pair[0].set_title(
                f"{letter}   {panel.mode}, ({panel.r_on:g}, {panel.zeta_1:g})", loc="left"
            )
            stretch = run.sel(time=slice(start, start + duration))
            _keep(workspace, panel.mode, stretch)
            found.append(f"{panel.mode}: {_found(run, stretch, turn)}")
        shared_bar(axes.tolist(), stretch, "bound_fraction", _LIMITS, shrink=0.5)
        workspace.picture(figure)
    return found


def period(run: xr.Dataset) -> tuple[float, float]:
    """Return when a period of the tension begins, at a minimum past half time, and its length."""
    found = observables.tension_oscillation(run).period
    middle = 0.5 * float(run["time"][-1])
    tension = run["tension"].sel(time=slice(middle, middle + found))
    return float(tension["time"][int(np.argmin(tension.values))]), found


def _keep(workspace: Workspace, mode: str, stretch: xr.Dataset) -> None:
    velocity = observables.centroid_velocity(stretch)
    workspace.table(
        mode,
        {
            "time": stretch["time"].values,
            "tension": stretch["tension"].values,
            "velocity_x": velocity.sel(component="x").values,
            "velocity_y": velocity.sel(component="y").values,
            "left_right_asymmetry": observables.left_right_asymmetry(stretch).values,
        },
    )
    workspace.data(f"{mode}-edge", stretch[["x", "y", "bound_fraction"]])


def _found(run: xr.Dataset, stretch: xr.Dataset, turn: float) -> str:
    late = run.sel(time=slice(0.5 * float(run["time"][-1]), None))
    tension = late["tension"].values
    turning = np.abs(observables.turning_rate(late).values)
    high = tension > 0.5 * (tension.min() + tension.max())
    turned = turning[high].sum() / turning.sum()
    sides = observables.left_right_asymmetry(stretch).values
    return (
        f"tension {tension.min():.0f} to {tension.max():.0f} with a period of {turn:.2f}; "
        f"{turned:.0%} of all turning falls in the {high.mean():.0%} of the time when the tension "
        f"is in its upper half; left-right asymmetry of n from {sides.min():+.2f} to "
        f"{sides.max():+.2f}"
    )
