"""Turns of a crawling cell: when they are, which way, and what its two sides do meanwhile."""

from __future__ import annotations

from typing import Final, NamedTuple

import numpy as np
import xarray as xr

from cellcrawl.observables import heading, turning_rate

_SHARP: Final = 0.5  # of the fastest turning: what counts as a turn
_BEFORE: Final = 1.0  # time before the fastest turning in which a turn is prepared


class Turn(NamedTuple):
    """One turn of a cell."""

    time: float
    """When it turns fastest."""
    way: int
    """1 to the left, -1 to the right."""
    prepared: float
    """Bound fraction of the left less that of the right flank, mean over the time before."""
    tension_rises: bool
    """Whether the tension rises at the fastest turning."""
    tension_peak: float
    """Time from the fastest turning to the next peak of the tension."""


def side_difference(dataset: xr.Dataset) -> np.ndarray:
    """Return the bound fraction of the left flank less that of the right, shape (time,).

    Left and right of the heading, by the polar angle about the centroid, the quarters around
    straight ahead and straight behind left out. `left_right_asymmetry` takes whole halves, in which
    front and rear can outweigh the flanks.
    """
    arms = [
        dataset[axis].values - dataset[f"centroid_{axis}"].values[:, None] for axis in ("x", "y")
    ]
    angle = np.arctan2(arms[1], arms[0]) - heading(dataset).values[:, None]
    aside = np.sin(angle)
    n = dataset["bound_fraction"].values
    left, right = (
        np.nanmean(np.where(sign * aside > np.sqrt(0.5), n, np.nan), axis=1) for sign in (1, -1)
    )
    return np.asarray(left - right)


def turns(dataset: xr.Dataset) -> list[Turn]:
    """Return the turns of a run, in order; give it at least twenty records a time unit."""
    time = dataset["time"].values
    rate = turning_rate(dataset).values
    tension = dataset["tension"].values
    sides = side_difference(dataset)
    step = float(time[1] - time[0])
    ahead, before = round(6.0 / step), round(_BEFORE / step)
    sharp = np.abs(rate) > _SHARP * np.abs(rate).max()
    found: list[Turn] = []
    for first, last in _stretches(sharp):
        peak = first + int(np.abs(rate[first:last]).argmax())
        if peak < before or peak + ahead >= time.size:
            continue
        after = tension[peak : peak + ahead]
        top = int(np.argmax(after[1:-1] > np.maximum(after[:-2], after[2:]))) + 1
        found.append(
            Turn(
                float(time[peak]),
                int(np.sign(rate[peak])),
                float(sides[peak - before : peak].mean()),
                bool(tension[peak + 1] > tension[peak - 1]),
                top * step,
            )
        )
    return found


def period(dataset: xr.Dataset, values: np.ndarray) -> float:
    """Return the mean time between upward crossings of the mean; NaN with fewer than two."""
    above = values > values.mean()
    ups = np.flatnonzero(~above[:-1] & above[1:])
    if ups.size < 2:
        return float("nan")
    time = dataset["time"].values
    return float((time[ups[-1]] - time[ups[0]]) / (ups.size - 1))


def _stretches(flags: np.ndarray) -> list[tuple[int, int]]:
    """Return first and one past last index of each stretch of set flags."""
    edges = np.flatnonzero(np.diff(np.concatenate([[False], flags, [False]]).astype(int)))
    return [(int(a), int(b)) for a, b in zip(edges[::2], edges[1::2], strict=True)]
