"""Roots of a function of one variable between points where its sign differs."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

Function = Callable[[np.ndarray], np.ndarray]

_ROUND_OFF = np.finfo(float).eps
_GOLDEN = 0.381966011250105


def bracketed_roots(function: Function, low: np.ndarray, high: np.ndarray) -> np.ndarray:
    """Return one root in each interval at whose ends ``function`` differs in sign, to rounding.

    Chandrupatla's method on all intervals at once; a sign that jumps counts as a root.

    Parameters
    ----------
    function : callable
        Of an array of positions, one an interval, to values.
    low, high : array, shape (intervals,)
        Ends of the intervals.
    """
    a, b = high.astype(float), low.astype(float)
    value_a, value_b = function(a), function(b)
    part = np.full(a.shape, 0.5)
    best = np.where(np.abs(value_a) < np.abs(value_b), a, b)
    for _ in range(200):
        x = a + part * (b - a)
        value = function(x)
        same = (value > 0.0) == (value_a > 0.0)
        c, value_c = np.where(same, a, b), np.where(same, value_a, value_b)
        b, value_b = np.where(same, b, a), np.where(same, value_b, value_a)
        a, value_a = x, value
        near_a = np.abs(value_a) < np.abs(value_b)
        best = np.where(near_a, a, b)
        width = np.abs(b - a)
        narrow = 2.0 * _ROUND_OFF * np.abs(best) + 1e-300
        if np.all((width <= 2.0 * narrow) | (np.where(near_a, value_a, value_b) == 0.0)):
            break
        part = _next_part(a, b, c, value_a, value_b, value_c)
        limit = np.minimum(0.5, narrow / np.maximum(width, narrow))
        part = np.clip(part, limit, 1.0 - limit)
    return best


def _next_part(
    a: np.ndarray,
    b: np.ndarray,
    c: np.ndarray,
    value_a: np.ndarray,
    value_b: np.ndarray,
    value_c: np.ndarray,
) -> np.ndarray:
    """Inverse quadratic interpolation where it is safe, else the middle."""
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        xi = (a - b) / (c - b)
        phi = (value_a - value_b) / (value_c - value_b)
        safe = (phi**2 < xi) & ((1.0 - phi) ** 2 < 1.0 - xi)
        guess = value_a / (value_b - value_a) * value_c / (value_b - value_c) + (c - a) / (
            b - a
        ) * value_a / (value_c - value_a) * value_b / (value_c - value_b)
    return np.where(safe & np.isfinite(guess), guess, 0.5)


def all_roots(function: Function, low: float, high: float, samples: int = 2001) -> np.ndarray:
    """Return the roots of ``function`` in an interval, in order.

    The sign is read at equal steps, and at the extremum where a step's values come near zero, so
    that a pair of roots in one step is found too; more detail than that is missed.
    """
    x = np.linspace(low, high, samples)
    value = function(x)
    size = np.abs(value)
    inside = value > 0.0
    dips = 1 + np.flatnonzero(
        (size[1:-1] <= size[:-2])
        & (size[1:-1] <= size[2:])
        & (inside[1:-1] == inside[:-2])
        & (inside[1:-1] == inside[2:])
    )
    if dips.size:
        sign = np.where(inside[dips], 1.0, -1.0)
        lowest = _minimum(lambda at: sign * function(at), x[dips - 1], x[dips + 1])
        x = np.unique(np.concatenate([x, lowest]))
        inside = function(x) > 0.0
    change = np.flatnonzero(inside[1:] != inside[:-1])
    return bracketed_roots(function, x[change], x[change + 1]) if change.size else np.empty(0)


def _minimum(function: Function, low: np.ndarray, high: np.ndarray) -> np.ndarray:
    """Return where ``function`` is lowest in each interval, by golden section."""
    left, right = low + _GOLDEN * (high - low), high - _GOLDEN * (high - low)
    value_left, value_right = function(left), function(right)
    for _ in range(80):
        leftward = value_left < value_right
        high, low = np.where(leftward, right, high), np.where(leftward, low, left)
        new = np.where(leftward, low + _GOLDEN * (high - low), high - _GOLDEN * (high - low))
        value = function(new)
        left, right = np.where(leftward, new, right), np.where(leftward, left, new)
        value_left, value_right = (
            np.where(leftward, value, value_right),
            np.where(leftward, value_left, value),
        )
    lowest: np.ndarray = np.where(value_left < value_right, left, right)
    return lowest
