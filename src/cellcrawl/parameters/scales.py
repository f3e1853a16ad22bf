"""The paper's scales: from dimensionless numbers to SI and back.

Lengths are in units of the cell radius R_0, times of the unstressed linkers' lifetime 1/k_off0,
retrograde flow of v_beta, friction per length of zeta_0 v_beta, and the membrane tension of
``zeta_0 v_beta / 2`` (two faces of the membrane pull).
"""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final, NamedTuple

import numpy as np

from cellcrawl.arguments import checked
from cellcrawl.errors import InputError
from cellcrawl.parameters.named import NamedFields
from cellcrawl.parameters.quantities import magnitude_in, quantity
from cellcrawl.validation import one_of, real_number, shown

if TYPE_CHECKING:
    import xarray as xr

SMALLEST, LARGEST = 1e-30, 1e30  # of SI values: their products and ratios stay finite
SAME = 1e-9  # relative: two values of epsilon that differ less are one


class Kind(NamedTuple):
    """A kind of physical quantity: its scale as datasets name it, its SI unit, its scale in SI."""

    label: str
    unit: str
    size: Callable[[Scales], float]


@dataclass(frozen=True, kw_only=True)
class Scales(NamedFields):
    """What one dimensionless unit is in SI; immutable.

    Numbers are in SI; pint quantities of any unit of the right dimension are accepted.

    Parameters
    ----------
    length : float
        Cell radius R_0, in m.
    time : float
        Lifetime of an unstressed linker 1/k_off0, in s.
    retrograde_velocity : float
        ``v_beta = k_off0 f_0 / k_b``, in m/s, the unit of the retrograde flow and of v_p.
    viscous_friction : float
        Friction zeta_0, in N s/m^2 (force per length of edge over velocity). The default is our
        choice; see `PhysicalParameters`.

    Raises
    ------
    InputError
        For an unknown name, a wrong type or dimension, or a value out of range.

    Notes
    -----
    The edge moves in units of ``velocity``, R_0 k_off0, not of ``retrograde_velocity``: the two
    differ by epsilon.

    Examples
    --------
    >>> scales = Scales()
    >>> scales.to_physical(18.0, "time")
    180.0
    >>> round(scales.to_physical(0.19, "velocity") * 1e6, 3)  # micrometres per second
    0.19
    """

    length: float = 1e-5
    time: float = 10.0
    retrograde_velocity: float = 1e-9
    viscous_friction: float = 200.0

    def __post_init__(self) -> None:
        for name in self.field_names():
            unit = KINDS[name].unit
            value = magnitude_in(name, getattr(self, name), unit)
            value = real_number(name, value, SMALLEST, LARGEST, unit=unit)
            object.__setattr__(self, name, value)

    @property
    def velocity(self) -> float:
        """Scale ``R_0 k_off0`` of the edge's velocity, in m/s."""
        return self.length / self.time

    @property
    def epsilon(self) -> float:
        """Dimensionless ``v_beta / (k_off0 R_0)``."""
        return self.retrograde_velocity * self.time / self.length

    @property
    def friction(self) -> float:
        """Scale ``zeta_0 v_beta`` of forces per length of edge, in N/m."""
        return self.viscous_friction * self.retrograde_velocity

    @property
    def tension(self) -> float:
        """Scale ``zeta_0 v_beta / 2`` of the membrane tension, in N/m."""
        return 0.5 * self.friction

    @checked
    def to_physical(self, value: Any, kind: str, *, as_quantity: bool = False) -> Any:
        """Return a dimensionless ``value`` in SI.

        Parameters
        ----------
        value : float, array or DataArray
            Dimensionless numbers.
        kind : str
            What they are, a name in `KINDS`: "length", "time", "velocity", "tension", ...
        as_quantity : bool
            Return a pint quantity.
        """
        chosen = _kind(kind)
        result = _numbers(kind, value) * chosen.size(self)
        if hasattr(result, "assign_attrs"):
            result = result.assign_attrs({**value.attrs, "units": chosen.unit})
        return quantity(result, chosen.unit) if as_quantity else result

    @checked
    def to_dimensionless(self, value: Any, kind: str) -> Any:
        """Return ``value``, in SI or a pint quantity, without dimension.

        Parameters
        ----------
        value : float, array, DataArray or quantity
            SI numbers, or a quantity of any unit of the right dimension.
        kind : str
            What they are, a name in `KINDS`.
        """
        chosen = _kind(kind)
        result = _numbers(kind, magnitude_in(kind, value, chosen.unit)) / chosen.size(self)
        if hasattr(result, "assign_attrs"):
            result = result.assign_attrs({**value.attrs, "units": chosen.label})
        return result

    def dataset(self, run: xr.Dataset) -> xr.Dataset:
        """Return a run, or anything computed from one, with its variables in SI.

        Variables are converted by their ``units`` attribute, which becomes the SI unit. The
        dataset's own attributes (parameters, end time) stay dimensionless; the scales join them.

        Raises
        ------
        InputError
            For a dataset that is in SI already, a variable in units that are not known, or a run
            whose epsilon is not that of these scales.
        """
        import xarray

        if not isinstance(run, xarray.Dataset):
            raise InputError(f"a run is an xarray Dataset, not {type(run).__name__}")
        if "scales" in run.attrs:
            raise InputError("this dataset is in SI already: its attributes hold its scales")
        self._check_epsilon(run)
        converted: dict[Any, Any] = {}
        for name, variable in run.variables.items():
            label = variable.attrs.get("units", "1")
            if label in _SAME_IN_SI:
                continue
            if label not in _BY_LABEL:
                raise InputError(
                    f"{shown(name)} is in {shown(label)}: scales do not know that unit"
                )
            kind = _BY_LABEL[label]
            attributes = {**variable.attrs, "units": kind.unit}
            converted[name] = (variable.dims, variable.data * kind.size(self), attributes)
        coordinates = {name: converted.pop(name) for name in list(converted) if name in run.coords}
        result = run.assign(converted).assign_coords(coordinates)
        return result.assign_attrs(scales=json.dumps(self.to_dict()))

    def _check_epsilon(self, run: xr.Dataset) -> None:
        """Refuse a run that other scales belong to; datasets without parameters pass."""
        epsilon = _attribute(run, "parameters").get("epsilon", self.epsilon)
        if abs(self.epsilon - epsilon) > SAME * epsilon:
            fitting = epsilon * self.velocity
            raise InputError(
                f"this run has epsilon = {epsilon:g}, these scales {self.epsilon:g}: "
                f"give retrograde_velocity={fitting!r}"
            )
        if "epsilon" in _attribute(run, "schedule"):
            raise InputError("epsilon changes during this run: no one set of scales belongs to it")


