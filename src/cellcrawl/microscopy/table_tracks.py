"""Tracks from plain tables."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.compute as pc

from cellcrawl.errors import InputError
from cellcrawl.microscopy.columns import (
    Columns,
    is_length,
    length_unit,
    recognise,
    side_by_side,
    time_column,
)
from cellcrawl.microscopy.grouping import rows_told, tracks_of_records
from cellcrawl.microscopy.options import Reading
from cellcrawl.microscopy.programs import columns_of
from cellcrawl.microscopy.source import LeftOut, Source
from cellcrawl.microscopy.tables import (
    Cells,
    Form,
    blocks_of,
    clock_seconds,
    form_of,
    read_cells,
    words_of,
)
from cellcrawl.microscopy.track import Tracks

_JUMP = 3.0  # times the longest step within a block at which two blocks are two cells


def read_table_tracks(path: Path, reading: Reading) -> Tracks:
    """Read the tracks of a plain table; see `cellcrawl.read_tracks`."""
    form = form_of(path)
    if reading.columns is None and recognise(form.names, form.units) is None:
        cells_beside = side_by_side(form.names)
        if cells_beside:
            return _side_by_side(path, form, cells_beside, reading)
    columns, program = columns_of(form, reading.columns)
    places = [*columns.places.values(), *columns.groups]
    if "id" not in columns.places:
        places = list(range(form.width))  # to be sure that none of them is an id
    cells = read_cells(form, places)
    notes: list[str] = []
    out = [LeftOut(f"row {row}", "it has another number of cells", 1) for row in cells.torn]
    codes, ids = _ids(cells, columns)
    if len(ids) == 1 and ids[0] == "" and reading.columns is None:
        codes, ids = _blocks(form, codes)
        if len(ids) > 1:
            notes.append("no column of ids: blank lines keep the tracks apart")
    line = form.first + 1
    numbers = {}
    for role in ("x", "y", "t", "frame"):
        if role not in columns.places:
            continue
        place = columns.places[role]
        values, bad = cells.numbers(place)
        if role == "t" and bad.size > 0.5 * values.size:
            clock = clock_seconds(cells.text(place))
            if clock is not None:
                values, bad = clock, np.empty(0, np.int64)
                columns = replace(columns, time_units="s")
                notes.append(f"times of {columns.told()['t']} read as clock times, in seconds")
        if bad.size:
            if bad.size > 0.5 * values.size:
                cell = cells.text(place)[int(bad[0])].as_py()
                raise InputError(
                    f"{path}, {rows_told(bad, line)}: {role} = {cell!r} is not a number"
                    + (" (seconds, frames, HH:MM:SS)" if role == "t" else "")
                )
            reason = f"{role} is not a number"
            out.append(LeftOut(rows_told(bad, line), reason, bad.size))
        numbers[role] = values
    t, role, units = _times(path, numbers, columns, reading, codes, len(ids))
    if "id" not in columns.places and len(ids) == 1:
        _no_hidden_id(form, cells, columns, t, numbers, given=reading.columns is not None)
    if "z" in columns.places:
        depth = cells.numbers(columns.places["z"])[0]
        if np.nanmax(depth, initial=-np.inf) > np.nanmin(depth, initial=np.inf):
            notes.append(f"{columns.told()['z']} is left aside: tracks are of the plane")
    name, y_down, length = program
    if name.startswith("ilastik") and "-1" in ids:  # objects that it could not link
        codes, ids = _without(codes, ids, "-1")
    length = columns.length_units or _unit_in(cells, columns) or length
    told = columns.told()
    told = {name: told[name] for name in ("id", "group", role, "x", "y") if name in told}
    source = Source(
        str(path),
        f"{name} ({form})",
        told,
        length,
        units,
        y_down,
        tuple(notes),
    )
    parents = _parents(cells, columns, ids, codes)
    del cells  # the text of a long table takes more memory than its numbers
    pa.default_memory_pool().release_unused()
    scaled, x, y = reading.scaled(source, numbers.pop("x"), numbers.pop("y"))
    return tracks_of_records(codes, ids, t, x, y, scaled, out, parents)


def _side_by_side(
    path: Path, form: Form, beside: list[tuple[str, int, int]], reading: Reading
) -> Tracks:
    """Read a table with a row a frame and two columns a cell; blanks where a cell is not seen."""
    place, role, units = time_column(form.names)
    places = [*(p for _, *pair in beside for p in pair), *([] if place is None else [place])]
    cells = read_cells(form, places)
    numbers: dict[str, np.ndarray] = {}
    out = [LeftOut(f"row {row}", "it has another number of cells", 1) for row in cells.torn]
    rows = cells.rows
    x, y = np.empty((2, len(beside), rows))
    for number, (name, *pair) in enumerate(beside):
        for values, at in zip((x, y), pair, strict=True):
            values[number], bad = cells.numbers(at)
            if bad.size:
                told = f"{name}, {rows_told(bad, form.first + 1)}"
                out.append(LeftOut(told, "no number", bad.size))
    if place is not None:
        numbers[role] = cells.numbers(place)[0]
    columns = Columns({"x": beside[0][1], "y": beside[0][2]}, time_units=units, names=form.names)
    t, role, units = _times(path, numbers, columns, reading, np.zeros(rows, np.int64), 1)
    taken = {role: "rows" if place is None else form.names[place]}
    note = f"{len(beside)} cells side by side, two columns each"
    source = Source(str(path), f"plain table ({form})", taken, "", units, False, (note,))
    source, x, y = reading.scaled(source, x, y)
    codes = np.repeat(np.arange(len(beside)), rows)
    ids = [name for name, _, _ in beside]
    return tracks_of_records(codes, ids, np.tile(t, len(beside)), x.ravel(), y.ravel(), source, out)


def _ids(cells: Cells, columns: Columns) -> tuple[np.ndarray, list[str]]:
    """Return the code of each row's track, -1 for none, and the names; groups keep ids apart."""
    rows = cells.rows
    parts = [_names_in(cells, place) for place in columns.groups]
    parts = [(own, words) for own, words in parts if len(words) > 1]
    if "id" in columns.places:
        parts.append(_names_in(cells, columns.places["id"]))
    if not parts:
        return np.zeros(rows, np.int64), [""]
    codes, names = np.zeros(rows, np.int64), [""]
    for own, words in parts:
        if len(names) == 1:
            codes, names = own, words
            continue
        both = np.where((codes < 0) | (own < 0), -1, codes * len(words) + own)
        pairs, first, inverse = np.unique(both, return_index=True, return_inverse=True)
        order = np.argsort(first)
        order = order[pairs[order] >= 0]
        rank = np.full(pairs.size, -1)
        rank[order] = np.arange(order.size)
        codes = rank[inverse]
        names = [
            f"{names[int(pair) // len(words)]}/{words[int(pair) % len(words)]}"
            for pair in pairs[order]
        ]
    return codes, names


