"""How noisy a track is, and its heading after as little smoothing as the noise asks for."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from cellcrawl.observables.track import Track

HEADING_ERROR = 0.04
"""Error of the heading, in rad, that smoothing aims at."""
_WIDEST = 0.08  # of the duration: smoothing never goes beyond, or nothing would be left to turn
_NORMAL = 1.4826  # standard deviation over median absolute deviation of a normal distribution


@dataclass(frozen=True, eq=False)
class SmoothTrack:
    """A track on even times after smoothing, and its motion.

    Attributes
    ----------
    t, x, y, speed, heading : ndarray, shape (record,)
        Even times, positions, speed, and direction of motion in rad, unwrapped.
    noise : float
        Estimated error of one recorded position along each axis.
    width : float
        Standard deviation of the Gaussian the track was smoothed with, in units of time.
    heading_error : float
        Expected error of the heading at the median speed, in rad; infinite at rest.
    """

    t: np.ndarray
    x: np.ndarray
    y: np.ndarray
    speed: np.ndarray
    heading: np.ndarray
    noise: float
    width: float
    heading_error: float


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
    residuals = [_residual(values, weights) / scale for values in (track.x, track.y)]
    return float(_NORMAL * np.median(np.abs(np.concatenate(residuals))))


def smooth(track: Track) -> SmoothTrack:
    """Smooth a track as little as its noise asks for.

    The width of the Gaussian is the smallest for which the expected error of the heading at the
    median speed is `HEADING_ERROR`; a track without noise keeps its records as they are. The error
    of the velocity of positions with error ``s`` every ``dt``, smoothed over ``w``, is
    ``sqrt(s**2 dt / (4 sqrt(pi) w**3))`` along each axis.
    """
    even = np.linspace(track.t[0], track.t[-1], track.t.size)
    step = float(even[1] - even[0])
    places = np.stack([np.interp(even, track.t, values) for values in (track.x, track.y)])
    noise = position_noise(track)
    width = 0.0
    smoothed = places
    for _ in range(6):
        velocity = np.gradient(smoothed, step, axis=1)
        pace = float(np.median(np.hypot(*velocity)))
        wanted = _width_for(noise, step, pace, track.duration)
        if wanted <= 1.05 * width or wanted < 0.3 * step:
            break
        width = wanted
        smoothed = _gaussian(places, width / step)
    velocity = np.gradient(smoothed, step, axis=1)
    speed = np.hypot(*velocity)
    return SmoothTrack(
        even,
        smoothed[0],
        smoothed[1],
        speed,
        np.unwrap(np.arctan2(velocity[1], velocity[0])),
        noise,
        width,
        _heading_error(noise, step, width, float(np.median(speed))),
    )


def _width_for(noise: float, step: float, pace: float, duration: float) -> float:
    if noise == 0.0:
        return 0.0
    widest = _WIDEST * duration
    allowed = HEADING_ERROR * pace
    if allowed <= 0.0:
        return widest
    return min(widest, float(np.cbrt((noise / allowed) ** 2 * step / (4.0 * math.sqrt(math.pi)))))


def _heading_error(noise: float, step: float, width: float, pace: float) -> float:
    if noise == 0.0:
        return 0.0
    if pace == 0.0:
        return math.inf
    central = noise / (math.sqrt(2.0) * step)  # of a central difference, without smoothing
    if width > 0.0:
        central = min(central, noise * math.sqrt(step / (4.0 * math.sqrt(math.pi) * width**3)))
    return central / pace


def _gaussian(places: np.ndarray, width: float) -> np.ndarray:
    """Smooth rows over ``width`` samples; the ends go on by reflection through the end points."""
    reach = min(max(1, math.ceil(4.0 * width)), places.shape[1] - 1)
    offsets = np.arange(-reach, reach + 1)
    kernel = np.exp(-0.5 * (offsets / width) ** 2)
    kernel /= kernel.sum()
    before = 2.0 * places[:, :1] - places[:, reach:0:-1]
    after = 2.0 * places[:, -1:] - places[:, -2 : -2 - reach : -1]
    padded = np.concatenate([before, places, after], axis=1)
    return np.stack([np.convolve(row, kernel, mode="valid") for row in padded])


def _neighbour_weights(times: np.ndarray) -> np.ndarray:
    """Return Lagrange weights (4, record - 4) of neighbours -2, -1, 1, 2 for inner records."""
    middle = times[2:-2]
    near = np.stack([times[:-4], times[1:-3], times[3:-1], times[4:]])
    weights = np.ones_like(near)
    for i in range(4):
        for j in range(4):
            if i != j:
                weights[i] *= (middle - near[j]) / (near[i] - near[j])
    return weights


def _residual(values: np.ndarray, weights: np.ndarray) -> np.ndarray:
    near = np.stack([values[:-4], values[1:-3], values[3:-1], values[4:]])
    residual: np.ndarray = values[2:-2] - np.sum(weights * near, axis=0)
    return residual
