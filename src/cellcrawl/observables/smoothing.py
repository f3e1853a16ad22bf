"""How noisy a track is, and its heading after as little smoothing as the noise asks for."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from cellcrawl.observables.track import Track

HEADING_ERROR = 0.04
"""Error of the heading, in rad, that smoothing aims at."""
_WIDEST = 0.08  # of the duration: smoothing never goes beyond, or nothing would be left to turn
_ITERATIONS = 6
_NARROWEST = 0.3  # of the sampling interval: narrower smoothing changes nothing
_ROUGH = 1.5  # smoothing that removes more than this many times the noise removes motion
_RAYLEIGH = 1.17741  # median distance in the plane over the standard deviation along an axis


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

    @property
    def unsure(self) -> int:
        """How many records at each end are smoothed over fewer neighbours than the others."""
        return min(round(2.0 * self.width / float(self.t[1] - self.t[0])), self.t.size // 4)


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
    return float(np.median(apart)) / _RAYLEIGH


def smooth(track: Track) -> SmoothTrack:
    """Smooth a track as little as its noise asks for.

    The width of the Gaussian is the smallest for which the expected error of the heading at the
    median speed is `HEADING_ERROR`, or less if that would move the positions by more than their
    noise can explain; a track without noise keeps its records as they are. The error of the
    velocity of positions with error ``s`` every ``dt``, smoothed over ``w``, is
    ``sqrt(s**2 dt / (4 sqrt(pi) w**3))`` along each axis.
    """
    even = np.linspace(track.t[0], track.t[-1], track.t.size)
    step = float(even[1] - even[0])
    places = np.stack([np.interp(even, track.t, values) for values in (track.x, track.y)])
    noise = position_noise(track)
    gaussian = _Gaussian(places)
    width, smoothed = 0.0, places
    for _ in range(_ITERATIONS):
        wanted = _width_for(noise, step, _pace(smoothed, step), track.duration)
        if wanted <= 1.05 * width or wanted < _NARROWEST * step:
            break
        width, smoothed = wanted, gaussian.smoothed(wanted / step)
    while width > _NARROWEST * step and _removed(places, smoothed) > _ROUGH * noise:
        width *= 0.7
        smoothed = gaussian.smoothed(width / step)
    velocity = np.gradient(smoothed, step, axis=1, edge_order=2)
    speed = np.hypot(velocity[0], velocity[1])
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


class _Gaussian:
    """Gaussian smoothing of rows by Fourier transform; rows go on by reflection at their ends."""

    def __init__(self, rows: np.ndarray) -> None:
        size = rows.shape[1]
        self._line = rows[:, :1] + (rows[:, -1:] - rows[:, :1]) * np.linspace(0.0, 1.0, size)
        inside = rows - self._line
        odd = np.concatenate([inside[:, :-1], -inside[:, :0:-1]], axis=1)
        self._spectrum = np.fft.rfft(odd, axis=1)
        self._frequency = np.pi / (size - 1) * np.arange(self._spectrum.shape[1])

    def smoothed(self, width: float) -> np.ndarray:
        """Return the rows smoothed over ``width`` samples."""
        size = self._line.shape[1]
        filtered = self._spectrum * np.exp(-0.5 * (width * self._frequency) ** 2)
        smoothed: np.ndarray = self._line + np.fft.irfft(filtered, 2 * (size - 1), axis=1)[:, :size]
        return smoothed


def _pace(places: np.ndarray, step: float) -> float:
    moved = np.diff(places, axis=1)
    return float(np.median(np.hypot(moved[0], moved[1]))) / step


def _width_for(noise: float, step: float, pace: float, duration: float) -> float:
    if noise == 0.0:
        return 0.0
    widest = _WIDEST * duration
    allowed = HEADING_ERROR * pace
    if allowed <= 0.0:
        return widest
    return min(widest, float(np.cbrt((noise / allowed) ** 2 * step / (4.0 * math.sqrt(math.pi)))))


def _removed(places: np.ndarray, smoothed: np.ndarray) -> float:
    """Return by how much smoothing moved the positions, as a deviation along an axis."""
    moved = places - smoothed
    return float(np.median(np.hypot(moved[0], moved[1]))) / _RAYLEIGH


def _heading_error(noise: float, step: float, width: float, pace: float) -> float:
    if noise == 0.0:
        return 0.0
    if pace == 0.0:
        return math.inf
    central = noise / (math.sqrt(2.0) * step)  # of a central difference, without smoothing
    if width > 0.0:
        central = min(central, noise * math.sqrt(step / (4.0 * math.sqrt(math.pi) * width**3)))
    return central / pace


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
