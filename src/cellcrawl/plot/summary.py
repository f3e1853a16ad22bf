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
from cellcrawl.plot.style import PAGE, fixed_figure
from cellcrawl.plot.time_series import draw_series

_HEIGHT = 3.9
# left, bottom, width, height of the panels in inches; room for two-line labels and long numbers
_PATH = (0.05, 0.3, 2.56, 3.25)
_KYMOGRAPH = (3.46, 2.36, 2.92, 1.3)
_SERIES = ((3.46, 1.375, 2.92, 0.87), (3.46, 0.39, 2.92, 0.87))
_COLOURS = (6.53, 2.36, 0.08, 1.3)


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
    with fixed_figure(PAGE, _HEIGHT) as figure:
        path(run, every, ax=figure.add_axes(_part(_PATH)), colorbar=False)
        top = figure.add_axes(_part(_KYMOGRAPH))
        kymograph(run, origin="front" if _has_front(run) else "material", ax=top)
        top.set_position(_part(_KYMOGRAPH))
        figure.axes[-1].set_position(_part(_COLOURS))
        top.set_xlabel("")
        series = [figure.add_axes(_part(place), sharex=top) for place in _SERIES]
        for panel, quantity in zip(series, ("tension", "speed"), strict=True):
            draw_series(panel, run, quantity)
        for panel in (top, series[0]):
            panel.tick_params(labelbottom=False)
        series[-1].set_xlabel(TIME_LABEL)
        figure.align_ylabels([top, *series])
        figure.suptitle(describe(run), x=0.01, ha="left")
    return figure


def _part(place: tuple[float, float, float, float]) -> tuple[float, float, float, float]:
    """Return a place in inches as parts of the page."""
    left, bottom, width, height = place
    return left / PAGE, bottom / _HEIGHT, width / PAGE, height / _HEIGHT


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
