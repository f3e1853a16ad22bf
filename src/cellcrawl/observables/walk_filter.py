"""The Kalman filter of a persistent walk: what its likelihood takes time for."""

from __future__ import annotations

import numpy as np

from cellcrawl._compile import kernel


@kernel
def minus_log_likelihood(
    places: np.ndarray,
    sizes: np.ndarray,
    which: np.ndarray,
    forward: np.ndarray,
    spread: np.ndarray,
    exposure: float,
    velocity_variance: float,
    error_variance: float,
) -> float:
    """Return minus the log-likelihood of positions (2, records of all tracks), but for a constant.

    The first record of a track places the walk: its state is that of a cell seen there, of any
    velocity.
    """
    mean = np.zeros((3, 2))
    covariance = np.zeros((3, 3))
    total = 0.0
    after = np.zeros((3, 2))
    product = np.zeros((3, 3))
    row = 2 if exposure > 0.0 else 0
    scale = 1.0 / exposure if exposure > 0.0 else 1.0
    record = 0
    gap = 0
    for size in sizes:
        mean[:] = 0.0
        covariance[:] = 0.0
        mean[0, 0] = places[0, record]
        mean[0, 1] = places[1, record]
        covariance[0, 0] = error_variance + velocity_variance * exposure * exposure
        covariance[1, 1] = velocity_variance
        record += 1
        for _ in range(size - 1):
            step = forward[which[gap]]
            noise = spread[which[gap]]
            for k in range(3):  # the integral over the exposure begins anew
                covariance[2, k] = 0.0
                covariance[k, 2] = 0.0
            mean[2, 0] = 0.0
            mean[2, 1] = 0.0
            for i in range(3):
                for axis in range(2):
                    after[i, axis] = 0.0
                    for k in range(3):
                        after[i, axis] += step[i, k] * mean[k, axis]
                for j in range(3):
                    product[i, j] = 0.0
                    for k in range(3):
                        product[i, j] += step[i, k] * covariance[k, j]
            for i in range(3):
                for j in range(3):
                    value = noise[i, j]
                    for k in range(3):
                        value += product[i, k] * step[j, k]
                    covariance[i, j] = value
            variance = covariance[row, row] * scale * scale + error_variance
            total += np.log(variance)
            for axis in range(2):
                missed = places[axis, record] - after[row, axis] * scale
                total += 0.5 * missed * missed / variance
                for i in range(3):
                    mean[i, axis] = after[i, axis] + covariance[i, row] * scale * missed / variance
            for i in range(3):
                product[i, 0] = covariance[i, row] * scale
            for i in range(3):
                for j in range(3):
                    covariance[i, j] -= product[i, 0] * product[j, 0] / variance
            record += 1
            gap += 1
    return total
