"""Axes over the points of a sweep: scale, limits, ticks and tiles that suit their spacing."""

from __future__ import annotations

from typing import Any, Final

import numpy as np
from matplotlib.axes import Axes
from matplotlib.ticker import FixedLocator, FuncFormatter, NullLocator

_MORE_EVEN: Final = 0.5  # spaces of logarithms are this part as uneven as those of the points ...
_EVEN: Final = 1.6  # ... and the widest is so many times the narrowest: 1, 2, 5, 10 is even
_MOST_TICKS: Final = {"x": 12, "y": 12}  # so many points have a tick each


def is_logarithmic(values: np.ndarray) -> bool:
    """Whether sorted points are more evenly spaced in their logarithm than in themselves."""
    if values.size < 3 or values[0] <= 0.0:
        return False
    in_logarithm, in_themselves = (
        float(spaces.max() / spaces.min()) for spaces in (np.diff(np.log(values)), np.diff(values))
    )
    return in_logarithm <= min(_EVEN, 1.0 + _MORE_EVEN * (in_themselves - 1.0))


def edges(values: np.ndarray) -> np.ndarray:
    """Return the sides of tiles around sorted points, one more than points."""
    if values.size == 1:
        return float(values[0]) + np.array([-0.5, 0.5]) * (abs(float(values[0])) or 1.0)
    if is_logarithmic(values):
        sides: np.ndarray = np.exp(_edges(np.log(values)))
        return sides
    return _edges(values)


def _edges(values: np.ndarray) -> np.ndarray:
    inner = 0.5 * (values[1:] + values[:-1])
    ends = [[2.0 * values[0] - inner[0]], [2.0 * values[-1] - inner[-1]]]
    return np.concatenate([ends[0], inner, ends[1]])


def prepare(axes: Axes, which: str, values: np.ndarray, margin: float = 0.75) -> None:
    """Set scale, limits and ticks of the axis ``which``, "x" or "y", for these points.

    Limits are ``margin`` of a space outside the points. Few points have a tick each.
    """
    places = np.unique(values)
    logarithmic = is_logarithmic(places)
    set_scale, set_limits, axis = (
        (axes.set_xscale, axes.set_xlim, axes.xaxis)
        if which == "x"
        else (axes.set_yscale, axes.set_ylim, axes.yaxis)
    )
    at = np.log(places) if logarithmic else places
    space = float(np.min(np.diff(at))) if places.size > 1 else 1.0
    limits = np.array([at[0] - margin * space, at[-1] + margin * space])
    if logarithmic:
        set_scale("log")
        limits = np.exp(limits)
    set_limits(*limits.tolist())
    if places.size <= _MOST_TICKS[which]:
        axis.set_major_locator(FixedLocator(places.tolist()))
        axis.set_major_formatter(FuncFormatter(_plain))
        axis.set_minor_locator(NullLocator())


def _plain(value: float, position: Any) -> str:
    return f"{value:.4g}"
