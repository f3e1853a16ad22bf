"""Rows gathered over two parameters: the modes at each point, and means of measures."""

from __future__ import annotations

from collections import Counter
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from cellcrawl.data import MODEL_ENDINGS
from cellcrawl.errors import InputError
from cellcrawl.modes import MODES
from cellcrawl.parameters import DESCRIPTIONS
from cellcrawl.sweeps.measures import MEASURES
from cellcrawl.validation import known_names

if TYPE_CHECKING:
    import pyarrow as pa

FAILED = "failed"
"""Counted in place of a mode for runs that did not end as the model allows and have none."""
TOO_SHORT = "too short"
"""The same for runs that ended well but are too short to show a mode."""


class Plane(NamedTuple):
    """Points over two parameters; arrays have one entry a point."""

    x_name: str
    y_name: str
    x: np.ndarray
    y: np.ndarray
    counts: dict[str, np.ndarray]
    """For each mode that occurs, "too short" and "failed", how many runs show it."""

    @property
    def runs(self) -> np.ndarray:
        """Number of runs at each point."""
        total: np.ndarray = np.sum(list(self.counts.values()), axis=0)
        return total


def varied(table: pa.Table) -> list[str]:
    """Return the parameters that differ between rows, in the order of the model's table."""
    import pyarrow.compute as compute

    return [name for name in DESCRIPTIONS if compute.count_distinct(table[name]).as_py() > 1]


def axes_of(table: pa.Table, x: str | None, y: str | None) -> tuple[str, str]:
    """Return the two parameters of a plane: those given, or the first that differ.

    Raises
    ------
    InputError
        If there are not two, or a third one differs too.
    """
    for name in (x, y):
        if name is not None:
            known_names("the rows", [name], DESCRIPTIONS)
    differ = varied(table)
    free = [name for name in differ if name not in (x, y)]
    chosen = [x or (free.pop(0) if free else None), y or (free.pop(0) if free else None)]
    if chosen[0] is None or chosen[1] is None or chosen[0] == chosen[1]:
        names = ", ".join(differ) or "nothing"
        raise InputError(f"a diagram needs two parameters that differ; here {names} differs")
    return chosen[0], chosen[1]


def plane(table: pa.Table, x: str | None = None, y: str | None = None) -> Plane:
    """Return the modes at each point over two parameters.

    Parameters
    ----------
    table : pyarrow.Table
        Rows of a sweep.
    x, y : str, optional
        Two parameters; the first two that differ unless given. Runs that differ in anything else,
        their seeds say, are counted together.
    """
    x_name, y_name = axes_of(table, x, y)
    place, places = _places(table, x_name, y_name)
    return Plane(x_name, y_name, places[:, 0], places[:, 1], _counts(table, place, len(places)))


def line(table: pa.Table, x: str) -> Plane:
    """Return the modes at each point over one parameter, as a plane without a second one."""
    place, places = _places(table, x)
    counts = _counts(table, place, len(places))
    return Plane(x, "", places[:, 0], np.zeros(len(places)), counts)


def only_axis(table: pa.Table, x: str | None, y: str | None) -> str | None:
    """Return the parameter of a diagram along one: the only one that differs; else None."""
    differ = varied(table)
    return differ[0] if len(differ) == 1 and y is None and x in (None, differ[0]) else None


def named_modes(table: pa.Table) -> list[str]:
    """Return the mode of each row; for a row that has none, why."""
    pairs = zip(table["mode"].to_pylist(), table["status"].to_pylist(), strict=True)
    return [mode or (TOO_SHORT if status in MODEL_ENDINGS else FAILED) for mode, status in pairs]


def _counts(table: pa.Table, place: np.ndarray, points: int) -> dict[str, np.ndarray]:
    modes = np.array(named_modes(table))
    occur = Counter(modes.tolist())
    return {
        mode: np.bincount(place[modes == mode], minlength=points)
        for mode in (*MODES, TOO_SHORT, FAILED)
        if occur[mode]
    }


def majority(found: Plane) -> list[str]:
    """Return the mode of most runs at each point, torn cells left out where there are others.

    Of modes with as many runs, the first of `cellcrawl.modes.MODES`.
    """
    names = list(found.counts)
    counts = np.array([found.counts[name] for name in names])
    torn = np.array([name == "fragmented" for name in names])
    others = counts[~torn].sum(axis=0) > 0
    counts[np.ix_(torn, others)] = 0
    return [names[k] for k in counts.argmax(axis=0)]


def means(table: pa.Table, measure: str, x: str | None = None, y: str | None = None) -> np.ndarray:
    """Return the mean of a measure at the points of `plane` or `line`, without torn cells.

    NaN at a point where no run has it.
    """
    known_names("the measures", [measure], MEASURES)
    only = only_axis(table, x, y)
    place, places = _places(table, *((only,) if only else axes_of(table, x, y)))
    values = np.array([np.nan if v is None else v for v in table[measure].to_pylist()], dtype=float)
    whole = np.array([mode != "fragmented" for mode in table["mode"].to_pylist()])
    counted = whole & np.isfinite(values)
    number = np.bincount(place[counted], minlength=len(places))
    total = np.bincount(place[counted], values[counted], minlength=len(places))
    return np.where(number > 0, total / np.maximum(number, 1), np.nan)


def _places(table: pa.Table, *names: str) -> tuple[np.ndarray, np.ndarray]:
    """Return the point of each row and the points, shape (points, names), sorted."""
    rows = np.column_stack([table[name].to_numpy() for name in names])
    places, place = np.unique(rows, axis=0, return_inverse=True)
    return place.reshape(-1), places
