"""NumPy's own arithmetic without its wrappers, which cost most of the time on short arrays.

Each function returns the same bits as the one of NumPy that it names. A track of thirty records is
some fifty such calls.
"""

from __future__ import annotations

import math

import numpy as np


def median(values: np.ndarray) -> float:
    """Return `np.median`."""
    ordered = np.sort(values)
    half = ordered.size // 2
    return float(ordered[half] if ordered.size % 2 else 0.5 * (ordered[half - 1] + ordered[half]))


def mean(values: np.ndarray) -> float:
    """Return `np.mean` of values that are there."""
    return float(np.add.reduce(values)) / values.size


def row_means(rows: np.ndarray) -> np.ndarray:
    """Return `np.mean` along each row of rows (row, record), (row, 1)."""
    means: np.ndarray = np.add.reduce(rows, axis=1, keepdims=True) / rows.shape[1]
    return means


def peak_to_peak(values: np.ndarray) -> float:
    """Return `np.ptp`."""
    return float(np.maximum.reduce(values) - np.minimum.reduce(values))


def standard_deviation(values: np.ndarray) -> float:
    """Return `np.std` with ``ddof=1``."""
    around = values - np.add.reduce(values) / values.size
    return math.sqrt(float(np.add.reduce(around * around)) / (values.size - 1))


def evenly_spaced(first: float, last: float, size: int) -> np.ndarray:
    """Return `np.linspace` of two values or more."""
    step = (last - first) / (size - 1)
    even = np.arange(size, dtype=float)
    if step == 0.0:
        even /= size - 1
        step = last - first
    even *= step
    even += first
    even[-1] = last
    return even


def slopes(rows: np.ndarray, step: float) -> np.ndarray:
    """Return `np.gradient` along rows (row, record), second order to the ends."""
    found = np.empty_like(rows)
    found[:, 1:-1] = (rows[:, 2:] - rows[:, :-2]) / (2.0 * step)
    found[:, 0] = (
        (-1.5 / step) * rows[:, 0] + (2.0 / step) * rows[:, 1] + (-0.5 / step) * rows[:, 2]
    )
    found[:, -1] = (
        (0.5 / step) * rows[:, -3] + (-2.0 / step) * rows[:, -2] + (1.5 / step) * rows[:, -1]
    )
    return found


def unwrapped(angle: np.ndarray) -> np.ndarray:
    """Return `np.unwrap`."""
    change = angle[1:] - angle[:-1]
    leaps = np.abs(change) >= math.pi
    if not leaps.any():
        return angle
    wrapped = np.mod(change + math.pi, 2.0 * math.pi) - math.pi
    wrapped[(wrapped == -math.pi) & (change > 0.0)] = math.pi
    corrections = np.where(leaps, wrapped - change, 0.0)
    found = angle.copy()
    found[1:] += np.add.accumulate(corrections)
    return found
