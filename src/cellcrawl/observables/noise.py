"""How noisy the positions of a track are."""

from __future__ import annotations

import numpy as np

from cellcrawl.observables.track import Track

RAYLEIGH = 1.17741
"""Median distance in the plane over the standard deviation along an axis."""


def median(values: np.ndarray) -> float:
    """Return the median, as `np.median` does but in a tenth of its time for short arrays."""
    ordered = np.sort(values)
    half = ordered.size // 2
    return float(ordered[half] if ordered.size % 2 else 0.5 * (ordered[half - 1] + ordered[half]))


def position_noise(track: Track) -> float:
    """Return the error of a recorded position, standard deviation along one axis.

    From how far each record lies from the cubic through its four neighbours: exact for any
    smooth motion recorded often enough, at even or uneven times. The median is taken, so that
    sharp turns and single wild records do not count.

    Notes
    -----
    Motion that is rough at the sampling interval itself, such as Brownian motion, looks like noise.
    """
    if track.t.size < 7:
        return 0.0
    weights = _neighbour_weights(track.t)
    scale = np.sqrt(1.0 + np.sum(weights**2, axis=0))
    apart = np.hypot(_residual(track.x, weights), _residual(track.y, weights)) / scale
    return median(apart) / RAYLEIGH


def _neighbour_weights(times: np.ndarray) -> np.ndarray:
    """Return Lagrange weights (4, record - 4) of neighbours -2, -1, 1, 2 for inner records."""
    middle = times[2:-2]
    near = np.stack([times[:-4], times[1:-3], times[3:-1], times[4:]])
    apart = middle - near
    between = near[:, None] - near[None, :]
    ratios = apart[None, :] / np.where(between == 0.0, 1.0, between)
    ratios[np.arange(4), np.arange(4)] = 1.0
    weights: np.ndarray = ratios.prod(axis=1)
    return weights


def _residual(values: np.ndarray, weights: np.ndarray) -> np.ndarray:
    near = np.stack([values[:-4], values[1:-3], values[3:-1], values[4:]])
    residual: np.ndarray = values[2:-2] - np.sum(weights * near, axis=0)
    return residual
