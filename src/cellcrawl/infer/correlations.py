"""Correlations within films and between what they show, 0 where there is nothing to correlate."""

from __future__ import annotations

from typing import Final

import numpy as np

TINY: Final = 1e-12


def lags(count: int) -> list[int]:
    """Return 1, 2, 4, ... frames, up to a third of what there is."""
    return [2**i for i in range(8) if 2**i <= max(count // 3, 1)]


def correlation(values: np.ndarray, lag: int, least: np.ndarray | float = 0.0) -> np.ndarray:
    """Return the correlation with itself after a lag; changes below ``least`` count as noise."""
    power = (np.abs(values) ** 2).mean(axis=1) + least**2
    product = (values[:, lag:] * np.conj(values[:, :-lag])).real.mean(axis=1)
    return ratio(product, power)


def together(one: np.ndarray, other: np.ndarray) -> np.ndarray:
    """Return the correlation of two numbers over all but the first axis."""
    axes = tuple(range(1, one.ndim))
    a = one - one.mean(axis=axes, keepdims=True)
    b = other - other.mean(axis=axes, keepdims=True)
    size = np.sqrt((a**2).mean(axis=axes) * (b**2).mean(axis=axes))
    return ratio((a * b).mean(axis=axes), size)


def ratio(above: np.ndarray, below: np.ndarray) -> np.ndarray:
    """Return a ratio to something above 0, finite where that vanishes."""
    return np.asarray(above / np.maximum(below, TINY))
