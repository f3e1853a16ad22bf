"""Sheets about tracks: what they do, and a model and data side by side."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import xarray as xr
from matplotlib.figure import Figure

from cellcrawl.arguments import checked
from cellcrawl.errors import InputError
from cellcrawl.microscopy.outlines import Outlines
from cellcrawl.microscopy.track import Track, Tracks
from cellcrawl.modes import FEWEST_RECORDS, MODES, Classification, classify_track
from cellcrawl.observables.drift import shared_drift
from cellcrawl.observables.random_walk import PersistentWalk
from cellcrawl.observables.track import as_track
from cellcrawl.plot.style import PAGE, paper_figure
from cellcrawl.plot.track_panels import (
    draw_counts,
    draw_displacement,
    draw_paths,
    draw_rose,
    draw_turns,
    shown_units,
)
from cellcrawl.validation import listed, shown

Results = Sequence[Classification | None]
_EXAMPLES = 8
_ACROSS = 4


@checked
def tracks(
    tracks: Any, results: Results | None = None, *, title: str = "", examples: int = _EXAMPLES
) -> Figure:
    """Draw a sheet of tracks: paths, modes, directions, displacements and single cells.

    Above, the paths in place and from one start in the colours of their modes, and how many show
    each mode (the full part of a bar is the mean confidence). In the middle, the mean squared
    displacement with a persistent random walk fitted to the tracks (see
    `observables.persistent_walk`), and how much of the way goes in each direction. Below, single
    tracks of every mode with the heading over time in whole turns, turns to the left red and to
    the right blue. A dot marks the end of a track.

    Parameters
    ----------
    tracks : Tracks, Outlines, Track, or sequence of Track or of runs
        What `read_tracks` returns, or anything like it.
    results : sequence of Classification or None, optional
        The classification of each; found unless given.
    title : str
        Stands above.
    examples : int
        How many single tracks to show.

    Returns
    -------
    Figure

    Raises
    ------
    InputError
        If there are no tracks, or not as many results.

    Notes
    -----
    Left, right and angles are those seen on the screen, also where y points down. Of more than 400
    tracks 400 are drawn, evenly spread; counts are of all.
    """
    given = as_tracks(tracks)
    found = _results(given, results)
    chosen = _examples(given, found, examples)
    rows = -(-len(chosen) // _ACROSS)
    with paper_figure(PAGE, 4.5 + 1.75 * rows, shown=True) as figure:
        heights = [4.5, 1.75 * rows] if rows else [4.5]
        parts: Any = figure.subfigures(len(heights), 1, height_ratios=heights, squeeze=False)
        above, below = parts[0, 0], parts[1, 0] if rows else None
        panels = above.subplot_mosaic(
            [["place", "start", "modes"], ["msd", "msd", "rose"]],
            per_subplot_kw={"rose": {"projection": "polar"}},
            width_ratios=[1.0, 1.0, 0.9],
        )
        draw_paths(panels["place"], given, found, together=False)
        draw_paths(panels["start"], given, found, together=True)
        draw_counts(panels["modes"], found)
        fit = draw_displacement(panels["msd"], given)
        draw_rose(panels["rose"], given)
        panels["place"].set_title("in place")
        panels["start"].set_title("from one start")
        panels["msd"].set_title(_told(fit, given[0]))
        panels["rose"].set_title("directions of the way", pad=10.0)
        if below is not None:
            grid = below.subplots(
                2 * rows, _ACROSS, squeeze=False, height_ratios=[1.0, 0.55] * rows
            )
            for place in range(rows * _ACROSS):
                row, column = divmod(place, _ACROSS)
                pair = grid[2 * row][column], grid[2 * row + 1][column]
                if place < len(chosen):
                    i = chosen[place]
                    draw_turns(*pair, given[i], found[i], given.ids[i])
                else:
                    for axes in pair:
                        axes.set_axis_off()
            below.supylabel("heading (turns)", fontsize=7)
            time = shown_units(given[0].time_units)
            below.supxlabel(f"time ({time})" if time else "time", fontsize=7)
        drift = shared_drift(given)
        lines = [title or f"{_counted(len(given))}, {given.t.size} records"]
        lines += [str(drift).split(";")[0]] if drift.noticed else []
        untold = not (given.source.length_units and given.source.time_units)
        lines += ["lengths and times in the units of the file, which does not tell them"] * untold
        figure.suptitle("\n".join(lines), x=0.01, ha="left")
    return figure


@checked
def compare_tracks(
    series: Mapping[str, Any], results: Mapping[str, Results] | None = None
) -> Figure:
    """Draw tracks of a model and of data side by side, the same panels for each.

    Parameters
    ----------
    series : mapping of str to tracks
        Names, such as "model" and "data", and what `tracks` takes: one column each.
    results : mapping of str to sequence of Classification, optional
        Of each series; found unless given.

    Returns
    -------
    Figure

    Raises
    ------
    InputError
        If a series has no tracks.

    Notes
    -----
    Each column has its own units: a model's are its radius and its rate, and only forms compare.
    Bring a run into the units of the data with `Scales` first, or look at it through `observe`.
    """
    if not series:
        raise InputError("there is nothing to compare: give names and tracks")
    kinds = {name: as_tracks(given) for name, given in series.items()}
    with paper_figure(PAGE, 7.4, shown=True) as figure:
        columns: Any = figure.subfigures(1, len(kinds), squeeze=False)
        for column, (name, given) in zip(columns[0], kinds.items(), strict=True):
            found = _results(given, (results or {}).get(name))
            panels = column.subplot_mosaic(
                [["start"], ["modes"], ["msd"], ["rose"]],
                per_subplot_kw={"rose": {"projection": "polar"}},
                height_ratios=[1.5, 0.8, 1.2, 1.0],
            )
            draw_paths(panels["start"], given, found, together=True)
            draw_counts(panels["modes"], found)
            fit = draw_displacement(panels["msd"], given)
            draw_rose(panels["rose"], given)
            panels["msd"].set_title(_told(fit, given[0]).replace(", S", "\n S"))
            column.suptitle(f"{name}: {_counted(len(given))}")
    return figure


def as_tracks(given: Any) -> Tracks:
    """Return tracks of what was given, or raise `InputError`."""
    if isinstance(given, Outlines):
        given = given.tracks
    if isinstance(given, (Track, xr.Dataset)):
        given = [given]
    if not isinstance(given, Tracks):
        several = listed("tracks", given, "tracks or runs")
        given = Tracks.of([as_track(one) for one in several])
    found: Tracks = given
    if len(found) == 0:
        raise InputError("there are no tracks to draw")
    return found


def _results(given: Tracks, results: Results | None) -> Results:
    if results is None:
        return [
            classify_track(track.t, track.x, track.y) if len(track) >= FEWEST_RECORDS else None
            for track in given
        ]
    found = listed("results", results, "a list, one of each track")
    if len(found) != len(given):
        raise InputError(f"there are {len(found)} results for {len(given)} tracks")
    wrong = [one for one in found if not (one is None or isinstance(one, Classification))]
    if wrong:
        raise InputError(f"results are what classify_track returns, or None, not {shown(wrong[0])}")
    return found


def _examples(given: Tracks, found: Results, count: int) -> list[int]:
    """Choose tracks to show: of every mode in turn the surest, the longest of those without one."""
    queues = []
    for mode in MODES:
        of_mode = [i for i, result in enumerate(found) if result and result.mode == mode]
        queues.append(
            sorted(of_mode, key=lambda i: -(found[i].confidence if found[i] else 0.0))  # type: ignore[union-attr]
        )
    chosen: list[int] = []
    while len(chosen) < count and any(queues):
        for queue in queues:
            if queue and len(chosen) < count:
                chosen.append(queue.pop(0))
    return sorted(chosen, key=lambda i: MODES.index(found[i].mode))  # type: ignore[union-attr]


def _counted(number: int) -> str:
    return "1 track" if number == 1 else f"{number} tracks"


def _told(fit: PersistentWalk | None, track: Track) -> str:
    if fit is None:
        return "too short for a fit"
    length, time = shown_units(track.length_units), shown_units(track.time_units)
    over = f" {length}/{time}" if length and time else ""
    if track.time_units.startswith("1/"):  # a rate's inverse: length times the rate
        over = f" {length} {time.replace('1/', '', 1)}"
    persistence = f"{fit.time} {time}".rstrip() if fit.time.high < 1e6 * fit.time.value else "long"
    return f"persistence {persistence}, S = {fit.speed}{over}"
