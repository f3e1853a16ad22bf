"""The units of a run's Dataset, read from the data: dimensionless, in SI, or in micrometres.

Variables carry their unit in ``attrs["units"]``. A run leaves the solver without dimension;
`Scales.dataset` puts it into SI, and pictures show SI in micrometres.
"""

from __future__ import annotations

import json
import math
from dataclasses import dataclass
from typing import Final

import numpy as np
import xarray as xr

from cellcrawl.data import SYSTEMS, VARIABLES, systems_of
from cellcrawl.parameters.scales import KINDS, Scales

_MICRO: Final[dict[str, tuple[str, float]]] = {
    "m": ("um", 1e6),
    "m^2": ("um^2", 1e12),
    "1/m": ("1/um", 1e-6),
    "m/s": ("um/s", 1e6),
    "m^2/s": ("um^2/s", 1e12),
    "N/m": ("pN/um", 1e6),
}
"""SI units that are unwieldy for a cell: what is written instead, and how many make one."""


@dataclass(frozen=True)
class Units:
    """The system of units of a dataset, and its scales where they are known.

    Attributes
    ----------
    system : str
        One of `cellcrawl.data.SYSTEMS`, or "own".
    scales : Scales or None
        What one dimensionless unit is in SI; None for a dimensionless dataset, or if unknown.
    """

    system: str
    scales: Scales | None = None
    own: tuple[str, str] = ("", "")
    """Units of length and time of outlines from a microscope, whose system is "own"."""

    def label(self, kind: str) -> str:
        """Return the unit of a kind of quantity ("length", "velocity", ...; see `KINDS`)."""
        if self.system == "own":
            return _own_label(kind, *self.own)
        return _label(kind, self.system)

    def one(self, kind: str) -> float:
        """Return one dimensionless unit of that kind in these units; NaN if scales are unknown."""
        if self.system == "model":
            return 1.0
        if self.scales is None:
            return math.nan
        return KINDS[kind].size(self.scales) * _factor(kind, self.system)


DIMENSIONLESS: Final = Units("model")


def units_of(dataset: xr.Dataset) -> Units:
    """Return the units a dataset is in, from what its variables say.

    Raises
    ------
    InputError
        If a variable is in a unit that a run cannot have, or two are in different systems.
    """
    if dataset.attrs.get("kind") == "outlines":
        length, time = (str(dataset.attrs.get(f"{what}_units", "")) for what in ("length", "time"))
        return Units("own", own=(length, time))
    possible = systems_of(dataset, VARIABLES)
    scales = _scales(dataset)
    if possible == set(SYSTEMS):  # nothing said
        return Units("SI", scales) if "scales" in dataset.attrs else DIMENSIONLESS
    system = next(system for system in SYSTEMS if system in possible)
    return Units(system, scales if system != "model" else None)


def in_micrometres(dataset: xr.Dataset) -> xr.Dataset:
    """Return a run in SI with lengths in micrometres; any other as it is."""
    if units_of(dataset).system != "SI":
        return dataset
    changed = {}
    for name, variable in dataset.variables.items():
        label, factor = _MICRO.get(variable.attrs.get("units", ""), ("", 1.0))
        if label:
            attributes = {**variable.attrs, "units": label}
            changed[name] = (variable.dims, variable.data * factor, attributes)
    return dataset.assign(changed)


def typical_radius(dataset: xr.Dataset) -> float:
    """Return R_0 in the units of the dataset, or if unknown the radius of a disc of its area."""
    radius = units_of(dataset).one("length")
    if math.isnan(radius):
        radius = math.sqrt(float(np.median(dataset["area"].values)) / math.pi)
    return radius


def _own_label(kind: str, length: str, time: str) -> str:
    powers = {"length": length, "area": f"{length}^2", "curvature": f"1/{length}"}
    if kind in powers:
        return powers[kind] if length else ""
    rates = {"time": time, "rate": f"1/{time}", "angular_velocity": f"rad/{time}"}
    if kind in rates:
        return rates[kind] if time else ""
    return f"{length}/{time}" if kind == "velocity" and length and time else ""


def _label(kind: str, system: str) -> str:
    if system == "model":
        return KINDS[kind].label
    unit = KINDS[kind].unit
    return _MICRO.get(unit, (unit, 1.0))[0] if system == "micrometres" else unit


def _factor(kind: str, system: str) -> float:
    return _MICRO.get(KINDS[kind].unit, ("", 1.0))[1] if system == "micrometres" else 1.0


def _scales(dataset: xr.Dataset) -> Scales | None:
    try:
        return Scales.from_dict(json.loads(dataset.attrs["scales"]))
    except (KeyError, TypeError, ValueError):
        return None