def _without(codes: np.ndarray, ids: list[str], name: str) -> tuple[np.ndarray, list[str]]:
    """Return codes and ids with the records of one id belonging to no track."""
    gone = ids.index(name)
    kept = np.where(codes == gone, -1, codes - (codes > gone))
    return kept, [one for one in ids if one != name]


def _unit_in(cells: Cells, columns: Columns) -> str:
    """Return the unit of length that a column of its own gives for all rows, "" for none."""
    if "unit" not in columns.places:
        return ""
    _, words = cells.words(columns.places["unit"])
    return length_unit(words[0]) if len(words) == 1 and is_length(words[0]) else ""


def _blocks(form: Form, codes: np.ndarray) -> tuple[np.ndarray, list[str]]:
    """Return tracks that stand in blocks with blank lines between them."""
    blocks = blocks_of(form)
    if blocks.size != codes.size or blocks[-1] == 0:
        return codes, [""]
    numbers, blocks = np.unique(blocks, return_inverse=True)
    return blocks.astype(np.int64), [str(int(number) + 1) for number in numbers]


def _names_in(cells: Cells, place: int) -> tuple[np.ndarray, list[str]]:
    """Return which name of a track or group stands in each row, -1 for none, and the names."""
    return words_of(_plain_ids(cells.text(place)))