KINDS: Final[dict[str, Kind]] = {
    "length": Kind("R_0", "m", lambda s: s.length),
    "area": Kind("R_0^2", "m^2", lambda s: s.length**2),
    "curvature": Kind("1/R_0", "1/m", lambda s: 1.0 / s.length),
    "time": Kind("1/k_off0", "s", lambda s: s.time),
    "rate": Kind("k_off0", "1/s", lambda s: 1.0 / s.time),
    "angular_velocity": Kind("rad k_off0", "rad/s", lambda s: 1.0 / s.time),
    "velocity": Kind("R_0 k_off0", "m/s", lambda s: s.velocity),
    "diffusivity": Kind("R_0^2 k_off0", "m^2/s", lambda s: s.length * s.velocity),
    "retrograde_velocity": Kind("v_beta", "m/s", lambda s: s.retrograde_velocity),
    "viscous_friction": Kind("zeta_0", "N s/m^2", lambda s: s.viscous_friction),
    "friction": Kind("zeta_0 v_beta", "N/m", lambda s: s.friction),
    "tension": Kind("zeta_0 v_beta / 2", "N/m", lambda s: s.tension),
    "membrane_stiffness": Kind(
        "zeta_0 k_off0 / (2 R_0)",
        "N/m^3",
        lambda s: 0.5 * s.viscous_friction / (s.length * s.time),
    ),
}
_BY_LABEL: Final = {kind.label: kind for kind in KINDS.values()}
_SAME_IN_SI: Final = ("1", "", "rad", "dimensionless")


def _kind(name: str) -> Kind:
    return KINDS[one_of("kind", name, KINDS)]


def _numbers(kind: str, value: Any) -> Any:
    """Return ``value`` as something that can be scaled: a float, an array or a DataArray."""
    try:
        known = isinstance(getattr(value, "dtype", None), np.dtype)
        numbers = value if known else np.asarray(value)
    except Exception:  # whatever an object that is no number raises
        numbers = np.asarray(None)
    if numbers.dtype.kind not in "iuf":
        raise InputError(f"a {kind} must be a number or an array of numbers")
    return numbers if numbers.ndim or hasattr(numbers, "attrs") else float(numbers)


def _attribute(run: xr.Dataset, name: str) -> dict[str, Any]:
    try:
        found = json.loads(run.attrs.get(name, "{}"))
    except (TypeError, ValueError):
        return {}
    return found if isinstance(found, dict) else {}
