"""How noisy a track is, and its heading after as little smoothing as the noise asks for."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from cellcrawl.observables.noise import RAYLEIGH
from cellcrawl.observables.records import SoundTrack, sound
from cellcrawl.observables.short_arrays import evenly_spaced, median, slopes, unwrapped
from cellcrawl.observables.track import Track

HEADING_ERROR = 0.04
"""Error of the heading, in rad, that smoothing aims at."""
_WIDEST = 0.08  # of the duration: smoothing never goes beyond, or nothing would be left to turn
_ITERATIONS = 6
_NARROWEST = 0.3  # of the sampling interval: narrower smoothing changes nothing
_ROUGH = 1.5  # smoothing that removes more than this many times the noise removes motion


@dataclass(frozen=True, eq=False)
class SmoothTrack:
    """A track on even times after smoothing, and its motion.

    Times are even on a clock that stands still during pauses.

    Attributes
    ----------
    t, x, y, speed, heading : ndarray, shape (record,)
        Times, positions, speed on the move, and direction of motion in rad, unwrapped.
    steps : ndarray, shape (2, record - 1)
        Steps from one record to the next before smoothing.
    step : float
        Time from one record to the next, pauses left out.
    noise : float
        Estimated error of one recorded position along each axis.
    width : float
        Standard deviation of the Gaussian the track was smoothed with, in units of time.
    heading_error : float
        Expected error of the heading at the median speed, in rad; infinite at rest.
    sound : SoundTrack
        The records it was made of, and those left out.
    """

    t: np.ndarray
    x: np.ndarray
    y: np.ndarray
    speed: np.ndarray
    heading: np.ndarray
    steps: np.ndarray
    step: float
    noise: float
    width: float
    heading_error: float
    sound: SoundTrack

    @property
    def unsure(self) -> int:
        """How many records at each end are smoothed over fewer neighbours than the others."""
        return min(round(2.0 * self.width / self.step), self.t.size // 4)


def smooth(track: Track) -> SmoothTrack:
    """Smooth a track as little as its noise asks for.

    The width of the Gaussian is the smallest for which the expected error of the heading at the
    median speed is `HEADING_ERROR`, or less if that would move the positions by more than their
    noise can explain; a track without noise keeps its records as they are. The error of the
    velocity of positions with error ``s`` every ``dt``, smoothed over ``w``, is
    ``sqrt(s**2 dt / (4 sqrt(pi) w**3))`` along each axis.

    Wild records, repeated positions and the scatter of pauses have no heading: they are left out
    first (see `sound`), and the track goes straight from one record that counts to the next.
    """
    counted = sound(track)
    track, clock = counted.track, counted.clock
    first, last = float(clock[0]), float(clock[-1])
    even = evenly_spaced(first, last, clock.size)
    step = float(even[1] - even[0])
    places = np.array([np.interp(even, clock, values) for values in (track.x, track.y)])
    moved = places[:, 1:] - places[:, :-1]
    noise = counted.noise
    gaussian = _Gaussian(places)
    width, smoothed = 0.0, places
    for _ in range(_ITERATIONS if noise > 0.0 else 0):
        wanted = _width_for(noise, step, _pace(smoothed, step), last - first)
        if wanted <= 1.05 * width or wanted < _NARROWEST * step:
            break
        width, smoothed = wanted, gaussian.smoothed(wanted / step)
    while width > _NARROWEST * step and _removed(places, smoothed) > _ROUGH * noise:
        width *= 0.7
        smoothed = gaussian.smoothed(width / step)
    velocity = slopes(smoothed, step)
    speed = np.hypot(velocity[0], velocity[1])
    return SmoothTrack(
        np.interp(even, clock, track.t),
        smoothed[0],
        smoothed[1],
        speed,
        unwrapped(np.arctan2(velocity[1], velocity[0])),
        moved,
        step,
        noise,
        width,
        _heading_error(noise, step, width, median(speed)),
        counted,
    )


class _Gaussian:
    """Gaussian smoothing of rows by Fourier transform; rows go on by reflection at their ends."""

    def __init__(self, rows: np.ndarray) -> None:
        size = rows.shape[1]
        self._line = rows[:, :1] + (rows[:, -1:] - rows[:, :1]) * evenly_spaced(0.0, 1.0, size)
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
    moved = places[:, 1:] - places[:, :-1]
    return median(np.hypot(moved[0], moved[1])) / step


def _width_for(noise: float, step: float, pace: float, duration: float) -> float:
    widest = _WIDEST * duration
    allowed = HEADING_ERROR * pace
    if allowed <= 0.0:
        return widest
    return min(widest, float(np.cbrt((noise / allowed) ** 2 * step / (4.0 * math.sqrt(math.pi)))))


def _removed(places: np.ndarray, smoothed: np.ndarray) -> float:
    """Return by how much smoothing moved the positions, as a deviation along an axis."""
    moved = places - smoothed
    return median(np.hypot(moved[0], moved[1])) / RAYLEIGH


def _heading_error(noise: float, step: float, width: float, pace: float) -> float:
    if noise == 0.0:
        return 0.0
    if pace == 0.0:
        return math.inf
    central = noise / (math.sqrt(2.0) * step)  # of a central difference, without smoothing
    if width > 0.0:
        central = min(central, noise * math.sqrt(step / (4.0 * math.sqrt(math.pi) * width**3)))
    return central / pace
