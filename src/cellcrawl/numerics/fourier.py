"""Trigonometric interpolation of periodic samples: derivative, integral, values anywhere."""

from __future__ import annotations

import math

import numpy as np

from cellcrawl.numerics.kernels import kernel

_FINER = 8  # grid refinement before local interpolation
TAPS = 12
BEFORE = 5  # samples before the one at or left of a place


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


def area(x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """Area within closed outlines from their points alone, positive if counter-clockwise.

    Shapes (..., points); the last point is joined to the first. It is ``pi sum k |z_k|^2`` over the
    Fourier coefficients of ``x + i y``: to rounding once equally spaced points resolve the outline,
    and with no formula in common with the solvers, which measure tangent angles or splines.
    """
    points = x.shape[-1]
    k = wavenumbers(points)
    if points % 2 == 0:
        k[points // 2] = 0.0  # the sawtooth has no sense of turning
    coefficients = np.fft.fft(x + 1j * y) / points
    return np.asarray(math.pi * np.sum(k * np.abs(coefficients) ** 2, axis=-1))


def resample(samples: np.ndarray, count: int, ahead: float = 0.0) -> np.ndarray:
    """Values of the trigonometric interpolant of real samples at ``count`` equal steps.

    Along the last axis, of period 2 pi; the first value is ``ahead`` of the first sample.
    """
    size = samples.shape[-1]
    spectrum = np.fft.rfft(samples)
    kept = min(size, count) // 2 + 1
    padded = np.zeros((*samples.shape[:-1], count // 2 + 1), complex)
    padded[..., :kept] = spectrum[..., :kept]
    if min(size, count) % 2 == 0 and size != count:
        padded[..., kept - 1] *= 0.5 if count > size else 2.0
    if ahead != 0.0:
        padded *= np.exp(1j * ahead * np.arange(count // 2 + 1))
    values: np.ndarray = np.fft.irfft(padded, count) * (count / size)
    return values


class TrigonometricSeries:
    """The trigonometric interpolant of well-resolved periodic samples, to be evaluated anywhere.

    It is read off an eight times finer grid by local polynomials through twelve points, which is
    exact to rounding for waves of at least sixteen samples and to 1e-9 of a wave of four.
    """

    def __init__(self, samples: np.ndarray) -> None:
        self._spectrum = np.fft.fft(samples)
        self._fine: dict[int, np.ndarray] = {}

    def __call__(self, angle: np.ndarray, order: int = 0) -> np.ndarray:
        """Complex values of the derivative of the given order at ``angle`` (period 2 pi)."""
        if order not in self._fine:
            self._fine[order] = self._on_fine_grid(order)
        return local_values(self._fine[order], np.ascontiguousarray(angle, dtype=float))

    def _on_fine_grid(self, order: int) -> np.ndarray:
        count = self._spectrum.size
        half = count // 2
        waves = self._spectrum * (1j * wavenumbers(count)) ** order
        padded = np.zeros(_FINER * count, complex)
        padded[: count - half] = waves[: count - half]
        padded[-half:] = waves[-half:]
        return np.asarray(np.fft.ifft(padded) * _FINER)


@kernel
def local_values(samples: np.ndarray, angle: np.ndarray) -> np.ndarray:
    """Values between equally spaced samples of period 2 pi, by polynomials through `TAPS`."""
    count = samples.size
    result = np.empty(angle.size, samples.dtype)
    weights = np.empty(TAPS)
    for i in range(angle.size):
        place = angle[i] * (count / (2.0 * math.pi))
        first = math.floor(place)
        lagrange_weights(place - first, weights)
        value = 0.0 * samples[0]
        for tap in range(TAPS):
            value += weights[tap] * samples[(first + tap - BEFORE) % count]
        result[i] = value
    return result


@kernel
def lagrange_weights(part: float, weights: np.ndarray) -> None:
    """Weights of the samples from `BEFORE` before to as many after a place ``part`` beyond one."""
    for tap in range(TAPS):
        weight = 1.0
        for other in range(TAPS):
            if other != tap:
                weight *= (part + BEFORE - other) / (tap - other)
        weights[tap] = weight
