"""Stability over two parameters: a map on a grid, and marginal curves between its grid lines."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from cellcrawl.arguments import checked
from cellcrawl.errors import InputError
from cellcrawl.linear.characteristic import characteristic, two_axes
from cellcrawl.linear.level_curves import level_curves
from cellcrawl.linear.modes import fastest_wavenumber, unstable_count
from cellcrawl.linear.theory import growth_rates
from cellcrawl.parameters import DESCRIPTIONS, Parameters
from cellcrawl.validation import real_array, shown, whole_number

if TYPE_CHECKING:
    import xarray as xr

_GRID = 200  # fewest steps of the grid on which the curves are found
_HIGHEST = 1000
_MOST = 10_000_000


@checked
def stability_map(
    parameters: Parameters, *, k: Any = (1, 2, 5, 10, 15), **ranges: Any
) -> xr.Dataset:
    """Linear stability of the resting circle over any two parameters.

    Parameters
    ----------
    parameters : Parameters
        The cell, which gives all other parameters and the tension law.
    k : int or sequence of int
        Wavenumbers, 0 to 1000.
    **ranges : array
        The two parameters by name, each with its increasing values; the first is the first axis:
        ``stability_map(p, r_on=np.linspace(5, 65, 121), zeta_1=np.linspace(400, 640, 97))``.

    Returns
    -------
    Dataset
        ``growth_rate`` (the larger real part) and ``frequency`` (angular, 0 for real roots) over k
        and both parameters; over both parameters ``unstable_modes``, how many whole wavenumbers
        grow with the breathing mode k = 0 among them, and ``fastest_mode``, NaN where none grows
        (both infinite where the tension of the resting circle is negative). The marginal curves lie
        end to end along ``vertex``: ``marginal_NAME`` for both parameters, with ``marginal_k`` and
        the number of the branch, ``marginal_branch``; `curves_in` takes them apart. They do not
        depend on the grid.

    Raises
    ------
    InputError
        For other than two parameters, unknown names, or values out of range or not increasing.

    Examples
    --------
    >>> from cellcrawl import Parameters, linear
    >>> ds = linear.stability_map(Parameters(), r_on=[10, 25, 60], zeta_1=[400, 600], k=1)
    >>> ds.growth_rate.sel(k=1, r_on=25, zeta_1=600).item() > 12
    True
    """
    import xarray as xr  # a second that no solver needs

    wavenumbers = _wavenumbers(k)
    (first, x), (second, y) = two_axes("a stability map", ranges).items()
    if x.size * y.size * len(wavenumbers) > _MOST:
        raise InputError(
            f"a map of {x.size} x {y.size} points for {len(wavenumbers)} wavenumbers is too large: "
            f"it may have {_MOST} values"
        )
    grid = {first: x[:, None], second: y[None, :]}
    rates = np.array([growth_rates(parameters, at, **grid)[..., 0] for at in wavenumbers])
    dims = ("k", first, second)
    described = {name: {"long_name": DESCRIPTIONS[name].meaning} for name in (first, second)}
    variables = {
        "growth_rate": (dims, rates.real, _about("larger growth rate", "k_off0")),
        "frequency": (dims, rates.imag, _about("angular frequency of the pair", "k_off0")),
        "unstable_modes": (
            dims[1:],
            unstable_count(parameters, grid),
            _about("number of wavenumbers that grow, k = 0 among them", "1"),
        ),
        "fastest_mode": (
            dims[1:],
            fastest_wavenumber(parameters, grid),
            _about("wavenumber that grows fastest", "1"),
        ),
        **_ragged({at: _curves(parameters, at, {first: x, second: y}) for at in wavenumbers}, dims),
    }
    coordinates = {
        "k": ("k", wavenumbers, {"long_name": "wavenumber"}),
        first: (first, x, described[first]),
        second: (second, y, described[second]),
    }
    attributes = {"parameters": json.dumps(parameters.to_dict())}
    return xr.Dataset(variables, coordinates, attributes)


@checked
def marginal_curves(parameters: Parameters, k: int, **ranges: Any) -> list[np.ndarray]:
    """Curves in the plane of two parameters on which wavenumber ``k`` neither grows nor decays.

    Parameters
    ----------
    parameters : Parameters
        The cell, which gives all other parameters and the tension law.
    k : int
        Wavenumber, 0 to 1000. For k = 1 the growth rate meant is that of the root other than 0.
    **ranges : array
        The two parameters by name, each with at least the two ends of its range. More values than
        two hundred refine the search for small loops; the curves do not depend on them.

    Returns
    -------
    list of array, shape (vertices, 2)
        The branches, with the unstable side on the left when the first parameter points right and
        the second up. Each vertex is on the curve to rounding. Closed ones end with their first
        vertex; open ones begin and end on the border of the box.

    Raises
    ------
    InputError
        As for `stability_map`.
    """
    return _curves(
        parameters, whole_number("k", k, 0, _HIGHEST), two_axes("a stability map", ranges)
    )


@checked
def curves_in(stability: Any, k: int) -> list[np.ndarray]:
    """Return the marginal curves of ``k`` that a stability map holds, as `marginal_curves` does."""
    first, second = axis_names(stability)
    mine = stability["marginal_k"].values == k
    branches = stability["marginal_branch"].values
    points = np.column_stack(
        [stability[f"marginal_{first}"].values, stability[f"marginal_{second}"].values]
    )
    return [points[mine & (branches == branch)] for branch in np.unique(branches[mine])]


def axis_names(stability: Any) -> tuple[str, str]:
    """Return the two parameters of a stability map, or raise `InputError` if it is none."""
    import xarray as xr

    if not isinstance(stability, xr.Dataset) or "growth_rate" not in stability:
        raise InputError(
            f"this is no stability map but {shown(type(stability).__name__)}: make one with "
            "linear.stability_map"
        )
    _, first, second = stability["growth_rate"].dims
    return str(first), str(second)


def _curves(parameters: Parameters, k: int, axes: Mapping[str, np.ndarray]) -> list[np.ndarray]:
    (first, x), (second, y) = axes.items()

    def margin(at_x: np.ndarray, at_y: np.ndarray) -> np.ndarray:
        return characteristic(parameters, float(k), {first: at_x, second: at_y}).margin

    return level_curves(margin, _refined(x), _refined(y))


def _refined(values: np.ndarray) -> np.ndarray:
    """Add lines between those given, as many between each pair, up to the fewest that will do."""
    steps = values.size - 1
    parts = math.ceil(_GRID / steps)
    refined: np.ndarray = np.interp(
        np.arange(steps * parts + 1) / parts, np.arange(values.size), values
    )
    return refined


def _ragged(
    curves: Mapping[int, list[np.ndarray]], dims: tuple[str, str, str]
) -> dict[str, tuple[str, np.ndarray, dict[str, str]]]:
    """Return all branches end to end."""
    numbered = [
        (at, branch, curve)
        for at, branches in curves.items()
        for branch, curve in enumerate(branches)
    ]
    points = np.concatenate([np.empty((0, 2)), *(curve for _, _, curve in numbered)])
    sizes = [len(curve) for _, _, curve in numbered]
    marks = {
        "marginal_k": np.repeat([at for at, _, _ in numbered], sizes),
        "marginal_branch": np.repeat([branch for _, branch, _ in numbered], sizes),
    }
    positions = {f"marginal_{name}": points[:, axis] for axis, name in enumerate(dims[1:])}
    return {
        **{name: ("vertex", values, {}) for name, values in positions.items()},
        **{name: ("vertex", values.astype(int), {}) for name, values in marks.items()},
    }


def _about(long_name: str, units: str) -> dict[str, str]:
    return {"long_name": long_name, "units": units}


def _wavenumbers(k: Any) -> list[int]:
    given = real_array("k", k, None)
    if given.ndim > 1 or not given.size:
        raise InputError("k must be one wavenumber or a sequence of them")
    return list(dict.fromkeys(whole_number("k", at, 0, _HIGHEST) for at in given.ravel()))