def _plain_ids(column: pa.ChunkedArray) -> pa.ChunkedArray:
    """Whole numbers written as 3.0 become 3, if all of them are; other ids stay as written."""
    filled = column.drop_null()
    whole = pc.match_substring_regex(filled, r"^-?\d+[.,]0*$")
    if len(filled) and pc.all(whole).as_py():
        return pc.replace_substring_regex(column, r"[.,]0*$", "")
    return column


def _times(
    path: Path,
    numbers: Mapping[str, np.ndarray],
    columns: Columns,
    reading: Reading,
    codes: np.ndarray,
    tracks: int,
) -> tuple[np.ndarray, str, str]:
    """Return the times, the role of the column they are from, and their unit."""
    time, frame = numbers.get("t"), numbers.get("frame")
    if time is not None and frame is not None:
        finite = time[np.isfinite(time)]
        if not finite.size or (
            finite.min() == finite.max() and np.nanmax(frame) > np.nanmin(frame)
        ):
            time = None  # a time nobody filled in
    if reading.frame_interval is not None:
        counted = frame if frame is not None else time
        if counted is None:
            if tracks > 1:
                raise InputError(f"{path} has no column of times or frames: name it with --columns")
            counted = np.arange(codes.size, dtype=float)
        filled = counted[np.isfinite(counted)]
        if np.any(filled != np.round(filled)):
            raise InputError(
                f"{path} has times of its own, not frames: leave the frame interval out"
            )
        role = "frame" if frame is not None else "t"
        return reading.frame_interval * counted, role, reading.time_units
    if time is not None:
        return time, "t", columns.time_units
    if frame is not None:
        return frame, "frame", "frame"
    raise InputError(
        f"{path} has no column of times or frames: name it with --columns, as in t=NAME, "
        "or give --frame-interval for rows in the order of time"
    )


def _no_hidden_id(
    form: Form,
    cells: Cells,
    columns: Columns,
    t: np.ndarray,
    numbers: Mapping[str, np.ndarray],
    *,
    given: bool,
) -> None:
    """Refuse to make one track of several cells: a column that looks like an id must be named."""
    if given:
        return
    for place in range(form.width):
        if place in columns.places.values() or place in columns.groups:
            continue
        blocks, words = cells.words(place)
        changes = np.flatnonzero(np.diff(blocks))
        if not 2 <= len(words) <= blocks.size // 2 or changes.size + 1 != len(words):
            continue
        if _apart(t, numbers["x"], numbers["y"], changes):
            name = form.names[place] or f"column {place + 1}"
            raise InputError(
                f"{form.path}: column {name!r} seems to tell {len(words)} cells apart: "
                f"say --columns id={name},... or id=none,... for one cell"
            )


def _apart(t: np.ndarray, x: np.ndarray, y: np.ndarray, changes: np.ndarray) -> bool:
    """Whether time falls or the position jumps wherever the block changes."""
    step = np.hypot(np.diff(x), np.diff(y))
    within = np.delete(step, changes)
    if not np.isfinite(within).any():
        return False
    jump = step[changes] > _JUMP * np.nanmax(within)
    return bool(np.all(jump | (np.diff(t)[changes] <= 0.0)))


def _parents(cells: Cells, columns: Columns, ids: list[str], codes: np.ndarray) -> dict[str, str]:
    if "parent" not in columns.places or columns.groups or len(ids) < 2:
        return {}
    parents = _plain_ids(cells.text(columns.places["parent"])).to_pylist()
    known, found = set(ids), {}
    _, first = np.unique(codes, return_index=True)
    for row in first:
        own = ids[codes[row]] if codes[row] >= 0 else ""
        parent = parents[row]
        if own and parent in known and parent != own:
            found[own] = parent
    return found
