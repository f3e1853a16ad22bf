"""From columns of records to tracks: sorted, kept apart, and nothing dropped without a word."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from cellcrawl.errors import InputError
from cellcrawl.microscopy.source import LeftOut, Source
from cellcrawl.microscopy.track import Tracks

_SHOWN = 5


def tracks_of_records(
    codes: np.ndarray,
    ids: Sequence[str],
    t: np.ndarray,
    x: np.ndarray,
    y: np.ndarray,
    source: Source,
    left_out: Sequence[LeftOut] = (),
    parents: dict[str, str] | None = None,
) -> Tracks:
    """Return the tracks of a list of records in any order.

    Parameters
    ----------
    codes : ndarray of int, shape (records,)
        Which of ``ids`` each record belongs to; -1 for a record of no track, -2 for one of a track
        that was left out before.
    ids : sequence of str
        Names of the tracks.
    t, x, y : ndarray, shape (records,)
        Times and positions; NaN for blanks.
    source : Source
        What was recognised; what is noticed here is added to its notes.
    left_out : sequence of LeftOut
        What was left out before.

    Notes
    -----
    Records of no track, and blank ones, are left out and counted. A record given twice counts
    once. A track with two positions at one time is no path of one cell (it split, or two cells
    share an id): it is left out as a whole. So is a track of a single record.
    """
    notes, out = list(source.notes), list(left_out)
    blank = ~(np.isfinite(t) & np.isfinite(x) & np.isfinite(y))
    stray = codes == -1
    if stray.any():
        out.append(
            LeftOut(f"{_rows(int(stray.sum()))}", "they belong to no track", int(stray.sum()))
        )
    empty = blank & (codes >= 0)
    if empty.any():
        cells = np.unique(codes[empty]).size
        notes.append(f"{_rows(int(empty.sum()))} of {_many(cells, 'track')} blank: skipped")
    keep = np.flatnonzero(~blank & (codes >= 0))
    order = keep[np.lexsort((t[keep], codes[keep]))]
    if np.any(np.diff(order) < 0) and _disordered(codes[keep], t[keep]):
        notes.append("the rows were not in the order of time: sorted")
    code, time, across, up = codes[order], t[order], x[order], y[order]
    again = np.zeros(order.size, bool)
    again[1:] = (np.diff(code) == 0) & (np.diff(time) == 0.0)
    same = again.copy()
    same[1:] &= (np.diff(across) == 0.0) & (np.diff(up) == 0.0)
    if same.any():
        notes.append(f"{_rows(int(same.sum()))} given twice: counted once")
    split = np.unique(code[again & ~same])
    if split.size:
        first = {int(c): float(time[i]) for i, c in _first_of(code, again & ~same)}
        single = len(ids) == 1 and ids[0] == ""
        if single:
            raise InputError(
                f"{source.path} has two positions at t = {first[int(split[0])]:g} and no column "
                "that keeps cells apart: name it with --columns, as in id=NAME,t=..,x=..,y=.."
            )
        sizes = np.bincount(code, minlength=len(ids))
        out += [
            LeftOut(
                ids[int(c)],
                "two positions at one time (a track that splits, or two cells of one id)",
                int(sizes[c]),
            )
            for c in split
        ]
    if again.any():
        good = ~again & ~np.isin(code, split)
        code, time, across, up = code[good], time[good], across[good], up[good]
    sizes = np.bincount(code, minlength=len(ids))
    lone = np.flatnonzero(sizes == 1)
    if lone.size:
        out += [LeftOut(ids[int(c)], "a single record is no path", 1) for c in lone]
        kept = ~np.isin(code, lone)
        code, time, across, up = code[kept], time[kept], across[kept], up[kept]
        sizes[lone] = 0
    gone = np.flatnonzero((sizes == 0) & ~np.isin(np.arange(len(ids)), [*split, *lone]))
    out += [LeftOut(ids[int(c)], "all its records are blank", 0) for c in gone]
    there = np.flatnonzero(sizes)
    if not there.size:
        why = f": {out[0].reason}" if out else ""
        if lone.size == len(ids) > 1 and "id" in source.columns:
            why = f": {source.columns['id']} seems to number records, not tracks; use --columns"
        raise InputError(f"{source.path or 'this table'} has no track of two records or more{why}")
    starts = np.concatenate([[0], np.cumsum(sizes[there])])
    return Tracks(
        time,
        across,
        up,
        starts,
        [ids[int(c)] for c in there],
        _noted(source, notes),
        tuple(out),
        parents,
    )


def rows_told(rows: np.ndarray, first_line: int) -> str:
    """Return "line 12" or "lines 12, 14, ... (7)" of rows counted from 0."""
    lines = [str(int(row) + first_line) for row in rows[:_SHOWN]]
    if len(rows) == 1:
        return f"line {lines[0]}"
    more = f" ... ({len(rows)})" if len(rows) > _SHOWN else ""
    return f"lines {', '.join(lines)}{more}"


def _disordered(codes: np.ndarray, t: np.ndarray) -> bool:
    """Whether the records of any track are not in the order of time."""
    order = np.argsort(codes, kind="stable")
    return bool(np.any((np.diff(codes[order]) == 0) & (np.diff(t[order]) < 0.0)))


def _first_of(code: np.ndarray, chosen: np.ndarray) -> list[tuple[Any, Any]]:
    places = np.flatnonzero(chosen)
    _, first = np.unique(code[places], return_index=True)
    return [(places[i], code[places[i]]) for i in first]


def _noted(source: Source, notes: Sequence[str]) -> Source:
    return replace(source, notes=tuple(notes))


def _rows(count: int) -> str:
    return _many(count, "record")


def _many(count: int, what: str) -> str:
    return f"{count} {what}{'s' if count != 1 else ''}"
