"""What tells how far an answer can be trusted: how much of the motion the records show."""

from __future__ import annotations

import functools
import math
from typing import Final, NamedTuple

import numpy as np

from cellcrawl.modes.result import Measures
from cellcrawl.observables.short_arrays import mean, row_means
from cellcrawl.observables.smoothing import SmoothTrack

_FASTEST = 0.15  # cycles a record: swings faster than this are hardly seen


class Evidence(NamedTuple):
    """Numbers without units; see `WORDS` for what a low trust in each is called."""

    records: float
    fit: float
    runner_up: float
    memory: float
    memory_score: float
    reversal: float
    rhythm: float
    roughness: float
    heading_error: float
    smoothing: float
    records_per_swing: float
    records_per_turn: float
    disorder: float
    turned: float
    wander: float
    at_rest: float
    wild: float
    left_out: float


WORDS: Final = {
    "records": "it has few records",
    "memory": "its steps hardly remember each other, as those of a random walk",
    "memory_score": "its steps hardly remember each other, as those of a random walk",
    "reversal": "its steps go back and forth, as noise does",
    "rhythm": "it swings within about three records: they are too far apart to tell",
    "roughness": "its steps are as rough as its noise",
    "heading_error": "noise hides its heading",
    "smoothing": "noise hides its heading",
    "records_per_swing": "it has few records from one swing to the next",
    "records_per_turn": "it has few records in a turn",
    "disorder": "its positions scatter nearly without order",
    "turned": "how far it turned would fit another mode too",
    "wander": "how its heading wanders would fit another mode too",
    "at_rest": "it rests for much of the time",
    "wild": "a record far off its path was left out",
    "left_out": "it changes its way after the beginning",
}
"""What speaks against an answer, by the number that does."""


def gather(
    track: SmoothTrack, found: Measures, still: Measures, fits: dict[str, float]
) -> Evidence:
    """Return what tells how far the answer of the rule can be trusted."""
    size = track.t.size
    steps = track.steps
    power = float(np.sum(steps**2))
    lags = [_correlation(steps, lag, power) for lag in (1, 2, 3)]
    memory = 0.5 * (lags[1] + lags[2])
    best, second = sorted(fits.values(), reverse=True)[:2] if fits else (0.0, 0.0)
    swings = found.swings if math.isfinite(found.swing) else 0
    turned = abs(found.turned) if math.isfinite(found.turned) else 0.0
    wander = found.wander if math.isfinite(found.wander) else 0.0
    pace = math.sqrt(power / max(steps.shape[1], 1))
    used = float(np.searchsorted(track.t, found.start)) / size
    return Evidence(
        math.log2(size),
        best,
        second,
        memory,
        memory * math.sqrt(size),
        lags[0],
        _rhythm(steps, power),
        min(track.noise / pace, 1.0) if pace > 0.0 else 1.0,
        min(track.heading_error, 0.6),
        min(track.width / track.step, 20.0),
        math.log2(size * (1.0 - used) / (swings + 1.0)),
        math.log2(size / (turned / (2.0 * math.pi) + 0.1)),
        still.disorder,
        turned,
        wander,
        track.sound.at_rest,
        float(len(track.sound.wild) > 0),
        used,
    )


def _correlation(steps: np.ndarray, lag: int, power: float) -> float:
    """Return the correlation of steps with those ``lag`` later: 1 straight ahead, 0 at random."""
    size = steps.shape[1]
    if size <= lag or power == 0.0:
        return 0.0
    product = float(np.sum(steps[:, lag:] * steps[:, :-lag]))
    return float(product / power * size / (size - lag))


@functools.lru_cache(maxsize=64)
def _window(size: int) -> np.ndarray:
    return np.hanning(size)


def _rhythm(steps: np.ndarray, power: float) -> float:
    """Return how far one fast frequency stands out among the fast ones.

    The largest over the mean of the periodogram beyond `_FASTEST` (Fisher's test), less the
    logarithm of their number, which it is near for noise; 0 without fast motion to speak of.
    """
    size = steps.shape[1]
    around = steps - row_means(steps)
    amplitudes = np.abs(np.fft.rfft(around * _window(size), axis=1))
    fast = np.add.reduce(amplitudes * amplitudes)[int(_FASTEST * size) + 1 :]
    usual = mean(fast) if fast.size else 0.0
    if fast.size < 3 or usual * fast.size <= 1e-3 * power * size:
        return 0.0
    stands_out = float(fast.max()) / usual - math.log(fast.size)
    return float(min(max(stands_out, 0.0), 20.0))
