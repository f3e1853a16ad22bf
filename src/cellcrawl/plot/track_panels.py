"""Panels about tracks: their paths, modes, headings and displacements; parts of the sheets."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.font_manager import FontProperties
from matplotlib.ticker import FuncFormatter, LogLocator, MaxNLocator, NullFormatter
from mpl_toolkits.axes_grid1.anchored_artists import AnchoredSizeBar  # type: ignore[import-untyped]

from cellcrawl.errors import InputError
from cellcrawl.microscopy.track import Track
from cellcrawl.modes import Classification
from cellcrawl.observables.displacement import mean_squared_displacement
from cellcrawl.observables.random_walk import PersistentWalk, persistent_walk
from cellcrawl.observables.smoothing import smooth
from cellcrawl.observables.turns import turning_events
from cellcrawl.plot.edge import round_length
from cellcrawl.plot.mode_symbols import EDGE, MODE_SYMBOLS
from cellcrawl.plot.style import INK, RIM, TRACK, on

LEFT, RIGHT = "#d1495b", "#1f77b4"
"""Colours of turns, to the side seen on the screen."""
UNNAMED = "#cccccc"
_MOST_DRAWN = 400
_SECTORS = 24
_FEWEST_FITTED = 20


def on_screen(track: Track) -> Track:
    """Return a track with y upwards, as it is seen on the screen."""
    return replace(track, y=-track.y, y_down=False) if track.y_down else track


def drawn(tracks: Sequence[Track]) -> list[int]:
    """Return which tracks are drawn where there are too many: evenly spread."""
    if len(tracks) <= _MOST_DRAWN:
        return list(range(len(tracks)))
    chosen: list[int] = np.linspace(0, len(tracks) - 1, _MOST_DRAWN).round().astype(int).tolist()
    return chosen


def colour_of(result: Classification | None) -> str:
    """Return the colour of a track by its mode."""
    return MODE_SYMBOLS[result.mode].colour if result else UNNAMED


def draw_paths(
    ax: Axes,
    tracks: Sequence[Track],
    results: Sequence[Classification | None],
    *,
    together: bool,
) -> None:
    """Draw paths in the colours of their modes: in place, or all from one start.

    A dot marks the end of each.
    """
    lines, colours = [], []
    for i in drawn(tracks):
        track = on_screen(tracks[i])
        line = np.column_stack([track.x, track.y])
        lines.append(line - line[0] if together else line)
        colours.append(colour_of(results[i]))
    ax.add_collection(LineCollection(lines, colors=colours, linewidths=0.7, alpha=0.85))
    ends = np.array([line[-1] for line in lines])
    ax.scatter(ends[:, 0], ends[:, 1], s=3.0, c=colours, linewidths=0.0, zorder=3)
    points = np.concatenate(lines)
    low, high = points.min(axis=0), points.max(axis=0)
    span = max(float((high - low).max()), 1e-12)
    middle = 0.5 * (low + high) if not together else np.zeros(2)
    half = 0.53 * span if not together else 1.06 * float(np.abs(points).max() or 1.0)
    ax.set(xlim=(middle[0] - half, middle[0] + half), ylim=(middle[1] - half, middle[1] + half))
    ax.set_aspect("equal")
    ax.set_axis_off()
    if together:
        ax.axhline(0.0, color=RIM, linewidth=0.4, zorder=0)
        ax.axvline(0.0, color=RIM, linewidth=0.4, zorder=0)
    draw_scale_bar(ax, half, tracks[0].length_units)


def draw_scale_bar(ax: Axes, half: float, units: str, *, small: bool = False) -> None:
    """Draw a bar of a round length, at most half the half width of the panel."""
    size = round_length(0.5 * half)
    ax.add_artist(
        AnchoredSizeBar(
            ax.transData,
            size,
            f"{size:g} {shown_units(units)}".rstrip(),
            "lower left",
            pad=0.1,
            borderpad=0.1,
            sep=2,
            frameon=False,
            color=on(ax, INK),
            fontproperties=FontProperties(size=5.5 if small else 7.0),
        )
    )


def shown_units(units: str) -> str:
    """Return a unit as it is printed."""
    return {"um": "µm", "micron": "µm", "R_0": "$R_0$", "1/k_off0": r"$1/k_\mathrm{off}^0$"}.get(
        units, units
    )


def draw_counts(ax: Axes, results: Sequence[Classification | None]) -> None:
    """Draw how many tracks show each mode, the sure part of the bar full."""
    modes = [mode for mode in MODE_SYMBOLS if any(r and r.mode == mode for r in results)]
    rows: list[tuple[str, str, float, float]] = []
    for mode in modes:
        sure = [r.confidence for r in results if r and r.mode == mode]
        rows.append((mode, MODE_SYMBOLS[mode].colour, len(sure), float(np.mean(sure))))
    unnamed = sum(r is None for r in results)
    if unnamed:
        rows.append(("not named", UNNAMED, unnamed, 1.0))
    for place, (_, colour, count, confidence) in enumerate(rows):
        ax.barh(place, count, color=colour, alpha=0.35, height=0.7)
        ax.barh(place, count * confidence, color=colour, height=0.7, edgecolor=EDGE, linewidth=0.3)
        ax.text(count, place, f" {count:.0f}", va="center", ha="left")
    ax.set_yticks(range(len(rows)), [row[0] for row in rows])
    ax.set_ylim(len(rows) - 0.4, -0.6)
    ax.set_xlim(0.0, 1.2 * max(row[2] for row in rows))
    ax.xaxis.set_major_locator(MaxNLocator(4, integer=True))
    ax.set_xlabel("tracks (full part: mean confidence)")
    ax.spines[["top", "right"]].set_visible(False)


def draw_rose(ax: Any, tracks: Sequence[Track]) -> None:
    """Draw how much of the way goes in each direction, each track with the same weight."""
    edges = np.linspace(-math.pi, math.pi, _SECTORS + 1)
    total = np.zeros(_SECTORS)
    for i in drawn(tracks):
        track = on_screen(tracks[i])
        dx, dy = np.diff(track.x), np.diff(track.y)
        far = np.hypot(dx, dy)
        if far.sum() > 0.0:
            total += np.histogram(np.arctan2(dy, dx), edges, weights=far / far.sum())[0]
    part = total / max(total.sum(), 1e-300)
    middles = 0.5 * (edges[1:] + edges[:-1])
    # The area of a sector, not its radius, is the part of the way.
    ax.bar(middles, np.sqrt(part), 2.0 * math.pi / _SECTORS, color=TRACK, alpha=0.75, linewidth=0)
    ax.grid(visible=False)
    ax.set_yticks([])
    ax.set_xticks(np.radians([0, 90, 180, 270]), ["0°", "90°", "180°", "270°"])
    ax.tick_params(pad=-2)
    ax.spines["polar"].set_linewidth(0.4)


def draw_displacement(ax: Axes, tracks: Sequence[Track]) -> PersistentWalk | None:
    """Draw the mean squared displacement, of each and of all, with the walk fitted to them."""
    curves = []
    for i in drawn(tracks):
        if len(tracks[i]) < 4:
            continue
        curve = mean_squared_displacement(tracks[i])
        good = curve.values > 0.0
        curves.append((curve["lag"].values, curve.values, curve["windows"].values))
        ax.plot(curve["lag"].values[good], curve.values[good], color=RIM, linewidth=0.4, alpha=0.4)
    if not curves:
        return None
    lags, means = _ensemble(curves)
    ax.plot(lags, means, "o", color=on(ax, INK), markersize=2.2, label="mean of all")
    fit = fitted_walk(tracks)
    if fit is not None:
        along = np.geomspace(lags[0], lags[-1], 100)
        ax.plot(along, fit.mean_squared_displacement(along), color=TRACK, label="fitted walk")
    ax.set(xscale="log", yscale="log")
    for axis in (ax.xaxis, ax.yaxis):
        low, high = axis.get_view_interval()
        axis.set_major_locator(LogLocator(subs=(1.0,) if high > 50.0 * low else (1.0, 2.0, 5.0)))
        axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
        axis.set_minor_formatter(NullFormatter())
    length, time = (shown_units(u) for u in (tracks[0].length_units, tracks[0].time_units))
    ax.set_xlabel(f"lag ({time})" if time else "lag")
    ax.set_ylabel("mean squared displacement" + (f" ({length}²)" if length else ""))
    ax.legend(frameon=False, loc="upper left")
    return fit


def fitted_walk(tracks: Sequence[Track]) -> PersistentWalk | None:
    """Fit one persistent walk to those of the drawn tracks that are long enough."""
    chosen = [tracks[i] for i in drawn(tracks) if len(tracks[i]) >= _FEWEST_FITTED]
    try:
        return persistent_walk(chosen) if chosen else None
    except InputError:
        return None


def _ensemble(
    curves: Sequence[tuple[np.ndarray, np.ndarray, np.ndarray]],
) -> tuple[np.ndarray, np.ndarray]:
    """Average curves over pairs of records, in bins of the usual shortest lag."""
    step = float(np.median([lags[0] for lags, _, _ in curves]))
    lags, values, pairs = (np.concatenate([curve[k] for curve in curves]) for k in range(3))
    place = np.maximum(np.round(lags / step).astype(int), 1)
    weight = np.bincount(place, pairs)
    held = weight > 0
    mean_lag = np.bincount(place, pairs * lags)[held] / weight[held]
    return mean_lag, np.bincount(place, pairs * values)[held] / weight[held]


def draw_turns(
    path: Axes, angle: Axes, track: Track, result: Classification | None, name: str
) -> None:
    """Draw one track and its heading over time, turns to the left red and to the right blue.

    A dot marks the end.
    """
    seen = on_screen(track)
    path.plot(seen.x, seen.y, color=UNNAMED, linewidth=0.6)
    path.plot(seen.x[-1], seen.y[-1], "o", color=on(path, INK), markersize=2.0)  # the end
    path.set_aspect("equal", adjustable="datalim")
    path.margins(0.12)
    path.set_axis_off()
    half = 0.5 * float(max(np.ptp(seen.x), np.ptp(seen.y)))
    if half > 0.0:
        draw_scale_bar(path, half, track.length_units, small=True)
    mode = f"{result.mode} {result.confidence:.2f}" if result else "not named"
    path.set_title(f"{name}  {mode}".strip(), color=on(path, INK))
    if len(seen) < 8 or (result is not None and result.mode == "stationary"):
        angle.set_axis_off()
        return
    smoothed = smooth(seen)
    path.plot(smoothed.x, smoothed.y, color=RIM, linewidth=0.9)
    heading = (smoothed.heading - smoothed.heading[0]) / (2.0 * math.pi)
    angle.plot(smoothed.t, heading, color=RIM, linewidth=0.8)
    turns = turning_events(seen)
    for start, end, side in zip(turns["start"], turns["end"], turns["sign"], strict=True):
        part = (smoothed.t >= float(start)) & (smoothed.t <= float(end))
        colour = LEFT if int(side) > 0 else RIGHT
        path.plot(smoothed.x[part], smoothed.y[part], color=colour, linewidth=1.1)
        angle.plot(smoothed.t[part], heading[part], color=colour, linewidth=1.1)
    low, high = angle.get_ylim()
    if high - low < 0.5:
        angle.set_ylim(0.5 * (low + high) - 0.25, 0.5 * (low + high) + 0.25)
    angle.set_xlim(smoothed.t[0], smoothed.t[-1])
    angle.tick_params(labelsize=5.5)
    angle.locator_params(nbins=4)
