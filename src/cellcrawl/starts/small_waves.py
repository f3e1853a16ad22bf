"""A circle with small waves, as the paper's random start is, in kernels: a browser has no NumPy.

The same curve as `from_path` makes, by shorter ways that small waves allow: radius, slope and area
are known exactly, only the arclength has to be integrated.
"""

from __future__ import annotations

import math
from typing import Final

import numpy as np

from cellcrawl.curve.sines import sine_and_cosine
from cellcrawl.numerics.elementary import arc_tangent
from cellcrawl.numerics.fourier import local_values
from cellcrawl.numerics.kernels import kernel

SAMPLES: Final = 4096
HIGHEST: Final = 255  # mode that so many samples show
STEEPEST: Final = 0.6  # slope of all waves together up to which Newton steps find every place
_FINER: Final = 8
_NEWTON_STEPS: Final = 6
_CLOSINGS: Final = 8


@kernel
def fast_transform(real: np.ndarray, imaginary: np.ndarray, sign: float) -> None:
    """Replace samples by ``sum_j a_j exp(sign 2 pi i j k / size)``; the size is a power of 2."""
    size = real.size
    j = 0
    for i in range(1, size):
        bit = size >> 1
        while j & bit:
            j ^= bit
            bit >>= 1
        j |= bit
        if i < j:
            real[i], real[j] = real[j], real[i]
            imaginary[i], imaginary[j] = imaginary[j], imaginary[i]
    half = 1
    while half < size:
        for k in range(half):
            sine, cosine = sine_and_cosine(sign * math.pi * k / half)
            for i in range(k, size, 2 * half):
                other = i + half
                a = real[other] * cosine - imaginary[other] * sine
                b = real[other] * sine + imaginary[other] * cosine
                real[other], imaginary[other] = real[i] - a, imaginary[i] - b
                real[i] += a
                imaginary[i] += b
        half *= 2


@kernel
def waves(amplitudes: np.ndarray, first: int, angle: float) -> tuple[float, float]:
    """Sum of ``a_k cos(k angle) + b_k sin(k angle)`` and its slope.

    ``amplitudes`` has a row for k = 1, 2, …; a and b are its entries from ``first`` on.
    """
    sine, cosine = sine_and_cosine(angle)
    value_r = value_i = slope_r = slope_i = 0.0
    for row in range(amplitudes.shape[0] - 1, -1, -1):
        k = row + 1.0
        a, b = amplitudes[row, first], amplitudes[row, first + 1]
        value_r, value_i = value_r + a, value_i - b
        slope_r, slope_i = slope_r + k * b, slope_i + k * a
        value_r, value_i = value_r * cosine - value_i * sine, value_r * sine + value_i * cosine
        slope_r, slope_i = slope_r * cosine - slope_i * sine, slope_r * sine + slope_i * cosine
    return value_r, slope_r


@kernel
def random_start(
    amplitudes: np.ndarray, n_bar: float, theta: np.ndarray, bound: np.ndarray
) -> tuple[float, float]:
    """Fill tangent angle and bound fraction at equal arclengths; return length and area.

    Columns of ``amplitudes``: cosine and sine of the radius, the same of the bound fraction.
    ``theta`` and ``bound`` have shape (nodes,). Node 0 is at polar angle 0.
    """
    nodes = theta.size
    turn = 2.0 * math.pi
    speed = np.empty(SAMPLES)
    mean = area = 0.0
    for j in range(SAMPLES):
        wave, slope = waves(amplitudes, 0, turn * j / SAMPLES)
        radius = 1.0 + wave
        speed[j] = math.sqrt(radius * radius + slope * slope)
        mean += speed[j]
        area += radius * radius
    mean /= SAMPLES
    area *= math.pi / SAMPLES
    lead = _lead_on_fine_grid(speed, mean)
    angle = np.empty(nodes)
    for i in range(nodes):
        angle[i] = turn * i / nodes
    for _ in range(_NEWTON_STEPS):
        ahead = local_values(lead, angle)
        for i in range(nodes):
            wave, slope = waves(amplitudes, 0, angle[i])
            pace = math.sqrt((1.0 + wave) ** 2 + slope * slope)
            miss = (angle[i] - turn * i / nodes) * mean + ahead[i]
            angle[i] -= miss / pace
    for i in range(nodes):
        wave, slope = waves(amplitudes, 0, angle[i])
        theta[i] = angle[i] + 0.5 * math.pi - arc_tangent(slope / (1.0 + wave))
        wave, slope = waves(amplitudes, 2, angle[i])
        bound[i] = n_bar + wave
    _close(theta)
    return turn * mean, area


@kernel
def _lead_on_fine_grid(speed: np.ndarray, mean: float) -> np.ndarray:
    """Arclength ahead of the mean, from angle 0, at equal steps of the angle."""
    count = speed.size
    real, imaginary = speed - mean, np.zeros(count)
    fast_transform(real, imaginary, -1.0)
    fine = np.zeros(count * _FINER)
    fine_i = np.zeros(count * _FINER)
    for k in range(1, count // 2):
        scale = 2.0 / (count * k)  # and the integral turns by a quarter
        fine[k], fine_i[k] = imaginary[k] * scale, -real[k] * scale
    fast_transform(fine, fine_i, 1.0)
    first = fine[0]
    for k in range(fine.size):
        fine[k] -= first
    return fine


@kernel
def _close(theta: np.ndarray) -> None:
    """Close the curve by the least change of its tangent angle."""
    nodes = theta.size
    for _ in range(_CLOSINGS):
        gap_x = gap_y = cc = cs = ss = 0.0
        for i in range(nodes):
            sine, cosine = sine_and_cosine(theta[i])
            gap_x += cosine
            gap_y += sine
            cc += cosine * cosine
            cs += cosine * sine
            ss += sine * sine
        inverse = 1.0 / (ss * cc - cs * cs)
        p = (gap_x * cc + gap_y * cs) * inverse
        q = -(gap_x * cs + gap_y * ss) * inverse
        for i in range(nodes):
            sine, cosine = sine_and_cosine(theta[i])
            theta[i] += p * sine + q * cosine
