"""How often the classifier is right: on tracks with known answers, on the paper's named points."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Callable, Iterator
from functools import partial
from typing import Any, NamedTuple

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from cellcrawl.modes import Classification, classify, classify_track, combine
from cellcrawl.modes.synthetic import RECIPES, synthetic_tracks
from cellcrawl.observables import heading as heading_of
from cellcrawl.observables import turning_events
from cellcrawl.parameters import Parameters
from cellcrawl.parameters.paper_cells import PAPER_MODES
from cellcrawl.plot.edge import frame, scale_bar
from cellcrawl.plot.labels import time_label
from cellcrawl.plot.style import PAGE, RIM, TRACK, paper_figure
from cellcrawl.plot.track_panels import LEFT, RIGHT
from cellcrawl.simulation import simulate
from cellcrawl.starts import RandomPerturbation

SURE = 0.9
"""A wrong name with at least this confidence is a bad mistake."""
_TURNS_SHOWN = 0.25  # least range of a heading that is drawn, so that a straight one looks straight
_SEEDS = (1, 2, 3, 4, 5)
_SIDES = (("left", LEFT), ("right", RIGHT))


class Kind(NamedTuple):
    """How one kind of synthetic track was named."""

    kind: str
    mode: str
    tracks: int
    right: int
    wrong_and_sure: int
    found: str


class Point(NamedTuple):
    """How the runs at one named point were named, under one condition."""

    point: str
    paper: str
    condition: str
    most: str
    agrees: bool
    confidence: float
    found: str


def measure_kinds(quick: bool = False) -> Iterator[Kind]:
    """Name synthetic tracks, kind by kind."""
    each = 30 if quick else 200
    for seed, (kind, (mode, _)) in enumerate(RECIPES.items()):
        results = [
            classify_track(track.t, track.x, track.y)
            for track in synthetic_tracks(each, seed, (kind,))
        ]
        wrong = [result for result in results if result.mode != mode]
        sure = sum(result.confidence >= SURE for result in wrong)
        found = Counter(result.mode for result in results)
        yield Kind(kind, mode, each, each - len(wrong), sure, _counted(found))


def measure_points(quick: bool = False) -> Iterator[Point]:
    """Name runs of the nine points, as they are and with less to see."""
    for (r_on, zeta_1), paper in PAPER_MODES.items():
        runs = [_run(r_on, zeta_1, seed) for seed in (_SEEDS[:3] if quick else _SEEDS)]
        for condition, seen in _CONDITIONS.items():
            yield _point(r_on, zeta_1, paper, condition, [seen(run) for run in runs])
    if not quick:
        yield from _spin()


def _spin() -> Iterator[Point]:
    """The point whose label hangs on the solver: as published, and for longer."""
    published: dict[str, Any] = {"solver": "paper", "nodes": 2000, "dt": 1e-3}
    for condition, options in {
        "the paper's scheme as published, track alone": published,
        "to t = 400, track alone": {"t_end": 400.0},
    }.items():
        runs = [_run(44, 560, seed, **options) for seed in _SEEDS]
        results = [classify(run, use_size=False) for run in runs]
        yield _point(44, 560, PAPER_MODES[44, 560], condition, results)


def _point(
    r_on: float, zeta_1: float, paper: str, condition: str, results: list[Classification]
) -> Point:
    verdict = combine(results)
    return Point(
        f"({r_on:g}, {zeta_1:g})",
        paper,
        condition,
        verdict.majority,
        verdict.majority == paper,
        verdict.confidence,
        _counted(verdict.counts),
    )


def _run(r_on: float, zeta_1: float, seed: int, **options: Any) -> xr.Dataset:
    settings = {"t_end": 100.0, "save_every": 0.1, "nodes": 64, **options}
    start = RandomPerturbation(seed=seed)
    return simulate(Parameters(r_on=r_on, zeta_1=zeta_1), start=start, **settings)


def _every(records: int, run: xr.Dataset) -> Classification:
    return classify(run.isel(time=slice(None, None, records)))


def _until(time: float, run: xr.Dataset) -> Classification:
    return classify(run.sel(time=slice(None, time)))


def _noisy(error: float, run: xr.Dataset) -> Classification:
    random = np.random.default_rng(int(run.attrs["seed"]))
    added = {
        name: run[name] + error * random.standard_normal(run.sizes["time"])
        for name in ("centroid_x", "centroid_y")
    }
    return classify(run.assign(added))


_CONDITIONS: dict[str, Callable[[xr.Dataset], Classification]] = {
    "as it is": classify,
    "track alone": partial(classify, use_size=False),
    "every 2nd record": partial(_every, 2),
    "every 10th record": partial(_every, 10),
    "to t = 50": partial(_until, 50.0),
    "positions to 0.02": partial(_noisy, 0.02),
    "positions to 0.05": partial(_noisy, 0.05),
}


def _counted(found: dict[str, int]) -> str:
    return ", ".join(f"{count} {mode}" for mode, count in found.items())


def plot() -> Figure:
    """Draw track and heading of each named point, with the turns in colour."""
    with paper_figure(PAGE, 6.6) as figure:
        panels = np.ravel(np.asarray(figure.subfigures(3, 3)))
        for number, (panel, point) in enumerate(zip(panels, PAPER_MODES, strict=True)):
            run = _run(*point, 1)
            found = classify(run)
            track, heading = panel.subplots(2, 1, height_ratios=[1.5, 1.0])
            name = f"{found.mode}, {found.detail}" if found.detail else found.mode
            track.set_title(f"({point[0]:g}, {point[1]:g})  {name}", loc="left")
            _draw(track, heading, run.sel(time=slice(found.measures.start, None)), run)
            if number % 3 == 0:
                heading.set_ylabel("heading (turns)")
            if number > 5:
                heading.set_xlabel(time_label(run))
        keys = [Line2D([], [], color=colour, label=f"turns {side}") for side, colour in _SIDES]
        figure.legend(handles=keys, loc="outside upper right", ncols=2, frameon=False)
    return figure


def _draw(track: Axes, heading: Axes, settled: xr.Dataset, run: xr.Dataset) -> None:
    x, y = run["centroid_x"].values, run["centroid_y"].values
    track.plot(x, y, color=RIM, linewidth=0.8)
    track.plot(x[0], y[0], "o", color=TRACK, markersize=2.5)
    places = np.column_stack([x, y])
    margin = 0.05 * np.ptp(places, axis=0).max()
    frame(track, places.min(axis=0) - margin, places.max(axis=0) + margin, fill=True)
    scale_bar(track, run)
    angle = heading_of(run).sel(time=settled["time"]) / (2.0 * math.pi)
    angle = angle - angle[0]
    heading.plot(angle["time"], angle, color=RIM, linewidth=0.8)
    turns = turning_events(settled)
    for start, end, sign in zip(turns["start"], turns["end"], turns["sign"], strict=True):
        part = slice(float(start), float(end))
        colour = LEFT if sign > 0 else RIGHT
        turn = settled.sel(time=part)
        track.plot(turn["centroid_x"], turn["centroid_y"], color=colour, linewidth=1.2)
        heading.plot(turn["time"], angle.sel(time=part), color=colour, linewidth=1.2)
    heading.set_xlim(0.0, float(run["time"][-1]))
    heading.spines[["top", "right"]].set_visible(False)
    low, high = heading.get_ylim()
    if high - low < _TURNS_SHOWN:
        middle = 0.5 * (low + high)
        heading.set_ylim(middle - 0.5 * _TURNS_SHOWN, middle + 0.5 * _TURNS_SHOWN)
