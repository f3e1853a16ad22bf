"""Tracks with known answers, as plain arrays."""

from __future__ import annotations

import numpy as np

Arrays = tuple[np.ndarray, np.ndarray, np.ndarray]


def straight_track(speed: float = 0.2, records: int = 201, step: float = 0.5) -> Arrays:
    t = step * np.arange(records)
    return t, 0.6 * speed * t, 0.8 * speed * t


def circle_track(
    rate: float = 0.2, radius: float = 2.0, records: int = 501, step: float = 0.2
) -> Arrays:
    """Counter-clockwise for a positive rate."""
    t = step * np.arange(records)
    return t, radius * np.cos(rate * t), radius * np.sin(rate * t)


def sine_track(
    period: float = 18.0, swing: float = 1.4, records: int = 1001, step: float = 0.1
) -> Arrays:
    """Along x at speed 0.2 on average; the heading swings through ``swing`` rad."""
    t = step * np.arange(records)
    rate = 2.0 * np.pi / period
    return t, 0.2 * t, 0.2 * np.tan(0.5 * swing) / rate * np.sin(rate * t)


def moved(track: Arrays, angle: float, length: float, time: float, mirror: bool) -> Arrays:
    """The same track in other units, turned, mirrored in the x axis and elsewhere."""
    t, x, y = track
    y = -y if mirror else y
    c, s = np.cos(angle), np.sin(angle)
    return time * (t + 7.0), length * (c * x - s * y + 3.0), length * (s * x + c * y - 5.0)
