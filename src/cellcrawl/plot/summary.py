"""One page about a run: path, kymograph, tension and speed."""

from __future__ import annotations

import json
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.figure import Figure

from cellcrawl.modes import classify, is_long_enough
from cellcrawl.observables import front_position
from cellcrawl.plot.inputs import drawable
from cellcrawl.plot.kymograph import kymograph
from cellcrawl.plot.path import path
from cellcrawl.plot.scales import TIME_LABEL
from cellcrawl.plot.style import PAGE, paper_figure
from cellcrawl.plot.time_series import draw_series


def summary(dataset: xr.Dataset, every: float | None = None) -> Figure:
    """Draw one page about a run: the path, a kymograph of bound fraction, tension and speed.

    Parameters
    ----------
    dataset : Dataset
        A run.
    every : float, optional
        Time between the contours along the path; see `path`.

    Returns
    -------
    Figure

    Raises
    ------
    InputError
        For an ``every`` that is not above 0, or a dataset that is no run.
    """
    run = drawable(dataset)
    with paper_figure(PAGE, 3.9) as figure:
        grid = figure.add_gridspec(3, 2, width_ratios=[1.0, 1.15], height_ratios=[1.5, 1.0, 1.0])
        path(run, every, ax=figure.add_subplot(grid[:, 0]), colorbar=False)
        top = figure.add_subplot(grid[0, 1])
        kymograph(run, origin="front" if _has_front(run) else "material", ax=top)
        top.set_xlabel("")
        series = [figure.add_subplot(grid[row, 1], sharex=top) for row in (1, 2)]
        for panel, quantity in zip(series, ("tension", "speed"), strict=True):
            draw_series(panel, run, quantity)
        for panel in (top, series[0]):
            panel.tick_params(labelbottom=False)
        series[-1].set_xlabel(TIME_LABEL)
        figure.align_ylabels([top, *series])
        figure.suptitle(describe(run), x=0.01, ha="left")
    return figure


def _has_front(run: xr.Dataset) -> bool:
    return bool(np.isfinite(front_position(run).values).all())


def describe(run: xr.Dataset) -> str:
    """Return one line on a run: its main parameters, its seed, its mode and how it ended."""
    parameters = _parameters(run.attrs.get("parameters"))
    parts = [
        f"{symbol} = {parameters[name]:g}"
        for name, symbol in (("r_on", r"$r_\mathrm{on}$"), ("zeta_1", r"$\zeta_1$"))
        if isinstance(parameters.get(name), (int, float))
    ]
    seed = run.attrs.get("seed", -1)
    if int(seed) >= 0:
        parts.append(f"seed {int(seed)}")
    if run.attrs.get("status") == "completed" and is_long_enough(run):
        parts.append(classify(run).mode)
    end = float(run["time"].values[-1])
    parts.append(f"{run.attrs.get('status', 'run')} at $t$ = {end:.4g}")
    return ",  ".join(parts)


def _parameters(text: Any) -> dict[str, Any]:
    try:
        found = json.loads(text)
    except (TypeError, ValueError):
        return {}
    return found if isinstance(found, dict) else {}
