"""One colour scale a field, in every picture and movie; and the labels with symbol and unit.

Units are those the data is in; numbers that belong to the model, such as the curvature of the round
cell, are scaled to them.

All maps are even in lightness and told apart by colour-blind readers; a diverging one stands only
where zero means something.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any, Final, NamedTuple

import matplotlib as mpl
import numpy as np
from matplotlib.colors import LogNorm, Normalize, SymLogNorm

from cellcrawl.data.units import DIMENSIONLESS, Units
from cellcrawl.errors import InputError
from cellcrawl.validation import real_array

Limits = tuple[float, float]


class Scale(NamedTuple):
    """How a field is shown."""

    name: str
    symbol: str
    colormap: str
    limits: Callable[[np.ndarray], Limits]
    """The limits for given values, without dimension where the norm is not linear."""
    norm: Callable[[float, float, float], Normalize]
    """The norm for limits and the size of one dimensionless unit."""


def _bound(values: np.ndarray) -> Limits:
    inside = values.min() >= 0.1 and values.max() <= 0.8
    return (0.1, 0.8) if inside else (0.0, 1.0)


def _bulk(values: np.ndarray) -> Limits:
    """All but the outer half percent at each end, rounded outwards to two digits of the range."""
    low, high = np.percentile(values, [0.5, 99.5])
    step = 10.0 ** math.floor(math.log10(max(high - low, 1e-9 * abs(high), 1e-300))) / 2.0
    return math.floor(low / step) * step, math.ceil(high / step) * step


def _whole_decades(values: np.ndarray) -> Limits:
    low, high = np.percentile(values, [0.1, 99.9])
    edges = [step * 10.0**decade for decade in range(-3, 4) for step in (1.0, 2.0, 5.0)]
    return (
        max((edge for edge in edges if edge <= low), default=edges[0]),
        min((edge for edge in edges if edge >= high), default=edges[-1]),
    )


def _curved(values: np.ndarray) -> Limits:
    reach = float(np.percentile(np.abs(values), 99.5))
    top = next((edge for edge in (2.0, 5.0, 10.0, 20.0, 50.0) if edge >= reach), 100.0)
    return -top, top


def _about_zero(values: np.ndarray) -> Limits:
    reach = float(np.percentile(np.abs(values), 99.5))
    step = 10.0 ** math.floor(math.log10(max(reach, 1e-12)))
    top = math.ceil(reach / step) * step if reach > 0.0 else 1.0
    return -top, top


def _linear(low: float, high: float, one: float) -> Normalize:
    return Normalize(low, high)


def _logarithmic(low: float, high: float, one: float) -> Normalize:
    return LogNorm(low, high)


def _curvature_norm(low: float, high: float, one: float) -> Normalize:
    """Linear within the curvature of the round cell, logarithmic outside, where corners are."""
    return SymLogNorm(one, vmin=low, vmax=high, base=10)


SCALES: Final[dict[str, Scale]] = {
    "bound_fraction": Scale("bound fraction", "$n$", "viridis", _bound, _linear),
    "off_rate": Scale("off-rate", "$r$", "magma", _whole_decades, _logarithmic),
    "friction": Scale("friction", "$f$", "cividis", _bulk, _linear),
    "curvature": Scale("curvature", r"$\kappa$", "PuOr_r", _curved, _curvature_norm),
    "normal_velocity": Scale("normal velocity", "$U$", "RdBu_r", _about_zero, _linear),
    "theta": Scale("tangent angle", r"$\theta$", "viridis", _bulk, _linear),
    "x": Scale("position", "$x$", "viridis", _bulk, _linear),
    "y": Scale("position", "$y$", "viridis", _bulk, _linear),
}
_SCALED: Final = {"off_rate": "rate", "curvature": "curvature"}
"""Fields whose limits are round numbers of the model's own unit, which is of this kind."""


def norm_for(
    field: str, values: np.ndarray, limits: Limits | None, units: Units = DIMENSIONLESS
) -> Normalize:
    """Return the norm of a field for these values, or with the limits the user gave."""
    scale = SCALES[field]
    one = units.one(_SCALED[field]) if field in _SCALED else 1.0
    if math.isnan(one):
        one = 1.0
    if limits is None:
        finite = values[np.isfinite(values)]
        low, high = scale.limits((finite if finite.size else np.zeros(1)) / one)
        return scale.norm(low * one, high * one, one)
    low, high = checked_limits(limits)
    norm = scale.norm(low, high, one)
    if isinstance(norm, LogNorm) and low <= 0.0:
        raise InputError(f"limits = ({low:g}, {high:g}): {field} has a logarithmic scale, above 0")
    return norm


def checked_limits(limits: Any, name: str = "limits") -> Limits:
    """Return two limits, the first below the second, or raise `InputError`."""
    low, high = (float(limit) for limit in real_array(name, limits, (2,)))
    if low >= high:
        raise InputError(f"{name} = ({low:g}, {high:g}): the first must be below the second")
    return low, high


def reaches_white(colormap: str) -> bool:
    """Whether some of the colours would be lost on paper."""
    ends = mpl.colormaps[colormap](np.linspace(0.0, 1.0, 32))[:, :3]
    return bool(np.any(ends.min(axis=1) > 0.85))


def ticks_for(norm: Normalize) -> list[float] | None:
    """Return round ticks for a logarithmic scale; None leaves them to matplotlib."""
    assert norm.vmin is not None
    assert norm.vmax is not None
    low, high = float(norm.vmin), float(norm.vmax)
    if isinstance(norm, LogNorm):
        steps = (1.0, 2.0, 5.0) if high / low <= 1000.0 else (1.0,)
        decades = range(math.floor(math.log10(low)), math.ceil(math.log10(high)) + 1)
        ticks = [step * 10.0**decade for decade in decades for step in steps]
    elif isinstance(norm, SymLogNorm):
        first = math.ceil(math.log10(norm.linthresh) - 1e-9)
        sizes = [10.0**power for power in range(first, first + 3)]
        ticks = [*(-size for size in reversed(sizes)), 0.0, *sizes]
    else:
        return None
    return [
        tick for tick in ticks if low - 1e-9 * abs(low) <= tick <= high + 1e-9 * abs(high)
    ] or None


def extend_for(norm: Normalize, values: np.ndarray) -> str:
    """Return at which ends of the colour bar values lie beyond the limits."""
    assert norm.vmin is not None
    assert norm.vmax is not None
    below = bool(np.nanmin(values) < norm.vmin)
    above = bool(np.nanmax(values) > norm.vmax)
    return {(False, False): "neither", (True, False): "min", (False, True): "max"}.get(
        (below, above), "both"
    )
