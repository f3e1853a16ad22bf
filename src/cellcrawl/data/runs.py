"""The one check of a run's or a track's Dataset, for every function that takes one."""

from __future__ import annotations

import functools
from collections.abc import Iterator
from typing import Any, Final

import numpy as np
import xarray as xr

from cellcrawl.data.schema import DIMENSIONAL, EDGE_FIELDS, FIELDS, TIME
from cellcrawl.errors import InputError, nearest_name
from cellcrawl.validation import real_array, shown

_SLICE_RECORDS: Final = 512  # looked at together: a run on disk need not fit in memory
_WIDEST_GAP: Final = 2.0  # spacings between neighbouring nodes ...
_CLOSURE: Final = 0.02  # ... and of the length: the gap the paper's scheme may leave

_ABOVE_ZERO: Final = ("length", "area")

SYSTEMS: Final = ("model", "SI", "micrometres")
"""Systems of units that a run can be in; pictures show SI in micrometres."""


def records_with(dataset: Any, *names: str, at_least: int = 1) -> xr.Dataset:
    """Return ``dataset`` if these variables of it can be trusted, or raise `InputError`.

    Parameters
    ----------
    dataset : Dataset
        A run or a part of one, as it is or changed by its user.
    *names : str
        Variables of the contract that are needed, besides the time.
    at_least : int
        The fewest records that will do.

    Raises
    ------
    InputError
        If it is no Dataset, lacks a variable, has other dimensions, too few records, times that do
        not rise, values that are not finite, units that are neither the model's nor SI or are
        mixed, or an edge that is cut, reversed or not as long as it says.
    """
    if not isinstance(dataset, xr.Dataset):
        raise InputError(f"a run is an xarray Dataset, not {type(dataset).__name__}")
    for name in ("time", *names):
        _check_variable(dataset, name)
    records = dataset.sizes["time"]
    if records < at_least:
        wanted_records = "1 record" if at_least == 1 else f"{at_least} records"
        raise InputError(
            f"this run has {records} records in time: at least {wanted_records} needed"
        )
    checked_times("time", dataset.variables["time"].values)
    if dataset.attrs.get("kind") != "outlines":  # which have the units of their file
        systems_of(dataset, ("time", *names))
    for name in names:
        _check_finite(dataset.variables[name], name)
        if name in _ABOVE_ZERO and (dataset.variables[name].values <= 0.0).any():
            raise InputError(f"{name!r} must be above 0, as in a run: are these differences?")
    if any(name in EDGE_FIELDS for name in names):
        _check_edge(dataset)
    return dataset


def check_run(dataset: Any) -> xr.Dataset:
    """Return ``dataset`` if it keeps the whole contract, with any number of records, or raise."""
    return records_with(dataset, *FIELDS, at_least=0)


def edge_field(name: Any) -> str:
    """Return ``name`` if it is a field on the edge, or raise `InputError`."""
    if not isinstance(name, str) or name not in EDGE_FIELDS:
        raise InputError(
            f"there is no field {shown(name)} on the edge: {nearest_name(name, EDGE_FIELDS)}"
        )
    return name


def checked_times(name: str, values: Any) -> np.ndarray:
    """Return times as a finite array, shape (record,), that rises, or raise `InputError`."""
    given = np.asarray(values)
    if given.dtype.kind in "mM":
        raise InputError(
            f"{name} holds dates or durations, not numbers: give numbers, or open a run's file "
            "with cellcrawl.open_run"
        )
    times = real_array(name, given, (None,))
    falls = np.flatnonzero(np.diff(times) <= 0.0)
    if falls.size:
        at = int(falls[0]) + 1
        raise InputError(
            f"{name} must rise: {name}[{at}] = {times[at]:g} follows {times[at - 1]:g}; "
            "sort the records and drop repeated times"
        )
    return times


