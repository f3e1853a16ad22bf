"""Which program wrote a table, and which of its columns is what."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from cellcrawl.errors import InputError
from cellcrawl.microscopy.columns import Columns, chosen, plain, recognise
from cellcrawl.microscopy.tables import Form, read_cells


def columns_of(
    form: Form, wanted: str | Mapping[str, str | int] | None
) -> tuple[Columns, tuple[str, bool, str]]:
    """Return the columns, and the program, whether its y points down, and its unit of length.

    Raises
    ------
    InputError
        If neither names nor content tell, or the table is one without positions.
    """
    if wanted is not None:
        columns = chosen(wanted, form.names if any(form.names) else (), form.width)
        return columns, _program(form, columns)
    if any(form.names):
        found = recognise(form.names, form.units)
        if found is None:
            _say_what_else_it_is(form)
            listed = ", ".join(name for name in form.names if name)
            raise InputError(
                f"{form.path}: no columns of positions among {listed[:120]}: "
                "name them with --columns, as in id=A,t=B,x=C,y=D"
            )
        program = _program(form, found)
        if program[0].startswith("CellProfiler") and "id" not in found.places:
            raise InputError(
                f"{form.path} has no TrackObjects_Label: its ObjectNumber counts the objects of "
                "each image anew and links none; run TrackObjects, or name an id with --columns"
            )
        return found, program
    return _by_content(form)


def _program(form: Form, columns: Columns) -> tuple[str, bool, str]:
    """Return which program wrote the table, whether its y points down, and its unit of length."""
    names = {plain(name) for name in form.names}
    across = plain(form.names[columns.places["x"]])
    if {"trackid", "positionx", "quality"} <= names or {"trackid", "quality", "spotid"} <= names:
        return "TrackMate spots table", True, ""
    if {"id", "t", "parent", "root", "generation"} <= names:
        return "btrack table", True, "pixel"
    if any("trackobjects" in name for name in names) or across.endswith("locationcenterx"):
        return "CellProfiler table", True, "pixel"
    if {"trackn", "slicen"} <= names:
        return "ImageJ Manual Tracking table", True, "pixel"
    if {"nr", "tid", "pid"} <= names:
        return "MTrackJ table", True, ""
    if "particle" in names and "frame" in names:
        return "trackpy table", True, "pixel"
    if {"trackid", "t", "y", "x"} <= names and len(form.names) <= 8:
        order = [plain(name) for name in form.names]
        if order.index("y") < order.index("x"):
            kind = "ultrack" if "parenttrackid" in names else "napari"
            return f"{kind} tracks table", True, "pixel"
    if {"labelimageid", "trackid", "lineageid"} <= names:
        return "ilastik tracking table", True, "pixel"
    if {"positionx", "trackid", "collection"} <= names:
        return "Imaris table", False, ""
    return "plain table", False, ""


def _say_what_else_it_is(form: Form) -> None:
    names = {plain(name) for name in form.names}
    if {"spotsourceid", "spottargetid"} <= names:
        what = "TrackMate's table of edges"
    elif {"trackduration", "trackstart"} & names:
        what = "TrackMate's table of whole tracks"
    elif {"l", "b", "e", "p"} <= names:
        what = "a table of whole tracks"
    else:
        return
    raise InputError(f"{form.path} is {what}: it holds no positions; give the table of spots")


def _by_content(form: Form) -> tuple[Columns, tuple[str, bool, str]]:
    """Tell the columns of a table without names: an id whose records rise in time, x and y."""
    cells = read_cells(form, range(form.width))
    values = [cells.numbers(place)[0] for place in range(form.width)]
    names = tuple(f"column {place + 1}" for place in range(form.width))
    ask = (
        f"{form.path} names no columns: say which is which with --columns, "
        "as in id,t,x,y in the order of the file"
    )
    for identity in range(form.width):
        rising = [
            place
            for place in range(form.width)
            if place != identity and _rises_within(values[identity], values[place])
        ]
        if not _is_whole(values[identity]) or not rising or not _in_blocks(values[identity]):
            continue
        # Frame and time may both be there: each tells the other. A position may rise too.
        first = rising[0]
        times = [p for p in rising if _same_clock(values[first], values[p])]
        rest = [p for p in range(form.width) if p not in (identity, *times)]
        if len(rest) in (2, 3) and max(identity, *times) < rest[0]:
            rising = times
            places = {"id": identity, "t": rising[-1], "x": rest[0], "y": rest[1]}
            if len(rest) == 3:
                places["z"] = rest[2]
            kind = "celltrackR table without names" if len(rising) == 2 else "table without names"
            return Columns(places, names=names), (kind, False, "")
    raise InputError(ask)


def _is_whole(values: np.ndarray) -> bool:
    return bool(np.all(np.isfinite(values)) and np.all(values == np.round(values)))


def _in_blocks(values: np.ndarray) -> bool:
    """Whether equal values stand together: as many blocks as values."""
    return bool(1 + np.count_nonzero(np.diff(values)) == np.unique(values).size < values.size)


def _same_clock(first: np.ndarray, other: np.ndarray) -> bool:
    """Whether one column is the other in other units, over all records."""
    low, high = int(np.argmin(first)), int(np.argmax(first))
    pace = (other[high] - other[low]) / (first[high] - first[low])
    return bool(np.allclose(other, other[low] + pace * (first - first[low]), rtol=1e-9, atol=1e-9))


def _rises_within(identity: np.ndarray, values: np.ndarray) -> bool:
    """Whether values rise within each block of an id, and by the same steps mostly."""
    steps = np.diff(values)[np.diff(identity) == 0.0]
    if not steps.size or not np.all(steps > 0.0):
        return False
    return bool(np.mean(np.isclose(steps, np.median(steps))) > 0.5)
