"""What the terminal says of a run."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import xarray as xr

from cellcrawl.command_line.main import CANCELLED, RUN_FAILED
from cellcrawl.command_line.options import near, say
from cellcrawl.data import MODEL_ENDINGS
from cellcrawl.simulation.dataset import decode_attribute

_TRANSIENT = 0.5  # part of a run taken as its transient when its motion is summed up


def report_run(dataset: xr.Dataset) -> None:
    """Say how a run ended and how the cell moved."""
    attributes = dataset.attrs
    parameters = decode_attribute(dataset, "parameters")
    diagnostics = decode_attribute(dataset, "diagnostics")
    say(
        f"cell     r_on = {parameters['r_on']:g}, zeta_1 = {parameters['zeta_1']:g}, "
        f"{parameters['elasticity']} tension law, {_start(dataset)}"
    )
    say(f"run      {attributes['status']}: {attributes['status_message']}")
    say(
        f"solver   {attributes['solver']}, {diagnostics['steps']:,} steps, "
        f"{diagnostics['wall_time']:.2f} s"
    )
    _report_motion(dataset)
    _report_mode(dataset)


def _report_motion(dataset: xr.Dataset) -> None:
    from cellcrawl import observables

    if dataset.sizes["time"] < 3:
        return
    late = dataset.isel(time=slice(int(_TRANSIENT * dataset.sizes["time"]), None))
    x, y = late["centroid_x"].values, late["centroid_y"].values
    speed = observables.speed(late).values
    tension = late["tension"].values
    headings = observables.heading(late).values
    headings = headings[np.isfinite(headings)]
    start, end = float(late["time"][0]), float(late["time"][-1])
    turned = (
        f"turned {math.degrees(headings[-1] - headings[0]):+.0f} degrees in all"
        if headings.size
        else "at rest"
    )
    say(
        f"motion   from t = {start:g} to {end:g}: speed {speed.mean():.3f}, "
        f"net distance {math.hypot(x[-1] - x[0], y[-1] - y[0]):.2f}, {turned}, "
        f"tension {tension.min():.0f} to {tension.max():.0f}"
    )


def _start(dataset: xr.Dataset) -> str:
    """Say what the run started from."""
    seed = int(dataset.attrs.get("seed", -1))
    if seed >= 0:
        return f"seed {seed}"
    return f"start {decode_attribute(dataset, 'start').get('kind', 'of your own')}"


def _report_mode(dataset: xr.Dataset) -> None:
    from cellcrawl.modes import FEWEST_RECORDS, SHORTEST_RUN, classify, is_long_enough

    torn = dataset.attrs["status"] == "fragmented"
    if not torn and dataset.sizes["time"] < FEWEST_RECORDS:
        return
    found = classify(dataset)
    if torn or is_long_enough(dataset):
        detail = f" ({found.detail})" if found.detail else ""
        say(f"mode     {found.mode}{detail}, confidence {found.confidence:.2f}: {found.summary()}")
    else:
        say(f"mode     {found.mode} so far; a run to t = {SHORTEST_RUN:g} or more can tell")


def report_sweep(found: Any) -> None:
    """Say what a sweep is, how far it is and which modes it has found."""
    status = found.status()
    say(f"grid     {found.grid.summary()}: {len(found.grid)} runs{_refined(found, status)}")
    left = status.runs - status.done
    at_work = ", a sweep is at work" if status.at_work else ""
    say(f"done     {status.done}" + (f", {left} left" if left else "") + at_work)
    if status.statuses:
        say(f"ended    {_counted(status.statuses)}")
    if status.modes:
        say(f"modes    {_counted(status.modes)}")
    for reason, count in found.failures().items():
        say(f"failed   {count}: {reason}")
    say(f"rows     {near(found.path / 'rows')}")


def _refined(found: Any, status: Any) -> str:
    full = found.full_grid_runs()
    if full is None:
        return ""
    return f", refined to {status.done} of the {full} of the full grid ({status.done / full:.0%})"


def _counted(counts: dict[str, int]) -> str:
    ordered = sorted(counts.items(), key=lambda item: -item[1])
    return ", ".join(f"{name} {count}" for name, count in ordered)


def exit_code(status: str) -> int:
    """Return the exit code of a run that ended with ``status``."""
    if status in MODEL_ENDINGS:
        return 0
    return CANCELLED if status == "interrupted" else RUN_FAILED
