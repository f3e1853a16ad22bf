"""Fig. 3: how a round cell at (25, 600) finds a front, t = 0 to 2."""

from __future__ import annotations

import numpy as np
import xarray as xr

from cellcrawl import observables, plot
from cellcrawl.parameters import Parameters
from cellcrawl.plot.style import PAGE, paper_figure
from cellcrawl.reproduction.workspace import Workspace
from cellcrawl.simulation import simulate
from cellcrawl.starts import RandomPerturbation

_CELL = Parameters(r_on=25, zeta_1=600)
_SEED = 16  # one of those that have a single front at t = 2
_SEEDS = 24
_FIELDS = ("bound_fraction", "off_rate", "friction", "curvature")


def make(workspace: Workspace, name: str) -> list[str]:
    """Draw the cell at five times over the kymographs of four fields."""
    end = 1.0 if workspace.quick else 2.0
    run = workspace.run(_CELL, end, seed=_SEED, save_every=0.01)
    times = end * np.linspace(0.0, 1.0, 5)
    with paper_figure(PAGE, 4.6) as figure:
        grid = figure.add_gridspec(2, 1, height_ratios=(1.0, 2.2))
        above, below = (figure.add_subfigure(grid[row]) for row in (0, 1))
        cells = above.subplots(1, len(times))
        plot.snapshots(run, times, axes=cells.tolist())
        cells[0].text(-0.05, 1.06, "A", transform=cells[0].transAxes, fontweight="bold", fontsize=9)
        panels = below.subplots(2, 2, sharex=True, sharey=True)
        plot.kymographs(run, axes=panels.ravel().tolist())
        for letter, panel in zip("BCDE", panels.ravel(), strict=True):
            panel.set_title(f"{letter}   {panel.get_title(loc='left')}", loc="left")
        for panel in panels[0]:
            panel.set_xlabel("")
        for panel in panels[:, 1]:
            panel.set_ylabel("")
        workspace.picture(figure)
    shown = {field: observables.kymograph(run, field) for field in _FIELDS}
    workspace.data("kymographs", xr.Dataset(shown))
    fronts = [
        _fronts(_CELL, seed, end) for seed in range(1, (4 if workspace.quick else _SEEDS) + 1)
    ]
    workspace.table("fronts", {"seed": np.arange(1, len(fronts) + 1), "fronts": fronts})
    counted = ", ".join(f"{fronts.count(n)} have {n}" for n in sorted(set(fronts)))
    return [*_found(run), f"fronts at t = {end:g} from {len(fronts)} random starts: {counted}"]


def _fronts(cell: Parameters, seed: int, end: float) -> int:
    """Return the number of stretches of edge that stick, at the end of a run."""
    run = simulate(cell, end, start=RandomPerturbation(seed=seed), save_every=end)
    sticks = run["bound_fraction"].values[-1] > 0.45  # between the two states, 0.2 and 0.7
    return int(np.sum(sticks & ~np.roll(sticks, 1)))


def _found(run: xr.Dataset) -> list[str]:
    noise = observables.fourier_amplitude(run.isel(time=[0, 50]), "bound_fraction", range(20, 101))
    power = np.sqrt(np.sum(np.abs(noise.values) ** 2, axis=1))
    last = run.isel(time=-1)
    front = observables.kymograph(run, "bound_fraction").isel(time=-1)
    rates = observables.kymograph(run, "off_rate").isel(time=-1)
    ahead, behind = abs(front["arclength"]) < 0.1, abs(front["arclength"]) > 0.4
    friction, curvature = last["friction"].values, last["curvature"].values
    together = float(np.corrcoef(friction, curvature)[0, 1])
    return [
        f"waves k = 20 to 100 of the bound fraction fall to {power[1] / power[0]:.1%} by t = 0.5",
        f"at the end n = {float(front[ahead].mean()):.2f} at the front, "
        f"{float(front[behind].mean()):.2f} at the rear; r = {float(rates[ahead].mean()):.0f} "
        f"and {float(rates[behind].mean()):.0f}",
        f"friction and curvature along the edge correlate by {together:.3f}",
    ]
