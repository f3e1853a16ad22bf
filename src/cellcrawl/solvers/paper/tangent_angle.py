"""Second-order geometry of the equal-arclength frame, as the paper's scheme uses it.

``theta`` has shape (nodes,) and gains 2 pi once round. Derivatives are central differences over
two spacings, which is stable here where compact differences are not; running integrals are
trapezoidal with end correction.
"""

from __future__ import annotations

import math

import numpy as np

from cellcrawl.numerics.kernels import kernel


@kernel
def central_difference(f: np.ndarray, spacing: float, jump: float, out: np.ndarray) -> None:
    """``out = df/ds`` of samples that gain ``jump`` once round."""
    nodes = f.size
    scale = 0.5 / spacing
    for i in range(1, nodes - 1):
        out[i] = (f[i + 1] - f[i - 1]) * scale
    out[0] = (f[1] - (f[nodes - 1] - jump)) * scale
    out[nodes - 1] = ((f[0] + jump) - f[nodes - 2]) * scale


@kernel
def curvature(theta: np.ndarray, length: float, out: np.ndarray) -> None:
    """``kappa = d theta / ds`` at the nodes."""
    central_difference(theta, length / theta.size, 2.0 * math.pi, out)


@kernel
def close(theta: np.ndarray, cosine: np.ndarray, sine: np.ndarray) -> None:
    """Close the outline in place by the least change of the angles that does so to first order.

    That change is a combination of sine and cosine of the angle itself, ``p sin + q cos``; what it
    leaves is the square of the gap. ``cosine`` and ``sine`` are those of ``theta``, before and
    after.
    """
    sum_x = sum_y = square_x = square_y = mixed = 0.0
    for i in range(theta.size):
        sum_x += cosine[i]
        sum_y += sine[i]
        square_x += cosine[i] * cosine[i]
        square_y += sine[i] * sine[i]
        mixed += cosine[i] * sine[i]
    scale = 1.0 / (square_x * square_y - mixed * mixed)
    p = scale * (sum_x * square_x + sum_y * mixed)
    q = -scale * (sum_y * square_y + sum_x * mixed)
    for i in range(theta.size):
        turn = p * sine[i] + q * cosine[i]
        theta[i] += turn
        before, half = cosine[i], 0.5 * turn * turn
        cosine[i] -= turn * sine[i] + half * before
        sine[i] += turn * before - half * sine[i]


@kernel
def points(
    length: float,
    cosine: np.ndarray,
    sine: np.ndarray,
    kappa: np.ndarray,
    x: np.ndarray,
    y: np.ndarray,
) -> float:
    """Positions relative to node 0 from the tangents; the gap at the end is spread evenly.

    Returns the gap over the length.
    """
    nodes = cosine.size
    spacing = length / nodes
    correction = spacing * spacing / 12.0
    half = 0.5 * spacing
    sum_x = sum_y = 0.0
    x[0] = y[0] = 0.0
    for i in range(1, nodes):
        sum_x += half * (cosine[i - 1] + cosine[i])
        sum_y += half * (sine[i - 1] + sine[i])
        x[i] = sum_x
        y[i] = sum_y
    gap_x = sum_x + half * (cosine[nodes - 1] + cosine[0])
    gap_y = sum_y + half * (sine[nodes - 1] + sine[0])
    bend_x, bend_y = sine[0] * kappa[0], cosine[0] * kappa[0]
    for i in range(1, nodes):
        part = i / nodes
        x[i] += correction * (sine[i] * kappa[i] - bend_x) - gap_x * part
        y[i] -= correction * (cosine[i] * kappa[i] - bend_y) + gap_y * part
    return math.hypot(gap_x, gap_y) / length


@kernel
def enclosed_area(
    length: float, cosine: np.ndarray, sine: np.ndarray, x: np.ndarray, y: np.ndarray
) -> float:
    """Area from the support function, half the integral of ``x . n``."""
    total = 0.0
    for i in range(x.size):
        total += x[i] * sine[i] - y[i] * cosine[i]
    return 0.5 * total * length / x.size


@kernel
def centroid(
    length: float,
    area: float,
    cosine: np.ndarray,
    sine: np.ndarray,
    x: np.ndarray,
    y: np.ndarray,
) -> tuple[float, float]:
    """Centroid of the enclosed area, in the frame of ``x`` and ``y``."""
    moment_x = moment_y = 0.0
    for i in range(x.size):
        moment_x += x[i] * x[i] * sine[i]
        moment_y -= y[i] * y[i] * cosine[i]
    scale = length / x.size / (2.0 * area)
    return moment_x * scale, moment_y * scale


@kernel
def tangential_velocity(
    kappa: np.ndarray, velocity: np.ndarray, length: float, out: np.ndarray, work: np.ndarray
) -> float:
    """``T`` that keeps nodes equally spaced (zero at node 0); returns ``d log L / dt``.

    ``T_s = <kappa U> - kappa U``. ``work`` has shape (2, nodes).
    """
    nodes = kappa.size
    spacing = length / nodes
    stretch, slope = work[0], work[1]
    total = 0.0
    for i in range(nodes):
        stretch[i] = kappa[i] * velocity[i]
        total += stretch[i]
    mean = total / nodes
    central_difference(stretch, spacing, 0.0, slope)
    correction = spacing * spacing / 12.0
    running = 0.0
    out[0] = 0.0
    for i in range(1, nodes):
        running += spacing * (mean - 0.5 * (stretch[i - 1] + stretch[i]))
        out[i] = running + correction * (slope[i] - slope[0])
    return mean
