"""One colour scale a field, in every picture and movie; and the labels with symbol and unit.

All maps are even in lightness and told apart by colour-blind readers; a diverging one stands only
where zero means something.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Final, NamedTuple

import numpy as np
from matplotlib.colors import LogNorm, Normalize, SymLogNorm

from cellcrawl.errors import InputError
from cellcrawl.validation import real_array

Limits = tuple[float, float]


class Scale(NamedTuple):
    """How a field is shown."""

    name: str
    symbol: str
    unit: str
    colormap: str
    limits: Callable[[np.ndarray], Limits]
    """The limits for given values."""
    norm: Callable[[float, float], Normalize]

    @property
    def label(self) -> str:
        """The name with symbol and unit."""
        return f"{self.name} {self.symbol}" + (f" ({self.unit})" if self.unit else "")

    @property
    def reaches_white(self) -> bool:
        """Whether some of the colours would be lost on paper."""
        return self.colormap not in ("viridis", "cividis")

    @property
    def short_label(self) -> str:
        """The symbol with the unit."""
        return self.symbol + (f" ({self.unit})" if self.unit else "")


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
    edges = [1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0, 200.0, 500.0]
    return (
        max((edge for edge in edges if edge <= low), default=edges[0]),
        min((edge for edge in edges if edge >= high), default=1000.0),
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


def _linear(low: float, high: float) -> Normalize:
    return Normalize(low, high)


def _logarithmic(low: float, high: float) -> Normalize:
    return LogNorm(low, high)


def _curvature_norm(low: float, high: float) -> Normalize:
    """Linear within the curvature of the round cell, logarithmic outside, where corners are."""
    return SymLogNorm(1.0, vmin=low, vmax=high, base=10)


_RADIUS = "$R_0$"
SCALES: Final[dict[str, Scale]] = {
    "bound_fraction": Scale("bound fraction", "$n$", "", "viridis", _bound, _linear),
    "off_rate": Scale(
        "off-rate", "$r$", r"$k_\mathrm{off}^0$", "magma", _whole_decades, _logarithmic
    ),
    "friction": Scale("friction", "$f$", r"$\zeta_0 v_\beta$", "cividis", _bulk, _linear),
    "curvature": Scale("curvature", r"$\kappa$", "$1/R_0$", "PuOr_r", _curved, _curvature_norm),
    "normal_velocity": Scale(
        "normal velocity", "$U$", r"$R_0 k_\mathrm{off}^0$", "RdBu_r", _about_zero, _linear
    ),
    "theta": Scale("tangent angle", r"$\theta$", "rad", "viridis", _bulk, _linear),
    "x": Scale("position", "$x$", _RADIUS, "viridis", _bulk, _linear),
    "y": Scale("position", "$y$", _RADIUS, "viridis", _bulk, _linear),
}

TIME_LABEL: Final = r"time $t$ ($1/k_\mathrm{off}^0$)"
SERIES_LABELS: Final[dict[str, tuple[str, str]]] = {
    "tension": ("tension", r"$\sigma$ ($\zeta_0 v_\beta/2$)"),
    "speed": ("speed", r"$v$ ($R_0 k_\mathrm{off}^0$)"),
    "length": ("length", "$L$ ($R_0$)"),
    "area": ("area", "$A$ ($R_0^2$)"),
    "circularity": ("circularity", r"$4\pi A/L^2$"),
}


def norm_for(field: str, values: np.ndarray, limits: Limits | None) -> Normalize:
    """Return the norm of a field for these values, or with the limits the user gave."""
    scale = SCALES[field]
    if limits is None:
        finite = values[np.isfinite(values)]
        return scale.norm(*scale.limits(finite if finite.size else np.zeros(1)))
    low, high = (float(limit) for limit in real_array("limits", limits, (2,)))
    if low >= high:
        raise InputError(f"limits = ({low:g}, {high:g}): the first must be below the second")
    norm = scale.norm(low, high)
    if isinstance(norm, LogNorm) and low <= 0.0:
        raise InputError(f"limits = ({low:g}, {high:g}): {field} has a logarithmic scale, above 0")
    return norm


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
        sizes = [1.0, 10.0, 100.0]
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
