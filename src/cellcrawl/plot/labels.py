"""Labels with symbol and unit, from the units that travel with the data."""

from __future__ import annotations

from typing import Final

import xarray as xr

from cellcrawl.data.units import units_of
from cellcrawl.plot.scales import SCALES

_WRITTEN: Final[dict[str, str]] = {
    "R_0": "$R_0$",
    "R_0^2": "$R_0^2$",
    "1/R_0": "$1/R_0$",
    "1/k_off0": r"$1/k_\mathrm{off}^0$",
    "k_off0": r"$k_\mathrm{off}^0$",
    "R_0 k_off0": r"$R_0 k_\mathrm{off}^0$",
    "zeta_0 v_beta": r"$\zeta_0 v_\beta$",
    "zeta_0 v_beta / 2": r"$\zeta_0 v_\beta/2$",
    "um": "µm",
    "um^2": "µm²",
    "1/um": "1/µm",
    "um/s": "µm/s",
    "pN/um": "pN/µm",
    "1": "",
}
_SERIES: Final[dict[str, tuple[str, str, str]]] = {
    "tension": ("tension", r"$\sigma$", "tension"),
    "speed": ("speed", "$v$", "velocity"),
    "length": ("length", "$L$", "length"),
    "area": ("area", "$A$", "area"),
    "circularity": ("circularity", r"$4\pi A/L^2$", ""),
}
SERIES: Final = tuple(_SERIES)
"""The quantities that are drawn over time."""


def unit(label: str) -> str:
    """Return a unit of the data as it is written in pictures."""
    return _WRITTEN.get(label, label)


def with_unit(text: str, label: str) -> str:
    """Return a text with the unit in brackets, if there is one."""
    written = unit(label)
    return f"{text} ({written})" if written else text


def time_label(run: xr.Dataset) -> str:
    """Return the label of the time axis."""
    return with_unit("time $t$", time_unit(run))


def time_unit(run: xr.Dataset) -> str:
    """Return the unit of time, as in the data."""
    return str(run["time"].attrs.get("units") or units_of(run).label("time"))


def position_label(run: xr.Dataset, axis: str) -> str:
    """Return the label of a coordinate."""
    return with_unit(f"${axis}$", length_unit(run))


def time_text(run: xr.Dataset, time: float, form: str = ".4g") -> str:
    """Return a time with its unit."""
    label = time_unit(run)
    written = unit(label)
    if label.startswith("1/"):  # 10/k, not 10 1/k
        return f"{time:{form}}{written.replace('$1/', '$/', 1)}"
    return f"{time:{form}} {written}".rstrip()


def length_unit(run: xr.Dataset) -> str:
    """Return the unit of length, as in the data."""
    return units_of(run).label("length")


def field_label(run: xr.Dataset, field: str, scale: str | None = None, short: bool = False) -> str:
    """Return the name, symbol and unit of a field; ``scale`` if the look goes by another name."""
    look = SCALES[scale or field]
    symbol = look.symbol if short else f"{look.name} {look.symbol}"
    return with_unit(symbol, str(run[field].attrs.get("units", "")))


def series_label(run: xr.Dataset, quantity: str) -> str:
    """Return name, symbol and unit of a quantity over time, on two lines."""
    name, symbol, kind = _SERIES[quantity]
    return f"{name}\n{with_unit(symbol, units_of(run).label(kind) if kind else '')}"
