"""Persistence and speed of a random walk, fitted with the error of positions and of the frames."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from cellcrawl.arguments import checked
from cellcrawl.errors import InputError
from cellcrawl.observables.noise import position_noise
from cellcrawl.observables.records import sound
from cellcrawl.observables.track import Track, as_track
from cellcrawl.validation import real_number

_FEWEST = 20
_QUANTILE = 1.959964  # of a normal distribution, for intervals of 95 percent
_MEMORIES = (0.3, 1.0, 3.0, 10.0, 40.0)  # persistence times to start from, in intervals
_ITERATIONS = 60
_NOTHING = -14.0  # logarithm of an error that is none, in steps
_UNLIKELY = 0.5 * _QUANTILE**2  # loss of log-likelihood at the ends of an interval
_BIG = 1e300


@dataclass(frozen=True)
class Estimate:
    """A number and how well it is known.

    Attributes
    ----------
    value : float
        The most likely value.
    low, high : float
        Ends of the interval of 95 percent.
    """

    value: float
    low: float
    high: float

    def __str__(self) -> str:
        return f"{self.value:.3g} ({self.low:.3g} to {self.high:.3g})"


@dataclass(frozen=True)
class PersistentWalk:
    """A persistent random walk fitted to a track.

    Attributes
    ----------
    time : Estimate
        Persistence time P: the velocity forgets itself as ``exp(-lag/P)``.
    speed : Estimate
        Root mean square speed S.
    localisation_error : Estimate
        Error of a recorded position along one axis, standard deviation; from 0 where the track
        does not show it.
    exposure : float
        Time over which each position was taken as a mean.
    records : int
        Records the fit is made of.
    estimator : str
        Which estimator this is.
    """

    time: Estimate
    speed: Estimate
    localisation_error: Estimate
    exposure: float
    records: int
    estimator: str = "maximum likelihood of a correlated random walk (Johnson et al. 2008)"

    @property
    def diffusion_coefficient(self) -> float:
        """Of the walk at long times, ``S**2 P / 2``."""
        return 0.5 * self.speed.value**2 * self.time.value

    def mean_squared_displacement(self, lags: Any) -> np.ndarray:
        """Return what the fit says of the mean squared displacement: Fürth's formula.

        ``2 S^2 P^2 (lag/P - 1 + exp(-lag/P)) + 4 s^2`` with the localisation error ``s``; for
        positions taken over an exposure the short lags lie a little lower.
        """
        ratio = np.asarray(lags, dtype=float) / self.time.value
        walk = 2.0 * (self.speed.value * self.time.value) ** 2 * (ratio + np.expm1(-ratio))
        total: np.ndarray = walk + 4.0 * self.localisation_error.value**2
        return total


@checked
def persistent_walk(
    run: Any, x: Any = None, y: Any = None, *, exposure: float = 0.0
) -> PersistentWalk:
    """Fit a persistent random walk: persistence time, speed and localisation error, with intervals.

    Parameters
    ----------
    run : Dataset, Track, Tracks or array_like, shape (record,)
        A run, the times of a track, even or not, or several tracks of one walk, which are fitted
        together; 20 records or more of each.
    x, y : array_like, shape (record,), optional
        Positions at these times; left out with a run.
    exposure : float
        Time over which each position was taken as a mean, up to the interval between records; 0
        for snapshots.

    Returns
    -------
    PersistentWalk

    Raises
    ------
    InputError
        For a dataset that is no run, a track that is bad, too short or does not move, or an
        ``exposure`` longer than the shortest interval.

    Notes
    -----
    The model is the Ornstein-Uhlenbeck process for the velocity (Uhlenbeck & Ornstein, Phys. Rev.
    36, 823, 1930; Fürth's formula is its mean squared displacement), seen with an independent
    error at each record. Its likelihood is exact for any times, dropped frames and a finite frame
    time included, by a Kalman filter (Johnson, London, Lea & Durban, Ecology 89, 1208, 2008).
    Speeds and turning angles from frame to frame are biased instead: localisation error adds to
    each step, and the frame time rounds the path (Pedersen et al., Phys. Rev. E 94, 062401, 2016).
    Intervals are those of the curvature of the likelihood in the logarithms of the parameters.

    Of motion that is not this walk, a glide, a circle, a zigzag, the numbers mean little: ask the
    classifier first. The persistence time of a track shorter than about ten of them comes out with
    a wide interval, and too short.
    """
    several = run if isinstance(run, Sequence) and isinstance(next(iter(run), None), Track) else ()
    given = [as_track(track, at_least=_FEWEST) for track in several]
    tracks = [sound(track).clean for track in given or [as_track(run, x, y, at_least=_FEWEST)]]
    steps = np.concatenate([np.diff(track.t) for track in tracks])
    shortest = float(steps.min())
    real_number("exposure", exposure, 0.0, shortest * (1.0 + 1e-9))
    unit, interval = _scales(tracks)
    places = np.concatenate(
        [np.stack([track.x - track.x[0], track.y - track.y[0]]) / unit for track in tracks], axis=1
    )
    sizes = np.array([track.t.size for track in tracks])
    gaps, which = np.unique(np.round(steps / interval, 9), return_inverse=True)
    likelihood = _Likelihood(places, sizes, gaps, which, exposure / interval)
    noise = float(np.median([position_noise(track) for track in tracks])) / unit
    noise = max(min(noise, 0.5), 1e-3)
    starts = [np.log([p, 1.0, e]) for p in _MEMORIES for e in (noise, 0.1 * noise)]
    best = likelihood.maximise(min(starts, key=likelihood))
    time, speed, error = _estimates(likelihood, best)
    return PersistentWalk(
        _scaled(time, interval),
        _scaled(speed, math.sqrt(2.0) * unit / interval),
        _scaled(error, unit),
        float(exposure),
        int(sizes.sum()),
    )


def _scales(tracks: list[Track]) -> tuple[float, float]:
    """Return the root mean square step and the median interval."""
    interval = float(np.median(np.concatenate([np.diff(track.t) for track in tracks])))
    squares = [np.diff(track.x) ** 2 + np.diff(track.y) ** 2 for track in tracks]
    unit = math.sqrt(float(np.mean(np.concatenate(squares))))
    if unit == 0.0:
        raise InputError("this track never moves: there is no walk to fit")
    return unit, interval


def _scaled(estimate: Estimate, scale: float) -> Estimate:
    return Estimate(estimate.value * scale, estimate.low * scale, estimate.high * scale)


class _Likelihood:
    """Minus the logarithm of the likelihood of a walk, against log P, log s and log error."""

    def __init__(
        self,
        places: np.ndarray,
        sizes: np.ndarray,
        gaps: np.ndarray,
        which: np.ndarray,
        exposure: float,
    ) -> None:
        self._places = np.ascontiguousarray(places)
        self._sizes, self._gaps, self._exposure = sizes, gaps, exposure
        self._which = which.astype(np.int64)

    def __call__(self, parameters: np.ndarray) -> float:
        if np.abs(parameters).max() > 25.0:
            return _BIG
        time, speed, error = np.exp(parameters)
        forward, spread = _steps(self._gaps, self._exposure, time, speed)
        from cellcrawl.observables.walk_filter import minus_log_likelihood  # loads Numba

        value = minus_log_likelihood(
            self._places,
            self._sizes,
            self._which,
            forward,
            spread,
            self._exposure,
            speed**2,
            error**2,
        )
        return float(value) if math.isfinite(value) else _BIG

    def maximise(self, start: np.ndarray, free: int = 3) -> np.ndarray:
        """Return the best parameters from a start, by Newton's method with a growing trust.

        ``free``: how many of them, the first, are to be found.
        """
        at, value, damping = start, self(start), 1.0
        slope, bend = self.derivatives(at, 1e-3, free)
        for _ in range(_ITERATIONS):
            values, axes = np.linalg.eigh(bend)
            change = -axes @ ((axes.T @ slope) / (np.abs(values) + damping))
            change *= min(1.0, 2.0 / max(float(np.abs(change).max()), 1e-12))
            ahead = at.copy()
            ahead[:free] += change
            ahead[2] = max(ahead[2], _NOTHING)
            there = self(ahead)
            if there < value:
                gained = value - there
                at, value, damping = ahead, there, 0.2 * damping
                if gained < 1e-6:
                    break
                slope, bend = self.derivatives(at, 1e-3, free)
            else:
                damping = 5.0 * damping + 1e-3
                if damping > 1e9:
                    break
        return at

    def derivatives(
        self, at: np.ndarray, step: float, free: int = 3
    ) -> tuple[np.ndarray, np.ndarray]:
        """Return slope (free,) and curvature (free, free) by central differences."""
        axes = step * np.eye(3)[:free]
        middle = self(at)
        ahead = np.array([self(at + axis) for axis in axes])
        behind = np.array([self(at - axis) for axis in axes])
        slope = (ahead - behind) / (2.0 * step)
        bend = np.diag(ahead - 2.0 * middle + behind)
        for i in range(free):
            for j in range(i):
                both = self(at + axes[i] + axes[j]) + self(at - axes[i] - axes[j])
                bend[i, j] = bend[j, i] = 0.5 * (
                    both + 2.0 * middle - ahead[i] - behind[i] - ahead[j] - behind[j]
                )
        return slope, bend / step**2


def _estimates(likelihood: _Likelihood, at: np.ndarray) -> list[Estimate]:
    """Return intervals from the curvature; that of an error that may be none, from its profile."""
    none = np.array([at[0], at[1], _NOTHING])
    seen = likelihood(likelihood.maximise(none, free=2)) - likelihood(at) > _UNLIKELY
    free = 3 if seen else 2
    _, bend = likelihood.derivatives(at, 1e-2, free)
    values, axes = np.linalg.eigh(bend)
    apart = _QUANTILE * np.sqrt((axes**2) @ (1.0 / np.maximum(values, 1e-3)))
    ends = [
        Estimate(*map(math.exp, (at[i], at[i] - apart[i], at[i] + apart[i]))) for i in range(free)
    ]
    if not seen:
        value = math.exp(at[2]) if at[2] > 0.5 * _NOTHING else 0.0
        ends.append(Estimate(value, 0.0, math.exp(_largest_error(likelihood, at))))
    return ends


def _largest_error(likelihood: _Likelihood, at: np.ndarray) -> float:
    """Return the logarithm of the largest error that is not unlikely, by bisection."""
    least = likelihood(at)
    low, high, best = float(at[2]), 1.0, at
    for _ in range(12):
        middle = 0.5 * (low + high)
        best = likelihood.maximise(np.array([best[0], best[1], middle]), free=2)
        if likelihood(best) - least < _UNLIKELY:
            low = middle
        else:
            high = middle
    return high


def _steps(
    gaps: np.ndarray, exposure: float, time: float, speed: float
) -> tuple[np.ndarray, np.ndarray]:
    """Return how position, velocity and exposed position go on over each gap, (gap, 3, 3).

    Closed, the position runs on; while the shutter is open its integral is gathered as well. Means
    and covariances of both parts by one matrix exponential each (Van Loan, IEEE Trans. Autom.
    Control 23, 395, 1978).
    """
    closed = _part(gaps - exposure, time, speed, gather=0.0)
    if exposure == 0.0:
        return closed
    opened = _part(np.array([exposure]), time, speed, gather=1.0)
    forward = opened[0] @ closed[0]
    spread = opened[0] @ closed[1] @ opened[0].transpose(0, 2, 1) + opened[1]
    return np.ascontiguousarray(forward), np.ascontiguousarray(spread)


def _part(
    durations: np.ndarray, time: float, speed: float, gather: float
) -> tuple[np.ndarray, np.ndarray]:
    rate = np.zeros((3, 3))
    rate[0, 1], rate[1, 1], rate[2, 0] = 1.0, -1.0 / time, gather
    noise = np.zeros((3, 3))
    noise[1, 1] = 2.0 * speed**2 / time
    # Short parts first, doubled as often as needed: the exponential of a long one would overflow.
    longest = float(durations.max())
    doublings = max(0, math.ceil(math.log2(max(longest / time, longest, 1e-12)))) + 3
    short = durations / 2.0**doublings
    block = np.zeros((6, 6))
    block[:3, :3], block[:3, 3:], block[3:, 3:] = -rate, noise, rate.T
    powers = np.broadcast_to(np.eye(6), (short.size, 6, 6)).copy()
    total = powers.copy()
    for k in range(1, 13):
        powers = powers @ block * (short / k)[:, None, None]
        total += powers
    forward = total[:, 3:, 3:].transpose(0, 2, 1)
    spread = forward @ total[:, :3, 3:]
    for _ in range(doublings):
        spread = forward @ spread @ forward.transpose(0, 2, 1) + spread
        forward = forward @ forward
    return np.ascontiguousarray(forward), np.ascontiguousarray(spread)
