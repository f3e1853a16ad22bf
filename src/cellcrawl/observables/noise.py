"""How noisy the positions of a track are."""

from __future__ import annotations

import numpy as np

from cellcrawl.observables.short_arrays import median
from cellcrawl.observables.track import Track

RAYLEIGH = 1.17741
"""Median distance in the plane over the standard deviation along an axis."""
_OWN = np.arange(4)


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
    scale = np.sqrt(1.0 + np.add.reduce(weights * weights))
    apart = np.hypot(_residual(track.x, weights), _residual(track.y, weights)) / scale
    return median(apart) / RAYLEIGH


def _neighbour_weights(times: np.ndarray) -> np.ndarray:
    """Return Lagrange weights (4, record - 4) of neighbours -2, -1, 1, 2 for inner records."""
    middle = times[2:-2]
    near = _neighbours(times)
    apart = middle - near
    between = near[:, None] - near[None, :]
    between[_OWN, _OWN] = 1.0
    ratios = apart[None, :] / between
    ratios[_OWN, _OWN] = 1.0
    weights: np.ndarray = np.multiply.reduce(ratios, axis=1)
    return weights


def _neighbours(values: np.ndarray) -> np.ndarray:
    return np.array([values[:-4], values[1:-3], values[3:-1], values[4:]])


def _residual(values: np.ndarray, weights: np.ndarray) -> np.ndarray:
    residual: np.ndarray = values[2:-2] - np.add.reduce(weights * _neighbours(values))
    return residual