def _check_variable(dataset: xr.Dataset, name: str) -> None:
    wanted = TIME.dims if name == "time" else FIELDS[name].dims
    if name not in dataset.variables:
        if name in EDGE_FIELDS and "centroid_x" in dataset.variables:
            raise InputError(
                f"this dataset has no {name!r}: it holds the track of a cell without its edge "
                "(a sweep keeps edges with keep='fields')"
            )
        raise InputError(f"this dataset has no {name!r}: is it a cellcrawl run?")
    variable = dataset.variables[name]
    if variable.dims != wanted:
        raise InputError(
            f"{name!r} has dimensions {variable.dims}, not {wanted}: select single records as a "
            "list, .isel(time=[0]), and single runs of several before"
        )
    if name != "time" and variable.dtype.kind not in "iuf":
        raise InputError(f"{name!r} holds {variable.dtype}, not numbers: is it a cellcrawl run?")


def systems_of(dataset: xr.Dataset, names: tuple[str, ...]) -> set[str]:
    """Return the systems of units that all variables there are may be in, or raise `InputError`."""
    possible, told = set(SYSTEMS), ""
    for name in names:
        if name not in dataset.variables:
            continue
        model = TIME.units if name == "time" else FIELDS[name].units
        given = dataset.variables[name].attrs.get("units", "")
        labels = _labels(model)
        fitting = {system for system, label in labels.items() if given in (label, "")}
        if not fitting:
            known = ", ".join(repr(label) for label in dict.fromkeys(labels.values()))
            raise InputError(f"{name!r} is in {given!r}: a run has it in {known}")
        if not possible & fitting:
            raise InputError(
                f"{name!r} is in {given!r} but {told}: put all into one system, as "
                "Scales.dataset does"
            )
        if fitting != set(SYSTEMS):
            told = told or f"{name!r} is in {given!r}"
        possible &= fitting
    return possible


@functools.cache
def _labels(model: str) -> dict[str, str]:
    """Return what a unit of the model is called in each system."""
    return dict(zip(SYSTEMS, (model, *DIMENSIONAL.get(model, (model, model))), strict=True))


def _slices(variable: xr.Variable) -> Iterator[tuple[int, np.ndarray]]:
    """Yield values along time, some records at a time, with the number of the first."""
    for start in range(0, variable.sizes["time"], _SLICE_RECORDS):
        yield start, variable.isel(time=slice(start, start + _SLICE_RECORDS)).values


def _check_finite(variable: xr.Variable, name: str) -> None:
    for start, values in _slices(variable):
        if not np.isfinite(values).all():
            record, *node = (int(i) for i in np.argwhere(~np.isfinite(values))[0])
            place = f"record {start + record}" + (f", node {node[0]}" if node else "")
            raise InputError(
                f"{name!r} is not finite at {place}: {values[record, *node]}; leave such records "
                "out, as in .dropna('time')"
            )


def _check_edge(dataset: xr.Dataset) -> None:
    """Refuse an edge whose nodes are not those of a whole one, counter-clockwise."""
    if not {"x", "y", "length"} <= set(dataset.variables):
        return
    for name in ("x", "y", "length"):
        _check_variable(dataset, name)
    nodes = dataset.sizes["node"]
    pairs = zip(*(_slices(dataset[name].variable) for name in ("x", "y", "length")), strict=True)
    for (start, x), (_, y), (_, length) in pairs:
        dx, dy = np.roll(x, -1, axis=1) - x, np.roll(y, -1, axis=1) - y
        around = np.sum(x * dy - y * dx, axis=1)
        widest = np.sqrt(np.max(dx**2 + dy**2, axis=1, initial=0.0))
        bad = (widest > (_WIDEST_GAP / max(nodes, 1) + _CLOSURE) * length) | (around <= 0.0)
        if bad.any():
            record = int(np.argmax(bad))
            why = "is not a whole ring of equally spaced nodes"
            if widest[record] <= (_WIDEST_GAP / max(nodes, 1) + _CLOSURE) * length[record]:
                why = "runs clockwise"
            raise InputError(
                f"the edge of record {start + record} {why}: give all nodes of a run, in order "
                "and not scaled"
            )
