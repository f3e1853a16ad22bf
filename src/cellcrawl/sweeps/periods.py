"""The period of a signal over time, if it has one."""

from __future__ import annotations

import numpy as np

_LEAST_SWING = 1e-3  # of the mean: less is rest
_LEAST_LIKENESS = 0.5  # of the signal with itself a period later


def dominant_period(time: np.ndarray, signal: np.ndarray) -> float | None:
    """Return the lag at which a signal is most like itself, or None if it does not repeat.

    Parameters
    ----------
    time, signal : array, shape (records,)
        Equally spaced, but for the last record.

    Returns
    -------
    float or None
        The first high peak of the autocorrelation, refined by a parabola. None when the signal
        rests (swings by less than 1e-3 of its mean), does not repeat twice, or only drifts.
    """
    if time.size < 16:
        return None
    step = float(time[1] - time[0])
    if abs(float(time[-1] - time[-2]) - step) > 1e-6 * step:
        time, signal = time[:-1], signal[:-1]
    around = signal - signal.mean()
    if np.ptp(around) < _LEAST_SWING * abs(float(signal.mean())):
        return None
    likeness = _autocorrelation(around)
    below = np.flatnonzero(likeness < 0.0)
    if below.size == 0:
        return None
    inner = likeness[1:-1]
    peaks = 1 + np.flatnonzero((inner >= likeness[:-2]) & (inner > likeness[2:]))
    peaks = peaks[peaks > below[0]]
    if peaks.size == 0 or likeness[peaks].max() < _LEAST_LIKENESS:
        return None
    first = int(peaks[np.argmax(likeness[peaks] > 0.9 * likeness[peaks].max())])
    before, at, after = likeness[first - 1 : first + 2]
    return float(step * (first + 0.5 * (before - after) / (before - 2.0 * at + after)))


def _autocorrelation(signal: np.ndarray) -> np.ndarray:
    """Correlation of a signal with itself at lags up to half its length, without bias."""
    size = signal.size
    spectrum = np.fft.rfft(signal, 2 * size)
    sums = np.fft.irfft(np.abs(spectrum) ** 2, 2 * size)[: size // 2 + 1]
    squares = np.concatenate([[0.0], np.cumsum(signal**2)])
    lag = np.arange(sums.size)
    scale = np.sqrt(squares[size - lag] * (squares[size] - squares[lag]))
    return np.asarray(sums / np.maximum(scale, 1e-300))
