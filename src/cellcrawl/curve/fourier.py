"""Trigonometric interpolation of periodic samples: derivative, integral, values anywhere."""

from __future__ import annotations

import math

import numpy as np


def wavenumbers(count: int) -> np.ndarray:
    """Integer wavenumbers of ``np.fft.fft`` for ``count`` samples."""
    return np.fft.fftfreq(count, 1.0 / count)


def derivative(samples: np.ndarray, period: float) -> np.ndarray:
    """Derivative of periodic samples with respect to a coordinate of the given period."""
    k = wavenumbers(samples.size)
    if samples.size % 2 == 0:
        k[samples.size // 2] = 0.0  # the sawtooth has no derivative on its own nodes
    result = np.fft.ifft(np.fft.fft(samples) * (2j * math.pi / period) * k)
    return np.asarray(result if np.iscomplexobj(samples) else result.real)


def integral(samples: np.ndarray, period: float) -> np.ndarray:
    """Running integral from sample 0 of periodic samples whose mean is zero."""
    k = wavenumbers(samples.size)
    spectrum = np.fft.fft(samples)
    spectrum[0] = 0.0
    if samples.size % 2 == 0:
        spectrum[samples.size // 2] = 0.0
    spectrum[1:] /= (2j * math.pi / period) * k[1:]
    result = np.fft.ifft(spectrum)
    result = result - result[0]
    return np.asarray(result if np.iscomplexobj(samples) else result.real)


def resample(samples: np.ndarray, count: int) -> np.ndarray:
    """Values of the trigonometric interpolant of real samples at ``count`` equal steps."""
    spectrum = np.fft.rfft(samples)
    kept = min(samples.size, count) // 2 + 1
    padded = np.zeros(count // 2 + 1, complex)
    padded[:kept] = spectrum[:kept]
    if min(samples.size, count) % 2 == 0 and samples.size != count:
        padded[kept - 1] *= 0.5 if count > samples.size else 2.0
    values: np.ndarray = np.fft.irfft(padded, count) * (count / samples.size)
    return values


class TrigonometricSeries:
    """The trigonometric interpolant of periodic samples, to be evaluated anywhere.

    Modes of an amplitude up to ``floor`` are dropped: where samples resolve the function well, most
    of its modes are rounding.
    """

    def __init__(self, samples: np.ndarray, floor: float = 0.0) -> None:
        amplitudes = np.fft.fft(samples) / samples.size
        kept = np.abs(amplitudes) > floor
        self._k = wavenumbers(samples.size)[kept]
        self._amplitudes = amplitudes[kept]

    def __call__(self, angle: np.ndarray, order: int = 0) -> np.ndarray:
        """Complex values of the derivative of the given order at ``angle`` (period 2 pi)."""
        weights = self._amplitudes * (1j * self._k) ** order
        result = np.empty(angle.size, complex)
        for start in range(0, angle.size, 256):
            part = slice(start, start + 256)
            result[part] = np.exp(1j * np.outer(angle[part], self._k)) @ weights
        return result
